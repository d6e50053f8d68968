#pragma once
// A model's imaging plane over a beat: tissues, boundaries and their motion. Taken from the truth
// of the scene, without tracing.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/plane_slice.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"
#include "truth/plane_labels.h"

namespace echocine::fit {

// A cell of the plane and the two tissues that fill most of it.
struct TissueCell {
  float x_m = 0, z_m = 0;  // its centre
  float area =
      0;  // relative to a cell at the largest depth, reduced far from blood (plane_cells.h)
  std::uint8_t first = 0, second = 0;  // tissues
  float share = 1;                     // share of the first among both
  float expected = 0;                  // grey level beyond that of its tissues (expected_greys.h)
};

// A piece of a visible boundary: its two sides have different tissues.
struct BoundaryPoint {
  float x_m = 0, z_m = 0;     // its centre
  float nx = 0, nz = 0;       // unit normal; out of blood if one side is blood
  float length_m = 0;         // of the piece
  float dx_m = 0, dz_m = 0;   // motion of the material to the next frame
  std::uint16_t surface = 0;  // structure
  bool of_blood = false;      // blood on exactly one side
  std::uint8_t segment = 0;   // of the left ventricle's wall (WallSegments), 1 to 17; 0: none
  std::uint8_t blood = 0, beside = 0;  // tissues of the two sides, if of_blood
  float weight = 1;                    // kOtherChambers, or 1
  float alone = 1;     // 0: the model has a second edge before this one (second_edges.h)
  float inside_m = 0;  // distance inside the blood, beyond Eq. 9, at which it is visible
};

struct ModelFrame {
  std::vector<TissueCell> cells;
  std::vector<BoundaryPoint> boundary;
};

// A beat in frames of equal phase steps, from end-diastole.
struct ModelLoop {
  std::vector<std::string> tissues;  // media by name, background first
  std::vector<bool> blood;           // by tissue
  std::vector<std::string> structures;
  double far_m = 0;    // depth of the sector from its apex
  double systole = 0;  // end-systole, as a fraction of the beat; 0: unknown
  int cells_across = 0, cells_along = 0;
  std::vector<ModelFrame> frames;
};

// Resolution of the plane, our choice: cells of 2.5 mm at two thirds of a 15 cm depth, each with
// eight samples.
inline constexpr int kCellLines = 64, kCellsAlong = 60, kSamplesPerCell = 8;
inline constexpr double kBoundaryPiece_m = 1.25e-3;  // spacing along a boundary; our choice

// Purpose of a model's discrepancy. all: every chamber counts the same. left_ventricle: to
// fit a left ventricle. Other chambers, whose shapes no dial fits, then count kOtherChambers,
// and edges of blood are expected kInside_m farther inside.
enum class Focus { all, left_ventricle };

// Weight of cells far from the left ventricle, and of boundaries other than its own and those of
// its papillary muscles. With 0.3 and the true shape, the curvature of D in EF and EDV was that of
// 1 (three planted hearts, one view). Fits of two of them, whose atria and right ventricles are not
// the models', had EF errors of -0.002 and +0.022 with 0.3, and of +0.046 and +0.023 with 1.
inline constexpr double kOtherChambers = 0.3;
// Trabeculae, leaflets and boundaries that curve within the thickness of the slice move visible
// edges into the blood. With it, D of three planted hearts with known other dials and planes was
// lowest at EDV errors of -2.5 to -4.0 % and EF errors of -0.017 to +0.019; without it, at -4.6 to
// -7.2 % and -0.001 to +0.031. More would make EF too low.
inline constexpr double kInside_m = 0.6e-3;

// The adjacent wall segment, 1 to 17, of each vertex of the left ventricle's cavity; 0: none.
struct WallSegments {
  std::size_t surface = 0;  // surface of the cavity
  std::vector<std::uint8_t> of_vertex;
};
// Segments of the material at the start of the beat, as in the truth. Empty for scenes without a
// left ventricle and its wall. Takes a second of one core.
std::optional<WallSegments> wallSegments(const Scene& scene, const MeshMotion& motion);

// Cuts surfaces of one topology, from any source.
class ModelPlane {
 public:
  // Surfaces of a scene, in the scene's probe frame. References are kept. Throws SceneError for a
  // linear probe.
  ModelPlane(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
             std::optional<WallSegments> segments = {}, Focus focus = Focus::all);

  // Cuts successive frames of equal steps through a whole beat. Runs in parallel.
  ModelLoop cut(const std::vector<SurfaceFrame>& frames) const;
  // The same for frames that are made when they are needed, some of them twice. `make` is
  // thread-safe and replaces a frame.
  using MakeFrame = std::function<void(std::size_t number, SurfaceFrame& frame)>;
  ModelLoop cut(std::size_t count, const MakeFrame& make) const;

 private:
  ModelFrame cutOne(const SurfaceFrame& now, const SurfaceFrame& next, PlaneSlice& slice) const;
  void weigh(const std::vector<std::uint32_t>& ids, ModelFrame& frame) const;
  BoundaryPoint pieceAt(const ContourEdge& cut, int inner, int outer, const SurfaceFrame& now,
                        const SurfaceFrame& next) const;

  const std::vector<SurfaceTopology>& surfaces_;
  std::optional<WallSegments> segments_;
  std::optional<SurfaceId> left_;  // left ventricle's cavity, if it is the focus
  std::vector<float> weight_of_;   // of boundaries, by structure
  float inside_m_ = 0;             // of all boundaries
  Scene coarse_;                   // the scene with the plane's number of lines
  PlaneLabels labels_;
  std::vector<std::uint8_t> tissue_of_;  // by structure from 1; 0 is the background
  std::vector<TissueCell> cells_;        // without tissues
  ModelLoop empty_;
};

// A beat of a scene's motion in `frames` steps. End-systole is that of the scene's keyframes, or
// else the instant of the smallest left ventricular cavity.
ModelLoop modelLoop(const Scene& scene, const MeshMotion& motion, int frames,
                    const std::optional<WallSegments>& segments = {}, Focus focus = Focus::all);

}  // namespace echocine::fit
