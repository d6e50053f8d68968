#include "doppler/doppler_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
#include "core/hash.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/seal.h"
#include "core/stop.h"
#include "core/units.h"
#include "doppler/colour_overlay.h"
#include "doppler/spectrum_files.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/loop_ecg.h"
#include "motion/surfaces/probe_placement.h"
#include "output/output_folder.h"
#include "output/plane_exr.h"
#include "output/polar_plane.h"
#include "output/scene_sha256.h"
#include "scene/names.h"
#include "video/animation.h"
#include "video/cine_writer.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// Browsers show frames of less than 1/50 s slowly.
constexpr double kMostGifFrames = 50;

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::vector<float> rowsOf(std::span<const float> plane, const Probe& probe) {
  return rowsFromLines(plane, static_cast<std::size_t>(probe.lines),
                       static_cast<std::size_t>(probe.samples));
}

std::vector<std::byte> exrOf(const DopplerFrame& frame, const Probe& probe,
                             const DopplerRequest& request) {
  const std::vector<float> greys = rowsOf(frame.greys, probe),
                           velocity = rowsOf(frame.measured.velocity_m_s, probe),
                           variance = rowsOf(frame.measured.variance_m2_s2, probe),
                           power = rowsOf(frame.measured.power, probe),
                           exact = rowsOf(frame.exact_m_s, probe);
  PlaneExr exr;
  exr.width = probe.lines;
  exr.height = probe.samples;
  exr.channels = {{"display", greys},
                  {"doppler.power", power},
                  {"doppler.variance", variance},
                  {"doppler.velocity", velocity},
                  {"velocity.beam", exact}};
  exr.numbers = {{"echocine:time_s", frame.time.time_s},
                 {"echocine:phase", frame.time.phase},
                 {"echocine:prf_hz", request.prf_hz},
                 {"echocine:pulses", request.pulses},
                 {"echocine:nyquist_m_s", nyquistVelocity(probe, request.prf_hz)},
                 {"echocine:min_depth_m", probe.min_depth_m},
                 {"echocine:max_depth_m", probe.max_depth_m}};
  exr.texts = {{"echocine:version", ECHOCINE_VERSION},
               {"echocine:wall_filter", nameOf(request.wall)}};
  return encodePlaneExr(exr);
}

// Sums over the tissue of the frames, weighted by power.
struct Agreement {
  double weight = 0, sum = 0, squares = 0;
  std::size_t tissue = 0, aliased = 0;

  void add(const DopplerFrame& frame, double nyquist) {
    for (std::size_t i = 0; i < frame.exact_m_s.size(); ++i) {
      const auto exact = static_cast<double>(frame.exact_m_s[i]);
      const auto measured = static_cast<double>(frame.measured.velocity_m_s[i]);
      if (std::isnan(exact) || std::isnan(measured)) continue;
      const auto power = static_cast<double>(frame.measured.power[i]);
      const double off = std::remainder(measured - exact, 2 * nyquist);
      weight += power;
      sum += power * off;
      squares += power * off * off;
      ++tissue;
      aliased += std::abs(exact) > nyquist;
    }
  }
};

// An unfinished folder has no doppler.json, and no spectrum or GIF of an earlier run.
void prepare(const std::filesystem::path& folder, std::optional<FolderLock>& lock) {
  makeFolder(folder);
  lock.emplace(folder);
  std::error_code ignored;
  for (const char* name :
       {"doppler.json", "doppler.gif", "spectrum.exr", "spectrum.png", "spectrum.csv"}) {
    checkOutputFile(folder / name);
    std::filesystem::remove(folder / name, ignored);
  }
  makeFolder(folder / "velocity");
  for (const char* ending : {".exr", ".png"})
    removeNumbered(folder / "velocity", {"frame_", ending}, 0);
}

struct Made {
  DopplerFrame frame;
  std::vector<std::byte> exr, png;
  GreyImage picture;
};

// Writes files beside, renamed, and keeps their digests.
class Files {
 public:
  explicit Files(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void write(const std::string& name, std::span<const std::byte> bytes) {
    if (folder_.empty()) return;
    unstoppable([&] { writeFileWhole(folder_ / name, bytes); });
    digests_[name] = sha256Hex(bytes);
  }
  const Json& digests() const { return digests_; }

 private:
  std::filesystem::path folder_;
  Json digests_ = Json::object();
};

class LoopWriter {
 public:
  LoopWriter(const Simulator& simulator, const DopplerOptions& options, double white, Files& files)
      : simulator_(simulator),
        scene_(simulator.scene()),
        options_(options),
        white_(white),
        nyquist_(nyquistVelocity(scene_.probe, options.request.prf_hz)),
        ticks_(scene_, simulator.chain().geometry(),
               scene_.output.ecg
                   ? loopEcg(simulator.cardiacClock(), scene_.acquisition.frame_rate_hz)
                   : std::vector<double>{}),
        overlay_(scene_, simulator.chain(), ticks_, nyquist_),
        colours_(dopplerColours()),
        shown_(std::max(
            1, static_cast<int>(std::ceil(scene_.acquisition.frame_rate_hz / kMostGifFrames)))),
        encoder_({AnimationFormat::gif, overlay_.width(), overlay_.height(),
                  scene_.acquisition.frame_rate_hz / shown_, colours_}),
        files_(files) {}

