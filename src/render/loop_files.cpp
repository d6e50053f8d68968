#include "render/loop_files.h"

#include "core/hash.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/r_waves.h"
#include "scene/view_names.h"
#include "truth/view_offset.h"

namespace echocine {

namespace {

std::vector<double> rWavesOf(const CardiacClock& clock, std::pair<int, int> range) {
  std::vector<FrameTime> times;
  for (int frame = range.first; frame < range.second; ++frame) times.push_back(clock.at(frame));
  return rWaves(times);
}

// By the plane's position in the heart, so it does not matter how the scene places the probe.
std::optional<View> shownView(const Simulator& simulator) {
  const std::optional<ViewOffset> view = viewOffset(simulator.scene(), simulator.motion());
  return view ? viewOf(view->label) : std::nullopt;
}

}  // namespace

LoopFiles::LoopFiles(const OutputFolder& folder, const Simulator& simulator,
                     std::pair<int, int> range, const std::string& scene_sha256)
    : output_(simulator.scene().output), cine_path_(folder.cine()), dicom_path_(folder.dicom()) {
  const Scene& scene = simulator.scene();
  if (output_.cine) cine_.emplace(cine_path_, output_, scene.acquisition.frame_rate_hz);
  if (output_.dicom)
    dicom_.emplace(dicom_path_,
                   DicomLoop{scene, scene_sha256, range.first, range.second - range.first,
                             rWavesOf(simulator.cardiacClock(), range), shownView(simulator)});
}

LoopFiles::Frame LoopFiles::encode(const GreyImage& image) const {
  Frame frame;
  if (cine_) frame.cine = encodeCineFrame(image, output_.codec, output_.jpeg_quality);
  if (dicom_) frame.dicom = encodeDicomFrame(image, output_);
  return frame;
}

void LoopFiles::add(const Frame& frame) {
  if (cine_) cine_->add(frame.cine);
  if (dicom_) dicom_->add(frame.dicom);
}

std::map<std::string, std::string> LoopFiles::finish() {
  std::map<std::string, std::string> files;
  if (cine_) {
    cine_->finish();
    files["cine.avi"] = sha256HexOfFile(cine_path_);
  }
  if (dicom_) {
    dicom_->finish();
    files["cine.dcm"] = sha256HexOfFile(dicom_path_);
  }
  return files;
}

void LoopFiles::finishEarly() {
  dicom_.reset();
  if (cine_) cine_->finishEarly();
}

}  // namespace echocine
