#pragma once
// Function of the left ventricle from its meshes and material points: strain, thickness, length,
// excursion of the valve rings, and volumes by the methods of echo laboratories.

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "motion/interior/motion_field.h"
#include "motion/surfaces/mesh_motion.h"
#include "truth/aha_segments.h"
#include "truth/orifice.h"
#include "truth/simpson.h"
#include "truth/truth_values.h"

namespace echocine {

// A place through the wall of the left ventricle: three material points in the reference phase.
struct WallColumn {
  std::uint32_t vertex = 0;  // of the cavity's surface: the endocardium, exactly
  Vec3f endo_m, mid_m, epi_m;
  Vec3f radial, longitudinal, circumferential;  // unit, at the middle
  int segment = 0;                              // 1 to 17, as the American Heart Association counts
};

class HeartFunction {
 public:
  // References are kept. Throws SceneError if the scene has no left ventricle or no wall around
  // it. first_phase: of the reference frame of the strains.
  HeartFunction(const Scene& scene, const MeshMotion& motion, const MotionField& field,
                double first_phase);

  const std::vector<WallColumn>& columns() const { return columns_; }
  SurfaceId cavity() const { return cavity_; }
  SurfaceId wall() const { return wall_; }
  const HeartAxes& axes() const { return axes_; }             // at the reference phase
  bool hasRightHeart() const { return !tricuspid_.empty(); }  // and a ring between its cavities

  FunctionFrame at(const SurfaceFrame& surfaces, const FieldFrame& field) const;

 private:
  struct Lengths {
    double longitudinal, circumferential, thickness;
  };
  // Weights of a column in means: area and arc length of the wall's middle around it.
  struct Weight {
    double area_m2 = 0, meridians_m = 0, view_m = 0;
  };
  // Weighted sums over columns, by segment.
  struct Means {
    SegmentStrains sums{};
    std::array<double, kAhaSegments> areas{}, lengths{};
    double longitudinal = 0, length = 0;
    // length: for longitudinal strain, area: for the rest.
    void add(const WallColumn& column, double length, double area, const Lengths& now,
             const Lengths& first);
    SegmentStrains segments() const;
    double global() const;
  };
  void findBase(const SurfaceFrame& surfaces);
  Orifice orificeOf(SurfaceId cavity, Role beyond, const SurfaceFrame& surfaces) const;
  void findAxes(const SurfaceFrame& surfaces);
  void findColumns(const SurfaceFrame& surfaces);
  void weighColumns(std::span<const Vec3d> normals, std::span<const Vec3f> endocardium);
  Lengths lengths(const WallColumn& column, const SurfaceFrame& surfaces,
                  const FieldFrame& field) const;
  LongAxis axisIn(const SurfaceFrame& surfaces) const;
  void addStrain(const SurfaceFrame& surfaces, const FieldFrame& field, FunctionFrame& f) const;
  void addRings(const SurfaceFrame& surfaces, FunctionFrame& f) const;
  void addVolumes(const SurfaceFrame& surfaces, FunctionFrame& f) const;
  std::vector<double> rotations(const SurfaceFrame& surfaces) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  const MotionField& field_;
  SurfaceId cavity_{}, wall_{};
  std::optional<SurfaceId> right_;   // the right ventricle's cavity
  std::vector<std::uint32_t> base_;  // vertices of the cavity that border on no wall
  Orifice mitral_, tricuspid_, aortic_;
  std::uint32_t lateral_ = 0;  // end of the tricuspid ring, a vertex of the right ventricle
  HeartAxes axes_;             // at the reference phase
  LongAxis first_;             // at the first frame, as all that follows
  Vec3d first_lateral_m_;
  std::vector<WallColumn> columns_;
  std::vector<Weight> weights_;  // by column
  std::vector<Lengths> first_lengths_;
  std::vector<double> first_rotations_;
};

}  // namespace echocine
