#pragma once
// Checks the pixel data of a DICOM data set before decoding: DCMTK's decoders allocate what a
// header states, and its RLE decoder follows segment offsets out of the frame.

#include <cstdint>
#include <string>

class DcmDataset;

namespace echocine {

// Checks the data set in memory, the one that is decoded, so the two readings cannot disagree.
// Throws SceneError for no pictures, a loop beyond the limits, fewer bytes than the pictures need,
// more pixels than compressed bytes can contain, and an RLE header that points outside its frame.
void checkDicomPixels(const std::string& name, DcmDataset& data, std::int64_t frames);

}  // namespace echocine
