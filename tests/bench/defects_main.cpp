// defect_table [HEARTS [fit [VIEWS [FIRST]]]]: regions that differ by more than a perfect model
// would, for planted defects of the septum and for perfect models in several looks. In a4c with
// known dials; or the dials are fitted in one to three views, which takes as long as in fit_table.

#include <fmt/format.h>

#include <algorithm>
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

// Hearts whose atria, right ventricles and twist are the model's.
std::map<std::string, double> dialsOf(int heart) {
  std::map<std::string, double> dials = plantedHeart(heart, 0, 0).dials;
  for (const char* key : {"la-volume", "twist", "rv-edv"}) dials.erase(key);
  return dials;
}

// Findings in the views of one fit; the key of the view precedes the name of the region.
std::vector<RegionFinding> regionsOfFit(const PlantedHeart& heart) {
  HeartFitOptions options;
  options.other_views = false;
  const HeartFit fit = fitHeart(heart.given(), options);
  fmt::print("EF {:.3f}, EDV {:.1f} mL, {} own look, agreement {}, {:.0f} s\n", fit.dials.at("ef"),
             fit.dials.at("edv"), fit.own_look ? "with" : "without",
             fit.agreement ? fmt::format("{:.2f}", *fit.agreement) : "not measured",
             1e-3 * fit.cpu_ms);
  std::vector<RegionFinding> all;
  for (const ViewFitted& view : fit.views)
    for (RegionFinding region : view.regions) {
      region.name = fmt::format("{} {}", keyOf(view.view), region.name);
      all.push_back(std::move(region));
    }
  return all;
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

using Counts = std::map<std::string, Count>;

void runKnown(int hearts, Counts& counts) {
  for (int h = 0; h < hearts; ++h) {
    const auto dials = dialsOf(h);
    const auto sceneIn = [&](Defect defect, Look look) {
      return defectScene(dials, defect, View::a4c, 20, look);
    };
    const PerfectModel perfect(sceneIn(Defect::none, Look::scanner));
    int seed = 1000 + 20 * h;
    const auto look = [&](const std::string& what, const Scene& scene) {
      tell(fmt::format("{}, heart {}", what, h),
           perfect.against(scannedLoop(scene, kFitFrames, ++seed)), counts[what]);
    };
    for (const Defect defect : kDefects) look(nameOf(defect), sceneIn(defect, Look::scanner));
    for (const Look other : scannerLooks())
      if (other != Look::scanner)
        look(fmt::format("none, look {}", nameOf(other)), sceneIn(Defect::none, other));
  }
}

void runFitted(int hearts, std::size_t views, int first, Counts& counts) {
  for (int h = first; h < first + hearts; ++h) {
    int seed = 1000 + 20 * h;
    for (const Defect defect : kDefects) {
      ++seed;
      PlantedHeart heart{dialsOf(h), {}};
      for (std::size_t v = 0; v < views; ++v)
        heart.loops.push_back(
            scannedLoop(defectScene(heart.dials, defect, kPlantedViews[v], 20, Look::scanner),
                        kFitFrames, seed + 1000 * static_cast<int>(v)));
      const std::string what = nameOf(defect);
      tell(fmt::format("{}, heart {}", what, h), regionsOfFit(heart), counts[what]);
    }
  }
}

void print(const Counts& counts) {
  for (const auto& [what, count] : counts)
    fmt::print("{}: {} loops, a significant region in {}, the largest in the septum in {}\n", what,
               count.loops, count.anything, count.in_septum);
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  const int hearts = argc > 1 ? std::atoi(argv[1]) : 10;
  const bool fitted = argc > 2 && std::strcmp(argv[2], "fit") == 0;
  const int views = argc > 3 ? std::clamp(std::atoi(argv[3]), 1, 3) : 1;
  const int first = argc > 4 ? std::atoi(argv[4]) : 0;
  echocine::bench::Counts counts;
  echocine::withThreads(0, [&] {
    if (fitted)
      echocine::bench::runFitted(hearts, static_cast<std::size_t>(views), first, counts);
    else
      echocine::bench::runKnown(hearts, counts);
  });
  echocine::bench::print(counts);
}
