#pragma once
// A DICOM file's structure, checked before the library sees it: its parser recurses once per nested
// sequence, inflates whatever a deflated data set promises, and its RLE decoder trusts the offsets
// of a segment.

#include <cstddef>
#include <span>
#include <string>

namespace echocine {

// Throws SceneError for sequences nested deeper than 32, a deflated data set of over 256 MB, RLE
// frames whose headers point outside their bytes, more pixels than the compressed bytes can hold,
// and data whose structure cannot be followed. Costs no more than the file and 256 MB.
void checkDicomStructure(const std::string& name, std::span<const std::byte> bytes);

// Throws SceneError "NAME: WHAT".
[[noreturn]] void refuseDicom(const std::string& name, const std::string& what);

}  // namespace echocine
