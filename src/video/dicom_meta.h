#pragma once
// The file meta information of a DICOM file (PS3.10, 7.1): the transfer syntax of its data set.

#include <cstddef>
#include <span>
#include <string>

namespace echocine {

struct DicomMeta {
  std::string transfer_syntax;  // its UID, one that DCMTK knows
  std::size_t data_at = 0;      // where the data set begins, bytes from the file's start
};

// Read twice, by our own parser and by DCMTK's. Throws SceneError where the two disagree on the
// transfer syntax or on where the data set begins: guards that follow one parser would not hold for
// the other. Also refused: elements of another group than 0002, sequences, a group length that
// other bytes contradict, no transfer syntax or one that DCMTK does not know.
// Precondition: the bytes begin with the preamble and "DICM".
DicomMeta readDicomMeta(const std::string& name, std::span<const std::byte> bytes);

}  // namespace echocine
