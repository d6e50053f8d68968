#pragma once
// How the left ventricle works, from its meshes and its material: strain, thickness, length, and
// volumes as an echo laboratory would measure them.

#include <array>
#include <optional>
#include <vector>

#include "motion/interior/motion_field.h"
#include "motion/mesh_motion.h"

namespace echocine {

constexpr std::size_t kAhaSegments = 17;

// A place through the wall of the left ventricle: three material points in the reference phase.
struct WallColumn {
  std::uint32_t vertex = 0;  // of the cavity's surface: the endocardium, exactly
  Vec3f endo_m, mid_m, epi_m;
  Vec3f radial, longitudinal, circumferential;  // unit, at the middle
  int segment = 0;                              // 1 to 17, as the American Heart Association counts
};

// Parts of the reference frame's lengths; not a number for a segment without wall.
struct SegmentStrain {
  double longitudinal = 0, radial = 0, circumferential = 0, thickness_mm = 0;
};

struct FunctionFrame {
  double global_longitudinal_strain = 0;  // mean over the middle of the wall
  std::array<SegmentStrain, kAhaSegments> segments{};
  double length_mm = 0;        // from the middle of the base to the apex of the cavity
  double base_descent_mm = 0;  // of the middle of the base towards the apex, along the first axis
  double sphericity = 0;       // cavity's volume over that of a ball as long
  double volume_ml = 0;        // exact
  double biplane_ml = 0;       // Simpson's rule, 20 discs, two apical planes across each other
  std::optional<double> single_plane_ml;  // in the imaging plane, where it shows the long axis
  Vec3d base_m, apex_m;
};

class HeartFunction {
 public:
  // References are kept. Throws SceneError where the scene has no left ventricle or no wall round
  // it. first_phase: of the frame that strains count from.
  HeartFunction(const Scene& scene, const MeshMotion& motion, const MotionField& field,
                double first_phase);

  const std::vector<WallColumn>& columns() const { return columns_; }
  SurfaceId cavity() const { return cavity_; }
  SurfaceId wall() const { return wall_; }

  FunctionFrame at(const SurfaceFrame& surfaces, const FieldFrame& field) const;

 private:
  struct Lengths {
    double longitudinal, radial, circumferential, thickness;
  };
  void findAxis(const SurfaceFrame& surfaces);
  void findColumns(const SurfaceFrame& surfaces);
  int segmentOf(Vec3d place_m) const;
  Lengths lengths(const WallColumn& column, const SurfaceFrame& surfaces,
                  const FieldFrame& field) const;
  Vec3d baseIn(const SurfaceFrame& surfaces) const;
  Vec3d apexIn(const SurfaceFrame& surfaces, Vec3d base_m) const;
  std::vector<double> diameters(const SurfaceFrame& surfaces, Vec3d base_m, Vec3d apex_m,
                                Vec3d across) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  const MotionField& field_;
  SurfaceId cavity_{}, wall_{};
  std::vector<std::uint32_t> base_;          // vertices of the cavity that border on no wall
  Vec3d base_m_, axis_, septal_, anterior_;  // at the reference phase
  Vec3d first_base_m_, first_axis_;
  double length_m_ = 0;
  std::vector<WallColumn> columns_;
  std::vector<Lengths> first_;  // at the first frame
};

}  // namespace echocine
