#pragma once
// The header of a DICOM loop: everything before the pixels.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// A loop for a DICOM file. The patient is synthetic, and no name of a file, person or machine is
// written.
struct DicomLoop {
  Scene scene;                    // with the probe's pose
  std::string scene_sha256;       // identifiers are made of it
  int first_frame = 0;            // of the scene's loop
  int frames = 0;                 // at least 1
  std::vector<double> r_waves_s;  // from the first frame
  std::optional<View> view;       // the standard view of the imaging plane, if it is one
  // The same for all loops of an examination: identifiers of patient and study are made of it.
  // Empty: made of the scene.
  std::string examination_sha256{};
};

// Ultrasound Multi-frame Image (PS3.3 A.7): preamble, file meta information and the data set up to
// the pixel data, which the caller appends. Lossless cines have RGB pixels in explicit little
// endian, others JPEG baseline of YBR_FULL_422. At most 16383 R waves are written.
std::vector<std::byte> dicomHeader(const DicomLoop& loop);

// "1.2.840.10008.1.2.1" without compression: codec ffv1.
bool isPlainDicom(const OutputSettings& output);

}  // namespace echocine
