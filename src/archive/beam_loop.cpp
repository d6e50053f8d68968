#include "archive/beam_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/ecg.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "output/polar_plane.h"
#include "output/scene_sha256.h"
#include "scene/role.h"
#include "scene/view_names.h"
#include "truth/view_offset.h"

namespace echocine {

namespace {

Scene archiveScene(Scene scene) {
  OutputSettings& output = scene.output;
  output.channels = {Channel::display, Channel::velocity_beam};
  output.exr = true;
  output.cine = output.png = output.dicom = output.report = false;
  scene.truth = {};
  if (structureOf(scene, Role::lv_cavity) && structureOf(scene, Role::lv_wall))
    scene.truth.contours = scene.truth.function = true;
  return scene;
}

// From lines of samples to rows of equal depth, frame by frame.
std::vector<float> rowsFirst(std::span<const float> planes, const BeamLoop& loop) {
  const auto lines = static_cast<std::size_t>(loop.lines);
  const auto samples = static_cast<std::size_t>(loop.samples);
  std::vector<float> rows;
  rows.reserve(planes.size());
  for (std::size_t first = 0; first < planes.size(); first += lines * samples) {
    const std::vector<float> frame =
        rowsFromLines(planes.subspan(first, lines * samples), lines, samples);
    rows.insert(rows.end(), frame.begin(), frame.end());
  }
  return rows;
}

std::vector<float> ecgOf(const Scene& scene, const CardiacClock& clock) {
  std::vector<float> ecg;
  // Beyond the loop the first and the last beat go on. The last instant is within the last frame's
  // interval: at its end a next beat may begin.
  const double rate_hz = scene.acquisition.frame_rate_hz, end_s = clock.frameCount() / rate_hz,
               last_s = (clock.frameCount() - 0.5) / rate_hz;
  for (int i = 0;; ++i) {
    const double time_s = i / kEcgRate_hz - kEcgMargin_s,
                 inside_s = std::clamp(time_s, 0.0, last_s);
    if (time_s > end_s + kEcgMargin_s) return ecg;
    const FrameTime at = clock.atTime(inside_s);
    ecg.push_back(
        static_cast<float>(ecgAmplitude(at.time_in_beat_s + time_s - inside_s, at.beat_s)));
  }
}

std::size_t nearestTo(const std::vector<Vec3d>& points, Vec3d place) {
  return static_cast<std::size_t>(
      std::min_element(points.begin(), points.end(),
                       [&](Vec3d a, Vec3d b) { return length(a - place) < length(b - place); }) -
      points.begin());
}

// Around a closed contour from one point to another, by steps of 1 or -1.
std::vector<Vec3d> arc(const std::vector<Vec3d>& points, std::size_t from, std::size_t to,
                       bool forwards) {
  std::vector<Vec3d> out{points[from]};
  const std::size_t step = forwards ? 1 : points.size() - 1;
  for (std::size_t i = from; i != to;) {
    i = (i + step) % points.size();
    out.push_back(points[i]);
  }
  return out;
}

double nearestDistance(const std::vector<Vec3d>& points, Vec3d place) {
  return length(points[nearestTo(points, place)] - place);
}

// Places evenly along a curve, ends included.
void addEven(const std::vector<Vec3d>& curve, std::vector<float>& to) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < curve.size(); ++i)
    along.push_back(along.back() + length(curve[i] - curve[i - 1]));
  std::size_t piece = 0;
  for (int n = 0; n < kContourPoints; ++n) {
    const double at = along.back() * n / (kContourPoints - 1);
    while (piece + 2 < curve.size() && along[piece + 1] < at) ++piece;
    const double run = along[piece + 1] - along[piece];
    const double share = run > 0 ? std::clamp((at - along[piece]) / run, 0.0, 1.0) : 0;
    const Vec3d p = curve[piece] + share * (curve[piece + 1] - curve[piece]);
    to.push_back(static_cast<float>(p.x));
    to.push_back(static_cast<float>(p.z));
  }
}

// The largest contour of the cavity, from hinge to hinge over the apex. False if a frame has none.
bool addContour(const std::vector<Contour>& contours, const FunctionFrame& function,
                SurfaceId cavity, std::vector<float>& to) {
  if (!function.mitral || !function.mitral->hinges_m) return false;
  const Contour* largest = nullptr;
  for (const Contour& c : contours)
    if (c.surface == cavity && c.closed &&
        (largest == nullptr || c.points_m.size() > largest->points_m.size()))
      largest = &c;
  if (largest == nullptr) return false;
  const auto [left, right] = *function.mitral->hinges_m;
  const std::size_t from = nearestTo(largest->points_m, left),
                    end = nearestTo(largest->points_m, right);
  if (from == end) return false;
  const Vec3d apex = function.axis.apex_m;
  const std::vector<Vec3d> a = arc(largest->points_m, from, end, true),
                           b = arc(largest->points_m, from, end, false);
  addEven(nearestDistance(a, apex) < nearestDistance(b, apex) ? a : b, to);
  return true;
}

void addFunction(const Loop& made, BeamLoop& loop) {
  if (made.function.empty()) return;
  const SurfaceId cavity = *structureOf(loop.scene, Role::lv_cavity);
  bool all = true;
  for (std::size_t t = 0; t < made.function.size(); ++t) {
    loop.strain_percent.push_back(
        static_cast<float>(100 * made.function[t].view_longitudinal_strain));
    all = all && addContour(made.contours[t], made.function[t], cavity, loop.contour_m);
  }
  if (!all) loop.contour_m.clear();
}

}  // namespace

BeamLoop makeBeamLoop(const Scene& given, int threads, const Monitor& monitor) {
  BeamLoop loop;
  loop.scene = archiveScene(placed(given));
  const auto motion = std::make_shared<const MeshMotion>(loop.scene);
  std::optional<const Simulator> made_for(std::in_place, loop.scene, motion);
  passWarnings(*made_for, monitor);
  try {
    made_for->truth();
  } catch (const SceneError& error) {  // an archive without contours is one, too
    monitor.warn(fmt::format("the archive has no contours and no strain: {}", error.what()));
    loop.scene.truth = {};
    made_for.emplace(loop.scene, motion);
  }
  const Simulator& simulator = *made_for;
  const CardiacClock& clock = simulator.cardiacClock();
  const Loop made = renderInMemory(simulator, {0, clock.frameCount()}, monitor, threads);
  loop.scene_sha256 = sceneSha256(simulator.scene(), simulator.motion());
  loop.frames = made.frames;
  loop.samples = made.samples;
  loop.lines = made.lines;
  for (const FrameTime& time : made.times) loop.times_s.push_back(static_cast<float>(time.time_s));
  loop.greys = rowsFirst(made.greys, loop);
  loop.beam_m_s = rowsFirst(made.velocity_beam_m_s, loop);
  loop.ecg = ecgOf(loop.scene, clock);
  if (const auto view = viewOffset(simulator.scene(), simulator.motion()))
    loop.view = viewOf(view->label);
  addFunction(made, loop);
  return loop;
}

std::vector<std::uint8_t> bytesOfGreys(const BeamLoop& loop) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(loop.greys.size());
  for (const float grey : loop.greys)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(grey, 0.0f, 1.0f))));
  return bytes;
}

}  // namespace echocine
