#pragma once
// What a model says of its imaging plane over a beat: which tissue is where, where boundaries run
// and how they move. From the truth of the scene; nothing is traced.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/plane_slice.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"
#include "truth/plane_labels.h"

namespace echocine::fit {

// A cell of the plane: the two tissues that fill most of it.
struct TissueCell {
  float x_m = 0, z_m = 0;  // its centre
  float area = 0;  // relative to a cell at the largest depth, less far from blood (kNearBlood_m)
  std::uint8_t first = 0, second = 0;  // tissues
  float share = 1;                     // of the first, of both
};

// A piece of a boundary that shows: other tissues lie on its two sides.
struct BoundaryPoint {
  float x_m = 0, z_m = 0;     // its middle
  float nx = 0, nz = 0;       // unit normal; out of blood where blood is on one side
  float length_m = 0;         // of the piece
  float dx_m = 0, dz_m = 0;   // of the material, from this frame to the next
  std::uint16_t surface = 0;  // structure
  bool of_blood = false;      // blood on one side, something else on the other
  std::uint8_t segment = 0;   // of the left ventricle's wall (WallSegments), 1 to 17; 0: none
  std::uint8_t blood = 0, beside = 0;  // tissues of the two sides, where it is of blood
};

struct ModelFrame {
  std::vector<TissueCell> cells;
  std::vector<BoundaryPoint> boundary;
};

// A beat in frames at equal steps of phase, from end-diastole.
struct ModelLoop {
  std::vector<std::string> tissues;  // media by name; the background's is the first
  std::vector<bool> blood;           // by tissue
  std::vector<std::string> structures;
  double far_m = 0;    // depth of the sector from its apex
  double systole = 0;  // end-systole, as a part of the beat; 0: not known
  int cells_across = 0, cells_along = 0;
  std::vector<ModelFrame> frames;
};

// Resolution of the plane, our choice: cells of 2.5 mm at two thirds of a 15 cm depth, each of
// eight samples.
inline constexpr int kCellLines = 64, kCellsAlong = 60, kSamplesPerCell = 8;
inline constexpr double kBoundaryPiece_m = 1.25e-3;  // between looks along a boundary; our choice

// Cells count in full up to about so far from blood, and not at all from twice as far on: what lies
// around a heart is no model's claim. Our choice: a wall's thickness.
inline constexpr double kNearBlood_m = 10e-3;
void weighByBlood(const ModelLoop& loop, ModelFrame& frame);

// Which of the 17 segments each vertex of the left ventricle's cavity borders on; 0: none.
struct WallSegments {
  std::size_t surface = 0;  // the cavity's
  std::vector<std::uint8_t> of_vertex;
};
// By the material at the beat's start, as truth counts them. Nothing for scenes without a left
// ventricle and its wall. A second of one core.
std::optional<WallSegments> wallSegments(const Scene& scene, const MeshMotion& motion);

// Cuts surfaces of one topology, whatever made them.
class ModelPlane {
 public:
  // Surfaces that a scene has, in the probe frame of the scene. References are kept. Throws
  // SceneError for a linear probe.
  ModelPlane(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
             std::optional<WallSegments> segments = {});

  // Frames that follow one another at equal steps through a whole beat. Runs in parallel.
  ModelLoop cut(const std::vector<SurfaceFrame>& frames) const;

 private:
  ModelFrame cutOne(const SurfaceFrame& now, const SurfaceFrame& next, PlaneSlice& slice) const;
  template <typename TissueAtPlace>
  void addPiece(const ContourEdge& cut, Vec3d at, double length_m, const TissueAtPlace& tissueAt,
                const SurfaceFrame& now, const SurfaceFrame& next,
                std::vector<BoundaryPoint>& pieces) const;

  const std::vector<SurfaceTopology>& surfaces_;
  std::optional<WallSegments> segments_;
  Scene coarse_;  // the scene with as many lines as the plane has
  PlaneLabels labels_;
  std::vector<std::uint8_t> tissue_of_;  // by structure from 1; 0 the background
  std::vector<TissueCell> cells_;        // without tissues
  ModelLoop empty_;
};

// A beat of a scene's motion in `frames` steps. Its end-systole is that of the scene's keyframes,
// else where the left ventricle's cavity is smallest.
ModelLoop modelLoop(const Scene& scene, const MeshMotion& motion, int frames,
                    const std::optional<WallSegments>& segments = {});

}  // namespace echocine::fit
