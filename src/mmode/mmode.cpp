#include "mmode/mmode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "core/units.h"
#include "frame/loop_instant.h"
#include "frame/making.h"
#include "frame/workspace.h"
#include "mmode/echo_trace.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/names.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "signal/signal_chain.h"
#include "truth/frame_truth.h"

namespace echocine {

namespace {

constexpr int kMostColumns = 1 << 16;

void refuseRate(const Scene& scene, double rate_hz) {
  const double most_hz = kScannerSpeed / (2 * scene.probe.max_depth_m);
  if (rate_hz >= 1 && rate_hz <= most_hz) return;
  throw SceneError(fmt::format(
      "--rate: {:g} Hz, accepted: 1 to {:.0f} Hz, at which echoes from {:.0f} mm return in time",
      rate_hz, std::floor(most_hz), millimetresFromMetres(scene.probe.max_depth_m)));
}

struct Column {
  std::vector<float> intensities, greys;
  std::vector<BorderCrossing> borders;
  std::optional<Vec3d> ring;
  double in_space_mm = 0;
};

// Where a line in the imaging plane meets the contours, sorted by depth.
std::vector<BorderCrossing> crossings(const std::vector<Contour>& contours,
                                      const LineGeometry& line, const Probe& probe, int column) {
  const Vec3d across{line.direction.z, 0, -line.direction.x};
  std::vector<BorderCrossing> out;
  for (const Contour& contour : contours) {
    const std::vector<Vec3d>& p = contour.points_m;
    const std::size_t pieces = p.empty() ? 0 : contour.closed ? p.size() : p.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
      const Vec3d a = p[i] - line.origin, b = p[(i + 1) % p.size()] - line.origin;
      const double side_a = dot(a, across), side_b = dot(b, across);
      if ((side_a < 0) == (side_b < 0)) continue;
      const Vec3d at = a + (side_a / (side_a - side_b)) * (b - a);
      const double depth = dot(at, line.direction);
      if (depth >= probe.min_depth_m && depth <= probe.max_depth_m)
        out.push_back({column, contour.surface, depth});
    }
  }
  std::sort(out.begin(), out.end(), [](const BorderCrossing& a, const BorderCrossing& b) {
    return std::pair(a.depth_m, index(a.surface)) < std::pair(b.depth_m, index(b.surface));
  });
  return out;
}

double spaceMotion_mm(const FrameTruth& truth, MModeTarget target) {
  if (!truth.function) return 0;
  return target == MModeTarget::tricuspid_lateral ? truth.function->tricuspid_descent_mm
                                                  : truth.function->base_descent_mm;
}

Column makeColumn(const Simulator& simulator, const FrameTime& time, int line, int number,
                  double white, std::optional<MModeTarget> target) {
  const Probe& probe = simulator.scene().probe;
  const std::shared_ptr<Workspace> w = simulator.workspace();
  const LineRange some = simulator.chain().greysFrom({line, line + 1});
  const auto first = static_cast<std::ptrdiff_t>(line) * probe.samples,
             last = first + probe.samples;
  Column column;
  simulator.make(time, {.still = true, .counted = false, .persists = false, .lines = some}, *w);
  column.intensities.assign(w->polar.intensities.begin() + first,
                            w->polar.intensities.begin() + last);
  simulator.make(
      time, {.traced = true, .still = true, .persists = false, .lines = some, .white = white}, *w);
  column.greys.assign(w->greys.begin() + first, w->greys.begin() + last);
  const FrameTruth truth = simulator.truthAt(time, w.get());
  column.borders = crossings(truth.contours, lineGeometry(probe, line), probe, number);
  if (target && isRing(*target)) {
    column.ring = targetIn(truth, simulator.scene(), *target);
    column.in_space_mm = spaceMotion_mm(truth, *target);
  }
  return column;
}

int chosenLine(const Simulator& simulator, const MModeRequest& request) {
  const Probe& probe = simulator.scene().probe;
  if (!request.through) {
    const ScanGeometry geometry(probe);
    const double middle = 0.5 * (geometry.firstPlace() + geometry.lastPlace());
    return lineAt(probe, request.place.value_or(middle),
                  geometry.angular() ? "--angle" : "--offset");
  }
  const FrameTruth truth = simulator.truthAt(simulator.cardiacClock().at(0));
  const std::optional<Vec3d> at = targetIn(truth, simulator.scene(), *request.through);
  if (!at)
    throw SceneError(
        fmt::format("--through {}: the imaging plane does not show it; use a view that "
                    "does, or --angle",
                    nameOf(*request.through)));
  return lineThrough(probe, *at, *request.through);
}

int columnCount(const Simulator& simulator, const MModeRequest& request) {
  const double duration_s =
      simulator.cardiacClock().frameCount() / simulator.scene().acquisition.frame_rate_hz;
  const double count = std::max(1.0, std::round(duration_s * request.rate_hz));
  if (count > kMostColumns)
    throw SceneError(fmt::format("--rate: {:g} Hz gives {:.0f} columns, accepted: at most {}",
                                 request.rate_hz, count, kMostColumns));
  return static_cast<int>(count);
}

// Columns from the first to the closure of the aortic valve in its beat, at least one.
int systolicColumns(const MMode& mode, const Simulator& simulator) {
  const std::optional<ValveTimes>& valves = simulator.truth()->valves();
  int columns = 1;
  while (valves && columns < mode.columns &&
         mode.times[static_cast<std::size_t>(columns)].phase < valves->aortic_closes &&
         mode.times[static_cast<std::size_t>(columns)].beat == mode.times.front().beat)
    ++columns;
  return columns;
}

// Motion of the ring, from the points of all columns and from the picture.
std::optional<RingMotion> ringMotion(const std::vector<Column>& columns, const MMode& mode,
                                     const Simulator& simulator, double rate_hz) {
  if (columns.empty() || !columns.front().ring) return {};
  const Probe& probe = simulator.scene().probe;
  const LineGeometry line = lineGeometry(probe, mode.line);
  const auto depthOf = [&](Vec3d point) { return dot(point - line.origin, line.direction); };
  RingMotion ring;
  ring.start_depth_m = depthOf(*columns.front().ring);
  for (const Column& column : columns) {
    const double last = ring.exact_m.empty() ? 0 : ring.exact_m.back();
    ring.exact_m.push_back(column.ring ? ring.start_depth_m - depthOf(*column.ring) : last);
    ring.in_space_mm = std::max(ring.in_space_mm, column.in_space_mm);
  }
  const int systole = systolicColumns(mode, simulator);
  const auto samples = static_cast<std::size_t>(mode.samples);
  const std::span<const float> greys = mode.greys;
  ring.traced_m = followEcho({greys.first(static_cast<std::size_t>(systole) * samples), systole,
                              mode.samples, probe.sampleSpacing(), 1 / rate_hz},
                             ring.start_depth_m - probe.min_depth_m);
  const auto most = [](const std::vector<double>& m) {
    return millimetresFromMetres(*std::max_element(m.begin(), m.end()));
  };
  ring.exact_mm = most(ring.exact_m);
  ring.traced_mm = most(ring.traced_m);
  return ring;
}

}  // namespace

