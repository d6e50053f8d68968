#pragma once
// Reads an attribute of an OpenEXR header.

#include <OpenEXR/ImfHeader.h>

namespace echocine {

// An attribute of the same name but another type is ignored.
template <typename Attribute, typename Value>
bool holds(const Imf::Header& header, const char* name, const Value& value) {
  const auto* attribute = header.findTypedAttribute<Attribute>(name);
  return attribute != nullptr && attribute->value() == value;
}

}  // namespace echocine
