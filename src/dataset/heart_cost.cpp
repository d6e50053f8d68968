#include "dataset/heart_cost.h"

#include <chrono>

#include "core/peak_memory.h"
#include "core/stop.h"
#include "dataset/make_dataset.h"

namespace echocine::dataset {

HeartCost costOfAHeart(const Spec& spec, const std::filesystem::path& output,
                       const Monitor& monitor) {
  std::filesystem::path scratch = output.has_filename() ? output : output.parent_path();
  scratch += ".part.d";
  const auto remove = [&] {
    std::error_code failed;
    std::filesystem::remove_all(scratch, failed);
  };
  remove();
  Spec one = spec;
  one.hearts = 1;
  Monitor quiet;
  quiet.keep_going = monitor.keep_going;
  const auto start = std::chrono::steady_clock::now();
  try {
    const MakeSummary made = makePart(one, {scratch, 1, 1, 1}, quiet);
    remove();
    if (made.failed > 0)
      throw JobError(
          "the first heart, which is made to estimate the cost, failed: run without --slurm or "
          "--preview to see why");
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    constexpr double kMegabyte = 1 << 20;
    return {passed.count(), static_cast<double>(made.bytes), peakMemory_bytes() / kMegabyte};
  } catch (...) {
    remove();
    // Its hearts are gone, so a stopped run's word that they are kept would be wrong.
    if (!monitor.keep_going()) throw Stopped();
    throw;
  }
}

}  // namespace echocine::dataset