  void write(const Monitor& monitor) {
    const auto frames = static_cast<std::size_t>(simulator_.cardiacClock().frameCount());
    const std::size_t made = parallelOrdered(
        0, frames, static_cast<std::size_t>(threadCount()), monitor.keep_going,
        [&](std::size_t i) -> std::shared_ptr<void> {
          return std::make_shared<Made>(make(static_cast<int>(i), frames));
        },
        [&](std::size_t i, const std::shared_ptr<void>& one) {
          take(static_cast<int>(i), *static_cast<Made*>(one.get()));
          monitor.tell({Task::rendering, i + 1, frames});
        });
    if (made < frames) throw Stopped();
    if (!options_.folder.empty()) files_.write("doppler.gif", encoder_.finish());
  }

  DopplerSummary summary() const {
    DopplerSummary s;
    s.frames = simulator_.cardiacClock().frameCount();
    s.nyquist_m_s = nyquist_;
    if (agreement_.weight > 0) {
      s.bias_m_s = agreement_.sum / agreement_.weight;
      s.rms_m_s = std::sqrt(agreement_.squares / agreement_.weight);
      s.aliased_share =
          static_cast<double>(agreement_.aliased) / static_cast<double>(agreement_.tissue);
    }
    return s;
  }

 private:
  Made make(int i, std::size_t frames) const {
    Made made;
    made.frame = makeDopplerFrame(simulator_, options_.request, i, white_);
    if (options_.folder.empty()) return made;
    made.exr = exrOf(made.frame, scene_.probe, options_.request);
    made.picture = overlay_.draw(made.frame, white_, i / static_cast<double>(frames));
    if (options_.png) made.png = encodePng(made.picture, colours_);
    return made;
  }

  void take(int i, const Made& made) {
    agreement_.add(made.frame, nyquist_);
    if (options_.take) options_.take(made.frame);
    if (options_.folder.empty()) return;
    files_.write(fmt::format("velocity/frame_{:04d}.exr", i), made.exr);
    if (options_.png) files_.write(fmt::format("velocity/frame_{:04d}.png", i), made.png);
    if (i % shown_ == 0) encoder_.add(made.picture);
  }

  const Simulator& simulator_;
  const Scene& scene_;
  const DopplerOptions& options_;
  double white_, nyquist_;
  Overlay ticks_;
  ColourOverlay overlay_;
  GreyColours colours_;
  int shown_;  // one of so many frames is in the GIF
  AnimationEncoder encoder_;
  Files& files_;
  Agreement agreement_;
};

Json jsonOf(const DopplerSummary& summary, const Simulator& simulator,
            const DopplerOptions& options) {
  Json json;
  json["version"] = ECHOCINE_VERSION;
  json["scene_sha256"] = sceneSha256(simulator.scene(), simulator.motion());
  json["frames"] = summary.frames;
  json["frame_rate_hz"] = simulator.scene().acquisition.frame_rate_hz;
  json["pulses"] = options.request.pulses;
  json["prf_hz"] = options.request.prf_hz;
  json["gate_mm"] = millimetresFromMetres(options.request.gate_m);
  json["wall_filter"] = nameOf(options.request.wall);
  json["nyquist_m_s"] = summary.nyquist_m_s;
  json["against_truth"] = {{"bias_m_s", summary.bias_m_s},
                           {"rms_m_s", summary.rms_m_s},
                           {"aliased_share", summary.aliased_share}};
  if (const auto& s = summary.spectrum) {
    json["spectrum"] = {{"line", s->line},
                        {"depth_mm", millimetresFromMetres(s->depth_m)},
                        {"columns", s->columns},
                        {"bins", s->bins},
                        {"peak_systolic_m_s", s->mean_peak},
                        {"exact_peak_systolic_m_s", s->exact_peak}};
  }
  return json;
}

void writeSpectrum(const Spectrum& spectrum, const DopplerOptions& options, Files& files) {
  files.write("spectrum.exr",
              spectrumExr(spectrum, options.request.prf_hz, options.spectrum->step_s));
  files.write("spectrum.png", encodePng(spectrumPicture(spectrum)));
  files.write("spectrum.csv", bytesOf(spectrumCsv(spectrum)));
}

}  // namespace

DopplerSummary writeDoppler(const Scene& given, const DopplerOptions& options,
                            const Monitor& monitor) {
  Scene scene = placed(given);
  scene = options.spectrum ? spectrumScene(std::move(scene), options.request, *options.spectrum)
                           : dopplerScene(std::move(scene), options.request);
  DopplerSummary summary;
  withThreads(options.threads, [&] {
    const Simulator simulator(scene);
    passWarnings(simulator, monitor);
    if (options.spectrum) checkSpectrum(simulator, options.request, *options.spectrum);
    std::optional<FolderLock> lock;
    if (!options.folder.empty()) prepare(options.folder, lock);
    const std::optional<double> white = simulator.referenceIntensity(monitor, {});
    if (!white) throw Stopped();
    Files files(options.folder);
    LoopWriter writer(simulator, options, *white, files);
    writer.write(monitor);
    summary = writer.summary();
    if (options.spectrum) {
      summary.spectrum =
          makeSpectrum(simulator, options.request, *options.spectrum, *white, monitor);
      writeSpectrum(*summary.spectrum, options, files);
    }
    if (!lock) return;
    lock->checkStillThere();
    Json json = jsonOf(summary, simulator, options);
    json["files"] = files.digests();
    unstoppable(
        [&] { writeFileWhole(options.folder / "doppler.json", bytesOf(sealed(json.dump(1)))); });
  });
  return summary;
}

}  // namespace echocine