Scene mmodeScene(Scene scene, const MModeRequest& request) {
  refuseRate(scene, request.rate_hz);
  if (request.through) refuseWithoutRoles(scene, *request.through);
  scene.acquisition.rolling = false;
  scene.artefacts.persistence = 0;
  scene.output.channels.clear();
  scene.output.exr = scene.output.png = scene.output.dicom = scene.output.report = false;
  scene.output.cine = true;
  scene.truth = {};
  scene.truth.contours = true;
  scene.truth.function = request.through.has_value();
  return scene;
}

void checkMMode(const Simulator& simulator, const MModeRequest& request) {
  chosenLine(simulator, request);
  columnCount(simulator, request);
}

MMode makeMMode(const Simulator& simulator, const MModeRequest& request, const Monitor& monitor) {
  const Scene& scene = simulator.scene();
  const Probe& probe = scene.probe;
  MMode mode;
  mode.line = chosenLine(simulator, request);
  mode.samples = probe.samples;
  const ScanGeometry geometry(probe);
  mode.place = probe.lines == 1 ? 0.5 * (geometry.firstPlace() + geometry.lastPlace())
                                : geometry.firstPlace() + mode.line * geometry.cellWidth();
  const std::optional<double> white = simulator.referenceIntensity(monitor, {});
  if (!white) throw Stopped();
  mode.white = *white;

  const CardiacClock& clock = simulator.cardiacClock();
  mode.columns = columnCount(simulator, request);
  for (int t = 0; t < mode.columns; ++t)
    mode.times.push_back(instantOf(clock, scene, t / request.rate_hz));

  std::vector<Column> columns;
  const std::size_t made = parallelOrdered(
      0, mode.times.size(), 2 * static_cast<std::size_t>(threadCount()), monitor.keep_going,
      [&](std::size_t t) -> std::shared_ptr<void> {
        return std::make_shared<Column>(makeColumn(simulator, mode.times[t], mode.line,
                                                   static_cast<int>(t), *white, request.through));
      },
      [&](std::size_t t, const std::shared_ptr<void>& column) {
        columns.push_back(std::move(*static_cast<Column*>(column.get())));
        monitor.tell({Task::rendering, t + 1, mode.times.size()});
      });
  if (made < mode.times.size()) throw Stopped();
  for (const Column& column : columns) {
    mode.intensities.values.insert(mode.intensities.values.end(), column.intensities.begin(),
                                   column.intensities.end());
    mode.greys.values.insert(mode.greys.values.end(), column.greys.begin(), column.greys.end());
    mode.borders.insert(mode.borders.end(), column.borders.begin(), column.borders.end());
  }
  mode.ring = ringMotion(columns, mode, simulator, request.rate_hz);
  return mode;
}

}  // namespace echocine
