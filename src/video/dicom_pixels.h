#pragma once
// Pixel data of a DICOM data set, checked before anything is decoded: DCMTK's decoders reserve what
// a header states, and its RLE decoder follows the offsets of a segment out of the frame.

#include <cstdint>
#include <string>

class DcmDataset;

namespace echocine {

// Looks at the data set as the decoders will see it, so there is no second reading to disagree.
// Throws SceneError: no pictures, a loop beyond the limits, fewer bytes than the pictures need,
// more pixels than compressed bytes can hold, an RLE header that points outside its frame.
void checkDicomPixels(const std::string& name, DcmDataset& data, std::int64_t frames);

}  // namespace echocine
