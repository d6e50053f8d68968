// beat_table [LOOPS]: lengths of the beat that are found in planted loops of several beats, with
// and without R waves, and with R waves that are missing.

#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "core/parallel.h"
#include "core/units.h"
#include "echo/beat_length.h"
#include "motion/surfaces/probe_placement.h"
#include "support/planted_beats.h"
#include "support/planted_fits.h"

namespace echocine::bench {
namespace {

using namespace support;

constexpr int kHearts = 8, kPhases = 48;
constexpr double kPlane_deg = 6;  // between both planes

struct Planes {
  echo::EchoLoop one, other;
};

// Hearts, views and looks in turn.
Planes planesOf(int heart) {
  const auto dials = plantedHeart(heart, 0, 0).dials;
  const View view = kPlantedViews[heart % 3];
  const Look look = heart % 4 == 3 ? Look::clean : heart % 8 == 6 ? Look::paper : Look::scanner;
  Scene scene = heart::heartScene(heart::parametersFrom(dials), view, 20, look);
  scene.probe.lines = 96;
  Scene tilted = scene;
  tilted.probe.pose = turnedAndTilted(scene.probe.pose, 0, radiansFromDegrees(kPlane_deg));
  return {fit::renderedBeat(std::move(scene), kPhases, 3 * heart + 1),
          fit::renderedBeat(std::move(tilted), kPhases, 3 * heart + 2)};
}

// The class of a length: that of the nearest of half, third, whole and double within 8 %.
const char* classOf(double found, double truth) {
  if (found == 0) return "none";
  for (const auto& [times, name] : {std::pair{1.0, "right"},
                                    {0.5, "half"},
                                    {1.0 / 3, "third"},
                                    {2.0, "double"},
                                    {3.0, "triple"}})
    if (std::abs(found / truth / times - 1) < 0.08) return name;
  return "other";
}

void run(int loops) {
  std::vector<Planes> hearts(kHearts);
  for (int h = 0; h < kHearts; ++h) hearts[static_cast<std::size_t>(h)] = planesOf(h);
  struct Group {
    const char* name;
    double least, most;
    // Selects the known R waves from all of the loop.
    std::vector<double> (*known)(const std::vector<double>&);
  };
  using Waves = std::vector<double>;
  const Group groups[] = {
      {"no R waves, 1.5 to 4 beats", 1.5, 4, [](const Waves&) { return Waves{}; }},
      {"no R waves, 1.05 to 1.5 beats", 1.05, 1.5, [](const Waves&) { return Waves{}; }},
      {"one R wave, 1.5 to 4 beats", 1.5, 4, [](const Waves& all) { return Waves{all.front()}; }},
      {"all R waves, 2.1 to 4 beats", 2.1, 4, [](const Waves& all) { return all; }},
      {"second R wave missing, 3 to 4 beats", 3.05, 4,
       [](const Waves& all) {
         Waves out = all;
         out.erase(out.begin() + 1);
         return out;
       }},
  };
  for (const Group& group : groups) {
    std::vector<std::string> classes(static_cast<std::size_t>(loops));
    parallelBlocks(classes.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const BeatDraw draw = beatDraw(i, group.least, group.most);
        const Planes& heart = hearts[i % kHearts];
        echo::EchoLoop loop = loopOf(draw, heart.one, heart.other);
        for (const double r : group.known(draw.r_waves))
          loop.video.r_waves_s.push_back(r / loop.video.rate.hz);
        const echo::BeatLength beat = echo::beatOf(loop);
        classes[i] = classOf(beat.frames, draw.frames_per_beat);
      }
    });
    std::map<std::string, int> counts;
    for (const std::string& one : classes) ++counts[one];
    fmt::print("{}: {} loops", group.name, loops);
    for (const auto& [name, count] : counts) fmt::print("; {} {}", name, count);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  const int loops = argc > 1 ? std::atoi(argv[1]) : 200;
  echocine::withThreads(0, [&] { echocine::bench::run(loops); });
}
