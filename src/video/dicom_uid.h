#pragma once
// Unique identifiers of DICOM objects.

#include <string>
#include <string_view>

namespace echocine {

// "2.25." and a UUID as a decimal number (PS3.5 B.2), at most 44 characters. The UUID is of version
// 8 (RFC 9562): bits of the text's SHA-256, so equal texts have equal identifiers.
std::string dicomUid(std::string_view text);

}  // namespace echocine
