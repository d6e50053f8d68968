// defect_table [HEARTS [fit]]: regions that differ by more than a perfect model would, for planted
// defects of the septum and for perfect models in several looks. The dials are known, or all five
// are fitted (2 minutes of one core a loop).

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <map>

#include "core/parallel.h"
#include "scene/looks.h"
#include "scene/names.h"
#include "support/planted_defects.h"
#include "support/planted_fits.h"

namespace echocine::bench {
namespace {

using namespace echo;
using namespace fit;
using namespace support;

struct Count {
  int loops = 0, anything = 0, in_septum = 0;
};

// Hearts in a4c; their atria, right ventricles and twist are the model's.
std::map<std::string, double> dialsOf(int heart) {
  std::map<std::string, double> dials = plantedHeart(heart, 0, 0).dials;
  for (const char* key : {"la-volume", "twist", "rv-edv"}) dials.erase(key);
  return dials;
}

std::vector<RegionFinding> regionsOfFit(const EchoLoop& loop) {
  FitLoop given{View::a4c, loop, {}};
  given.side.ed_frame = 0;
  HeartFitOptions options;
  options.other_views = false;
  return fitHeart({given}, options).views.front().regions;
}

void tell(const std::string& what, const std::vector<RegionFinding>& regions, Count& count) {
  const Detected detected = detectedBy(regions);
  ++count.loops;
  count.anything += detected.significant > 0 ? 1 : 0;
  count.in_septum += detected.in_septum ? 1 : 0;
  fmt::print("{}\n", what);
  for (const RegionFinding& r : regions)
    if (r.segment > 0 || r.significant)
      fmt::print(
          "  {}: {:+.2f} ({:.2f}) mm, change {:+.2f} ({:.2f}) mm, local {:+.2f} ({:.2f}) mm, "
          "certainty {:.2f}{}\n",
          r.name, r.offset_mm, r.offset_sd_mm, r.motion_mm, r.motion_sd_mm, r.local_mm.value_or(0),
          r.local_sd_mm, r.certainty, r.significant ? ", significant" : "");
  std::fflush(stdout);
}

void run(int hearts, bool fitted) {
  std::map<std::string, Count> counts;
  for (int h = 0; h < hearts; ++h) {
    const auto dials = dialsOf(h);
    const auto sceneIn = [&](Defect defect, Look look) {
      return defectScene(dials, defect, View::a4c, 20, look);
    };
    std::optional<PerfectModel> perfect;
    if (!fitted) perfect.emplace(sceneIn(Defect::none, Look::scanner));
    int seed = 1000 + 20 * h;
    const auto look = [&](const std::string& what, const Scene& scene) {
      const EchoLoop loop = scannedLoop(scene, kFitFrames, ++seed);
      tell(fmt::format("{}, heart {}", what, h),
           fitted ? regionsOfFit(loop) : perfect->against(loop), counts[what]);
    };
    for (const Defect defect : kDefects) look(nameOf(defect), sceneIn(defect, Look::scanner));
    if (fitted) continue;
    for (const Look other : scannerLooks())
      if (other != Look::scanner)
        look(fmt::format("none, look {}", nameOf(other)), sceneIn(Defect::none, other));
  }
  for (const auto& [what, count] : counts)
    fmt::print("{}: {} loops, a significant region in {}, the largest in the septum in {}\n", what,
               count.loops, count.anything, count.in_septum);
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  const int hearts = argc > 1 ? std::atoi(argv[1]) : 10;
  const bool fitted = argc > 2 && std::strcmp(argv[2], "fit") == 0;
  echocine::withThreads(0, [&] { echocine::bench::run(hearts, fitted); });
}
