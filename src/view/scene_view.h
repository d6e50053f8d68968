#pragma once
// A scene for 3-D display: coarse meshes over the beat, and the sector.

#include <string>
#include <vector>

#include "core/box.h"
#include "frame/simulator.h"
#include "motion/mesh/decimate.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// Size of the meshes on a page. Our choice: 3000 triangles preserve the outline of a heart's
// structure. A still structure may have four times as many, since its positions appear once: to
// decimate the torso around a heart takes longer than all else on the page. A page of 48000 moving
// triangles at 20 phases has about 4 MB.
struct ViewBudget {
  std::size_t triangles_per_structure = 3000, triangles = 48000;
  int phases = 20;
};

struct ViewStructure {
  DecimatedMesh mesh;
  std::size_t triangles_given = 0;  // of the traced surface
  // Positions of the vertices at each phase; one entry for a static surface. Probe frame, m.
  std::vector<std::vector<Vec3f>> positions_m;
  Box probe_box_m, world_box_m;  // around the whole surface over all phases
  bool seen = false;             // a scan line intersects it, or starts within it, at some phase
};

struct SceneView {
  std::vector<ViewStructure> structures;  // in the scene's order
  int phases = 0;                         // evenly spaced over the beat, from 0
  std::vector<Vec3d> sector_m;            // closed outline of the scan area, probe frame
  // In words: the visible structures, or the position of the meshes if none is visible.
  std::string sight;
  bool sees_any = false;
};

// Decimates each surface once, at phase 0, and moves its vertices. Runs in parallel; the result
// does not depend on the threads. Throws like Simulator.
SceneView viewScene(const Simulator& simulator, const ViewBudget& budget = {});

// The same without a simulator. `like`: a view of surfaces with the same faces, whose decimated
// meshes are taken over; null: none.
SceneView viewScene(const Scene& scene, const MeshMotion& motion, const ViewBudget& budget,
                    const SceneView* like = nullptr);

// The scan area: along the face from the first line to the last, and back along the ends of the
// deepest samples. If lines meet in a point, the face at the smallest depth is an arc.
std::vector<Vec3d> scanAreaOutline(const Probe& probe);

}  // namespace echocine
