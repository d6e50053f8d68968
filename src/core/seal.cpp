#include "core/seal.h"

#include <fmt/format.h>

#include <span>

#include "core/hash.h"

namespace echocine {

namespace {

constexpr std::string_view kEnd = "\n}";

std::string sealOf(std::string_view before) {
  return fmt::format(",\n \"manifest_sha256\": \"{}\"\n}}\n",
                     sha256Hex(std::as_bytes(std::span(before))));
}

}  // namespace

std::string sealed(std::string object) {
  object.resize(object.size() - kEnd.size());
  return object + sealOf(object);
}

bool isSealed(std::string_view text) {
  const std::size_t seal = sealOf({}).size();
  if (text.size() < seal) return false;
  const std::string_view before = text.substr(0, text.size() - seal);
  return text.substr(before.size()) == sealOf(before);
}

}  // namespace echocine
