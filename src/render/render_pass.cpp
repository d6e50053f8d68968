#include "render/render_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/stage_clock.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/loop_ecg.h"
#include "output/volumes_csv.h"
#include "signal/signal_chain.h"
#include "truth/frame_truth.h"

namespace echocine {

namespace {

// "frame_0012.png" beside "frame_0012.exr".
std::string frameName(int frame, const char* extension) {
  return std::filesystem::path(ExrStack::fileName(frame)).replace_extension(extension).string();
}

}  // namespace

FolderSink::FolderSink(const Parts& parts, Manifest& manifest)
    : parts_(parts), manifest_(manifest) {}

void FolderSink::begin(double white) {
  const Simulator& simulator = parts_.simulator;
  const Scene& scene = simulator.scene();
  manifest_.reference_intensity = white;
  exr_.emplace(parts_.folder.intensity(), scene, manifest_.scene_sha256, white);
  overlay_.emplace(scene, simulator.chain().geometry(),
                   scene.output.ecg
                       ? loopEcg(simulator.cardiacClock(), scene.acquisition.frame_rate_hz)
                       : std::vector<double>{});
  loop_.emplace(parts_.folder, simulator, parts_.range, manifest_.scene_sha256);
  const TruthMaker* const truth = simulator.truth();
  if (truth == nullptr) return;
  truth_files_.emplace(parts_.folder.truth(), scene, truth->labels());
  manifest_.files.merge(truth_files_->writeTables());
}

void FolderSink::writeTruth(Finished& finished) {
  const FrameRecord& record = finished.entry.record;
  finished.truth_files = truth_files_->write(record, *finished.truth, finished.files);
  if (!parts_.report.shows(record.frame)) return;
  const Scene& scene = parts_.simulator.scene();
  finished.page_truth = pageTruth(*finished.truth, scene, colouredLabels(scene, *finished.truth));
}

void FolderSink::writeExr(const FrameRecord& record, const Workspace& workspace,
                          Finished& finished) {
  if (!parts_.simulator.scene().output.exr || !finished.entry.exr_sha256.empty()) return;
  const OutputSettings& output = parts_.simulator.scene().output;
  std::vector<ChannelPlane> planes = channelPlanes(output, workspace);
  for (const Channel channel : output.channels)
    if (channel == Channel::structure)
      planes.push_back({channel, {}, finished.truth->sample_ids});
    else if (isMotion(channel))
      planes.push_back({channel, finished.truth->values(channel), {}});
  finished.files.push_back(exr_->prepare(record, planes, finished.entry.exr_sha256));
}

// Browsers show JPEG and PNG, but no FFV1: then the report needs pictures of its own.
void FolderSink::writePictures(GreyImage& image, Finished& finished) {
  const OutputSettings& o = parts_.simulator.scene().output;
  const int frame = finished.entry.record.frame;
  overlay_->draw(image, static_cast<double>(frame) / parts_.simulator.cardiacClock().frameCount());
  finished.loop = loop_->encode(image);
  const bool shown = parts_.report.shows(frame) && !(o.cine && o.codec == CineCodec::mjpg);
  if (shown && !o.png)
    finished.report_frame = encodeCineFrame(image, CineCodec::mjpg, o.jpeg_quality);
  if (!o.png) return;
  std::vector<std::byte> png = encodePng(image);
  finished.files.emplace_back(parts_.folder.png() / frameName(frame, ".png"), png);
  finished.png_sha256 = sha256Hex(png);
  if (shown) finished.report_frame = std::move(png);
}

// A frame of an earlier run, when it is the very one: by its own digest and by that run's manifest.
void FolderSink::takeEarlier(const FrameRecord& record, Finished& finished) const {
  const std::string name = "intensity/" + ExrStack::fileName(record.frame);
  std::error_code absent;
  if (!std::filesystem::exists(parts_.folder.intensity() / ExrStack::fileName(record.frame),
                               absent))
    return;
  std::string sha256 = exr_->existing(record);
  const auto noted = parts_.earlier_hashes.find(name);
  const bool as_noted = noted == parts_.earlier_hashes.end() || noted->second == sha256;
  if (!sha256.empty() && as_noted)
    finished.entry.exr_sha256 = std::move(sha256);
  else
    finished.mended = fmt::format("{}: {}, it is rendered again", name,
                                  sha256.empty() ? "damaged, or not as this run would write it"
                                                 : "not the file in the manifest");
}

std::shared_ptr<void> FolderSink::take(MadeFrame& frame) {
  auto finished = std::make_shared<Finished>();
  finished->entry.record = {frame.time.frame, frame.time.time_s, frame.time.phase, frame.time.beat};
  finished->entry.volumes_ml = std::move(frame.volumes_ml);
  finished->truth = std::move(frame.truth);
  const FrameRecord& record = finished->entry.record;
  StageClock& clock = parts_.simulator.clock();
  const OutputSettings& o = parts_.simulator.scene().output;
  if (parts_.resume && o.exr) clock.time(Stage::exr, [&] { takeEarlier(record, *finished); });
  if (truth_files_) clock.time(Stage::truth, [&] { writeTruth(*finished); });
  clock.time(Stage::exr, [&] { writeExr(record, frame.workspace, *finished); });
  if (finished->truth) finished->truth->forgetPlanes();
  if (o.pictures())
    clock.time(Stage::avi, [&] { writePictures(frame.workspace.image, *finished); });
  return finished;
}

// One at a time, in the order of the frames.
void FolderSink::inOrder(void* taken) {
  Finished& finished = *static_cast<Finished*>(taken);
  // A folder that was moved away would otherwise be made anew, file by file.
  parts_.folder.checkStillThere();
  const FrameEntry& entry = finished.entry;
  const int frame = entry.record.frame;
  const OutputSettings& o = parts_.simulator.scene().output;
  for (PendingFile& file : finished.files) group_.add(std::move(file));
  if (group_.isDue()) parts_.simulator.clock().time(Stage::exr, [&] { group_.finish(); });
  if (!finished.mended.empty()) parts_.monitor.warn(finished.mended);
  if (o.pictures()) {
    parts_.simulator.clock().time(Stage::avi, [&] {
      loop_->add(finished.loop);
      if (parts_.report.shows(frame))
        parts_.report.addFrame(finished.report_frame.empty() ? finished.loop.cine
                                                             : finished.report_frame);
    });
  }
  if (!entry.exr_sha256.empty())
    manifest_.files["intensity/" + ExrStack::fileName(frame)] = entry.exr_sha256;
  if (!finished.png_sha256.empty())
    manifest_.files["png/" + frameName(frame, ".png")] = finished.png_sha256;
  if (truth_files_) {
    truth_files_->add(entry.record, *finished.truth);
    if (parts_.report.shows(frame)) parts_.report.addTruth(std::move(finished.page_truth));
  }
  manifest_.files.merge(finished.truth_files);
  manifest_.frames.push_back(entry);
}

void FolderSink::endEarly() {
  const auto tried = [](const auto& end) {
    try {
      end();
    } catch (const std::exception&) {  // the first failure is the one to report
    }
  };
  tried([&] { group_.finish(); });
  tried([&] {
    if (loop_) loop_->finishEarly();
  });
}

namespace {

// The instant of the first beat at which it has a phase, also of a loop that ends before; phases
// ascend within a beat.
double timeOfPhase(const CardiacClock& clock, double phase) {
  double low_s = 0, high_s = clock.at(0).beat_s;
  for (int i = 0; i < 60; ++i) {
    const double middle_s = 0.5 * (low_s + high_s);
    const FrameTime time = clock.atTime(middle_s);
    (time.beat == 0 && time.phase < phase ? low_s : high_s) = middle_s;
  }
  return high_s;
}

}  // namespace

void FolderSink::finishTruth() {
  const TruthMaker& truth = *parts_.simulator.truth();
  LoopTruth loop{truth.tracked(), truth.view(), {}};
  if (const auto& valves = truth.valves()) {
    const CardiacClock& clock = parts_.simulator.cardiacClock();
    for (const auto& [name, phase] : {std::pair("mitral_closes", valves->mitral_closes),
                                      std::pair("aortic_opens", valves->aortic_opens),
                                      std::pair("aortic_closes", valves->aortic_closes),
                                      std::pair("mitral_opens", valves->mitral_opens)})
      loop.events.push_back({name, phase, timeOfPhase(clock, phase)});
  }
  manifest_.files.merge(truth_files_->finish(loop));
  manifest_.curves = functionCurves(truth_files_->functions());
}

void FolderSink::finish(bool whole) {
  if (!loop_) return;  // stopped before the first frame
  try {
    parts_.simulator.clock().time(Stage::exr, [&] { group_.finish(); });
  } catch (...) {
    endEarly();
    throw;
  }
  if (parts_.simulator.scene().output.pictures() && !manifest_.frames.empty())
    parts_.simulator.clock().time(Stage::avi, [&] {
      if (whole)
        manifest_.files.merge(loop_->finish());
      else
        loop_->finishEarly();
    });
  if (whole && truth_files_) finishTruth();
  const Scene& scene = parts_.simulator.scene();
  if (!whole || !scene.output.volumes || !hasChambers(scene)) return;
  const std::string table = volumesCsv(scene, manifest_);
  const auto bytes = std::as_bytes(std::span(table));
  writeFileWhole(parts_.folder.volumes(), bytes);
  manifest_.files["volumes.csv"] = sha256Hex(bytes);
}

}  // namespace echocine
