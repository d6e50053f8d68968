// DICOM: SPLIT/ID.dcm, an ultrasound loop for viewers. Loops of a heart are one examination of one
// patient.

#include <fmt/format.h>

#include "core/hash.h"
#include "dataset/layout.h"
#include "motion/cycle/r_waves.h"
#include "video/dicom_writer.h"

namespace echocine::dataset {

namespace {

// By what makes a heart, so that a dataset with more hearts or views keeps its identifiers.
std::string identity(const Spec& spec, const std::string& name) {
  const std::string text = spec.heart_digest + " " + name;
  return sha256Hex(std::as_bytes(std::span(text)));
}

void writeDicom(const Spec& spec, const Heart& heart, Sink& sink, Json&) {
  for (const LoopSample& loop : heart.loops) {
    std::vector<FrameTime> times;
    std::vector<const GreyImage*> images;
    for (const LoopFrame& frame : loop.frames) {
      times.push_back(frame.time);
      images.push_back(&frame.image);
    }
    DicomLoop header{loop.scene,
                     identity(spec, loop.id),
                     0,
                     static_cast<int>(loop.frames.size()),
                     rWaves(times),
                     loop.view,
                     identity(spec, fmt::format("heart {}", heart.number))};
    OutputSettings& output = header.scene.output;
    output.codec = CineCodec::mjpg;
    output.jpeg_quality = kJpegQuality;
    sink.writeDicom(fmt::format("dicom/{}/{}.dcm", nameOf(heart.split), loop.id), images, header);
  }
}

}  // namespace

const Layout kDicom{"dicom", writeDicom, nullptr};

}  // namespace echocine::dataset
