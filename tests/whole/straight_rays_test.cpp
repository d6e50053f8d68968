// Straight rays on the views that ship, against bent ones by brute force: many rays to a cell, none
// of them linked.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "frame/making.h"
#include "frame/simulator.h"
#include "frame/workspace.h"
#include "metrics/picture_error.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scan_geometry.h"
#include "scene/view_names.h"
#include "signal/signal_chain.h"

namespace echocine {
namespace {

constexpr int kRaysPerCell = 11;
constexpr double kLostExponent = 27.6;  // 120 dB, which no scanner receives

// Rays evenly over each line's cell.
Scene withRaysOverCells(Scene scene) {
  const double half = ScanGeometry(scene.probe).cellWidth() * (kRaysPerCell - 1) / kRaysPerCell / 2;
  scene.probe.first_angle_rad -= half;
  scene.probe.last_angle_rad += half;
  scene.probe.lines *= kRaysPerCell;
  return scene;
}

using Lost = std::vector<char>;

// Of each line's samples, those that attenuation hides from one of its rays, and all behind.
void addLost(const PolarFrame& polar, int rays_per_line, Lost& lost) {
  const std::vector<float>& exponent = polar.planes.at(Channel::attenuation);
  const auto samples = static_cast<std::size_t>(polar.samples);
  for (std::size_t ray = 0; ray < static_cast<std::size_t>(polar.lines); ++ray) {
    bool hidden = false;
    for (std::size_t k = 0; k < samples; ++k) {
      hidden = hidden || exponent[ray * samples + k] > kLostExponent;
      if (hidden) lost[ray / static_cast<std::size_t>(rays_per_line) * samples + k] = 1;
    }
  }
}

// The picture of a view's lines whose intensities are the means of `many` rays each.
std::vector<float> pictureOf(const Simulator& lines, const PolarFrame& many, int rays_per_line,
                             const Lost& lost, const FrameTime& time, Workspace& workspace) {
  const auto samples = static_cast<std::size_t>(many.samples);
  const auto rays = static_cast<std::size_t>(rays_per_line);
  const auto average = [&](Intensities& means) {
    for (std::size_t at = 0; at < lost.size(); ++at) {
      double sum = 0;
      for (std::size_t r = 0; r < rays; ++r)
        sum += many.intensities[(at / samples * rays + r) * samples + at % samples];
      means.values[at] = lost[at] ? 0 : static_cast<float>(sum / rays_per_line);
    }
  };
  lines.make(time, {.received = average}, workspace);
  lines.picture(*lines.scene().signal.reference_intensity, time, workspace, false);
  std::vector<float> grey;
  lines.chain().picture(workspace.greys, grey);
  return grey;
}

struct StraightError {
  bool bends = false;  // by its plan
  double rms_db = 0;
};

StraightError straightError(View view) {
  Scene scene = placed(heart::heartScene(heart::parametersFrom({}), view, 20, Look::paper));
  scene.output.channels = {Channel::attenuation};
  scene.probe.lines = 256;
  scene.probe.samples = 1024;
  scene.accuracy.normals = Normals::smooth;
  const auto motion = std::make_shared<const MeshMotion>(scene);
  const Simulator straight(scene, motion);
  Scene brute = withRaysOverCells(scene);
  brute.effects.refraction = Switch::on;
  brute.accuracy.interface_echo = InterfaceEcho::centre;
  const Simulator bent(brute, motion);
  const FrameTime time = straight.cardiacClock().at(7);
  const auto of_straight = straight.workspace(), of_bent = bent.workspace(),
             shown = straight.workspace();
  // As the lines receive them, before the signal chain.
  for (const auto& [simulator, workspace] :
       {std::pair(&straight, of_straight.get()), std::pair(&bent, of_bent.get())}) {
    Intensities received;
    simulator->make(time, {.received = [&](Intensities& of_lines) { received = of_lines; }},
                    *workspace);
    workspace->polar.intensities = std::move(received);
  }
  Lost lost(static_cast<std::size_t>(scene.probe.lines) *
            static_cast<std::size_t>(scene.probe.samples));
  addLost(of_straight->polar, 1, lost);
  addLost(of_bent->polar, kRaysPerCell, lost);
  const auto one = pictureOf(straight, of_straight->polar, 1, lost, time, *shown);
  const auto other = pictureOf(straight, of_bent->polar, kRaysPerCell, lost, time, *shown);
  return {straight.plan().effects.refraction,
          pictureError(one, other, scene.signal.dynamic_range_db).rms_db};
}

// What is left is the edge of lung's shadow, and steep walls that eleven rays do not quite fill.
TEST(StraightRays, OfTheEightViewsAreNearBentOnes) {
  withThreads(2, [] {
    for (const ViewName& name : viewNames()) {
      const bool long_axis =
          std::string_view(name.key).starts_with("a") || std::string_view(name.key) == "plax";
      const StraightError error = straightError(name.view);
      EXPECT_FALSE(error.bends) << name.key;
      EXPECT_LT(error.rms_db, long_axis ? 2.0 : 1.1) << name.key;
      std::printf("%s: %.2f dB\n", std::string(name.key).c_str(), error.rms_db);
    }
  });
}

}  // namespace
}  // namespace echocine
