#include "estimate.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "core/error.h"
#include "motion/cardiac_clock.h"

namespace echocine {

namespace {

struct TemporaryFolder {
  std::filesystem::path path;

  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "echocine-plan-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw JobError(fmt::format("{}: no temporary folder can be made", name));
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

double largestResidentBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

Estimate estimateLoop(const Scene& scene, int threads) {
  constexpr int kFrames = 6;
  const TemporaryFolder folder;
  Estimate estimate;
  estimate.frames = CardiacClock(scene.acquisition).frameCount();
  const int rendered = std::min(kFrames, estimate.frames);
  Scene few = scene;  // the reference's value does not change the cost of using it
  few.signal.reference_intensity = scene.signal.reference_intensity.value_or(1);
  const RenderSummary summary = renderCine(
      few, {.folder = folder.path, .threads = threads, .frames = std::pair(0, rendered)}, {});
  estimate.measured = summary.manifest;
  // The first pass of a percentile reference repeats what stands before compression for frames not
  // kept.
  estimate.seconds = summary.manifest.wall_ms * 1e-3 * estimate.frames;
  estimate.memory_bytes = largestResidentBytes();
  return estimate;
}

}  // namespace echocine
