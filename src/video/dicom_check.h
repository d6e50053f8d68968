#pragma once
// Checks a DICOM file's structure before the library reads it: its parser recurses once per nested
// sequence, and inflates deflated data sets without limit.

#include <cstddef>
#include <span>
#include <string>

#include "video/dicom_meta.h"

namespace echocine {

// The file's meta information, after its data set has been parsed to the end. Throws SceneError
// like readDicomMeta(), and for sequences nested deeper than 32, a deflated data set above 256 MB,
// elements of unknown type, and a broken structure. Needs no more memory than the file and 256 MB.
DicomMeta checkDicomStructure(const std::string& name, std::span<const std::byte> bytes);

// Throws SceneError "NAME: WHAT".
[[noreturn]] void refuseDicom(const std::string& name, const std::string& what);

}  // namespace echocine
