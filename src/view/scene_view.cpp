#include "view/scene_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/parallel.h"
#include "frame/mesh_placement.h"
#include "geometry/plane_slice.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// The most of one structure, however many there are.
std::size_t mostAlone(const ViewBudget& budget, const SurfaceTopology& surface) {
  return (surface.still ? 4 : 1) * budget.triangles_per_structure;
}

// The most that each may have for all to keep within the budget: small ones leave theirs to others.
std::size_t mostTriangles(const ViewBudget& budget, const MeshMotion& motion) {
  std::vector<std::size_t> sizes;
  for (const SurfaceTopology& surface : motion.surfaces())
    sizes.push_back(
        std::min(motion.control(surface.id).triangles.size(), mostAlone(budget, surface)));
  std::sort(sizes.begin(), sizes.end());
  std::size_t left = budget.triangles;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t share = left / (sizes.size() - i);
    if (sizes[i] > share) return share;
    left -= sizes[i];
  }
  return budget.triangles;
}

// Uses the control mesh if the surface is subdivided: its vertices come first in the surface, and
// collapsing a quarter of the triangles takes a quarter of the time.
DecimatedMesh coarseMesh(const ControlMotion& control, const std::vector<Vec3f>& positions_m,
                         std::size_t most_triangles) {
  return decimated(control.triangles, positions_m, most_triangles);
}

void addPhase(const std::vector<Vec3f>& all_m, const Pose& pose, ViewStructure& structure) {
  std::vector<Vec3f> kept_m;
  kept_m.reserve(structure.mesh.vertices.size());
  for (const std::uint32_t v : structure.mesh.vertices) kept_m.push_back(all_m[v]);
  structure.positions_m.push_back(std::move(kept_m));
  for (const Vec3f p : all_m) {
    structure.probe_box_m.add(toDouble(p));
    structure.world_box_m.add(pose.toWorld(toDouble(p)));
  }
}

// By the tracer's own crossings.
void noteSeen(const PlaneSlice& slice, const Probe& probe, SceneView& view) {
  for (const RayCrossings& line : slice.lines()) {
    for (const Crossing& crossing : line.crossings)
      if (crossing.distance_m <= probe.max_depth_m)
        view.structures[index(crossing.surface)].seen = true;
    for (std::size_t s = 0; s < view.structures.size(); ++s)
      if (line.inside.test(s)) view.structures[s].seen = true;
  }
}

void tellSight(const Scene& scene, const MeshMotion& motion, SceneView& view) {
  const std::size_t seen =
      static_cast<std::size_t>(std::count_if(view.structures.begin(), view.structures.end(),
                                             [](const ViewStructure& s) { return s.seen; }));
  view.sees_any = seen > 0;
  view.sight = view.sees_any ? fmt::format("The sector shows {} of {} structures.", seen,
                                           view.structures.size())
                             : fmt::format("The sector shows no structure: {}.",
                                           describePlacement(scene, meshesBox(motion)));
}

}  // namespace

std::vector<Vec3d> scanAreaOutline(const Probe& probe) {
  constexpr int kArcLines = 65;  // bends of under 2 degrees look round
  Probe outline = probe;
  if (probe.lines > 1) outline.lines = kArcLines;
  std::vector<Vec3d> points_m;
  // Over a full turn each circle ends where it began.
  const auto close = [&](std::size_t first) {
    if (probe.isFullTurn()) points_m.push_back(Vec3d(points_m[first]));
  };
  for (int i = 0; i < outline.lines; ++i) {
    const LineGeometry line = lineGeometry(outline, i);
    points_m.push_back(line.origin + probe.min_depth_m * line.direction);
  }
  close(0);
  const std::size_t far = points_m.size();
  for (int i = outline.lines - 1; i >= 0; --i) {
    const LineGeometry line = lineGeometry(outline, i);
    points_m.push_back(line.origin + probe.max_depth_m * line.direction);
  }
  close(far);
  points_m.push_back(points_m.front());
  return points_m;
}

SceneView viewScene(const Simulator& simulator, const ViewBudget& budget) {
  return viewScene(simulator.scene(), simulator.motion(), budget);
}

SceneView viewScene(const Scene& scene, const MeshMotion& motion, const ViewBudget& budget,
                    const SceneView* like) {
  const std::vector<SurfaceTopology>& surfaces = motion.surfaces();
  const Probe& probe = scene.probe;
  SceneView view;
  view.phases = budget.phases;
  view.sector_m = scanAreaOutline(probe);
  view.structures.resize(surfaces.size());
  const std::size_t most = mostTriangles(budget, motion);
  const auto meshOf = [&](std::size_t s, const std::vector<Vec3f>& positions_m) {
    const bool known = like != nullptr && s < like->structures.size() &&
                       like->structures[s].triangles_given == surfaces[s].triangles.size();
    return known ? like->structures[s].mesh
                 : coarseMesh(motion.control(surfaces[s].id), positions_m,
                              std::min(most, mostAlone(budget, surfaces[s])));
  };
  PlaneSlice slice(surfaces, probe);
  SurfaceFrame frame;
  for (int i = 0; i < budget.phases; ++i) {
    motion.frameAt(static_cast<double>(i) / budget.phases, frame, false);
    slice.update(frame);
    parallelBlocks(surfaces.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        ViewStructure& structure = view.structures[s];
        if (i > 0 && surfaces[s].still) continue;
        if (i == 0) {
          structure.triangles_given = surfaces[s].triangles.size();
          structure.mesh = meshOf(s, frame.positions_m[s]);
        }
        addPhase(frame.positions_m[s], probe.pose, structure);
      }
    });
    noteSeen(slice, probe, view);
  }
  tellSight(scene, motion, view);
  return view;
}

}  // namespace echocine
