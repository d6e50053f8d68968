#pragma once
// A DICOM file's structure, checked before the library sees it: its parser recurses once per nested
// sequence and inflates whatever a deflated data set promises.

#include <cstddef>
#include <span>
#include <string>

#include "video/dicom_meta.h"

namespace echocine {

// The file's meta information, after its data set was followed to the end. Throws SceneError as
// readDicomMeta() does, and for sequences nested deeper than 32, a deflated data set of over 256
// MB, elements of unknown type and data whose structure cannot be followed. Costs no more than the
// file and 256 MB.
DicomMeta checkDicomStructure(const std::string& name, std::span<const std::byte> bytes);

// Throws SceneError "NAME: WHAT".
[[noreturn]] void refuseDicom(const std::string& name, const std::string& what);

}  // namespace echocine
