#pragma once
// A scene as one looks at it from outside: coarse meshes over the beat, and the sector.

#include <string>
#include <vector>

#include "core/box.h"
#include "frame/simulator.h"
#include "motion/mesh/decimate.h"

namespace echocine {

// How much of the meshes a page carries. Our choice: a shape of the heart shows its outline with
// 3000 triangles, and a page of 36000 at 20 phases has some 3 MB.
struct ViewBudget {
  std::size_t triangles_per_structure = 3000, triangles = 36000;
  int phases = 20;
};

struct ViewStructure {
  DecimatedMesh mesh;
  std::size_t triangles_given = 0;  // of the surface that is traced
  // Of the mesh's vertices, at each phase; one only where the surface stands still. Probe frame, m.
  std::vector<std::vector<Vec3f>> positions_m;
  Box probe_box_m, world_box_m;  // around the whole surface at all phases
  bool seen = false;             // a scan line meets it, or starts within it, at some phase
};

struct SceneView {
  std::vector<ViewStructure> structures;  // in the scene's order
  int phases = 0;                         // evenly over the beat, from 0
  std::vector<Vec3d> sector_m;            // the scan area's outline, closed, probe frame
  // Whether any structure is seen, in words; where the meshes are if none is.
  std::string sight;
  bool sees_any = false;
};

// Decimates each surface once, at phase 0, and follows its vertices. Runs in parallel, with the
// same result for any number of threads. Throws what Simulator's motion throws.
SceneView viewScene(const Simulator& simulator, const ViewBudget& budget = {});

// The scan area: along the face from the first line to the last, and back along the deepest
// samples' ends. Where lines meet in a point its face at the least depth is an arc.
std::vector<Vec3d> scanAreaOutline(const Probe& probe);

}  // namespace echocine
