#pragma once
// The file meta information of a DICOM file (PS3.10, 7.1): the transfer syntax of its data set.

#include <cstddef>
#include <span>
#include <string>

namespace echocine {

struct DicomMeta {
  std::string transfer_syntax;  // its UID, one that DCMTK knows
  std::size_t data_at = 0;      // start of the data set, bytes from the start of the file
};

// Read by our own parser and by DCMTK's. Throws SceneError if the two disagree on the transfer
// syntax or on the start of the data set: checks based on one parser would not hold for the other.
// Also rejected: elements outside group 0002, sequences, an inconsistent group length, a missing
// transfer syntax, or one unknown to DCMTK. Precondition: the bytes begin with the preamble and
// "DICM".
DicomMeta readDicomMeta(const std::string& name, std::span<const std::byte> bytes);

}  // namespace echocine
