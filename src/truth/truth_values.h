#pragma once
// The ground truth of one frame, as plain values. frame_truth.h computes them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"
#include "scene/channel.h"
#include "truth/aha_segments.h"
#include "truth/simpson.h"

namespace echocine {

// A contour in the imaging plane (y = 0), metres in the probe frame. Closed surfaces have closed
// contours: the last point joins the first. Contours of membranes can be closed too. Pieces are
// joined across mesh edges, not by distance.
struct Contour {
  SurfaceId surface{};
  bool closed = false;
  std::vector<Vec3d> points_m;
  // The given edge that starts at each point; none at the last point of an open contour.
  std::vector<std::uint32_t> edges;
  // By point, 1 if the picture shows the border there (visible_border.h); empty without a picture.
  std::vector<char> visible = {};
};

// Displacement of the material at every sample since the reference frame, and its velocity.
struct MotionPlanes {
  // Line-major, lateral, axial (depth) and elevation of the probe frame; not a number outside
  // tissue.
  std::array<std::vector<float>, 3> displacement_mm, velocity_mm_s;
  // Velocity along the sound's path, positive towards the probe.
  std::vector<float> beam_m_s;
};

// Strain relative to the first frame; radial strain is that of the wall thickness. NaN for a
// segment without wall.
struct SegmentStrain {
  double longitudinal = 0, radial = 0, circumferential = 0, thickness_mm = 0;
};
using SegmentStrains = std::array<SegmentStrain, kAhaSegments>;

// A valve's ring at one frame.
struct RingFrame {
  Vec3d middle_m;
  std::optional<std::pair<Vec3d, Vec3d>> hinges_m;  // in the imaging plane, the left one first
};

struct FunctionFrame {
  // Change in the total length of the meridians in the middle of the wall: the mean of the strain
  // along them, by arc length.
  double global_longitudinal_strain = 0;
  SegmentStrains segments{};
  // The same along the cut of the wall's middle by the imaging plane at the reference phase.
  double view_longitudinal_strain = 0;
  SegmentStrains view_segments{};   // all by arc length
  double length_mm = 0;             // from the middle of the mitral ring to the cavity's apex
  double base_descent_mm = 0;       // of that middle towards the apex, along the first axis
  double tricuspid_descent_mm = 0;  // of that ring's lateral end, along the same axis
  double twist_deg = 0;   // of the apex against the base, counterclockwise seen from the apex
  double sphericity = 0;  // cavity's volume over that of a ball as long
  double volume_ml = 0;   // exact
  double biplane_ml = 0;  // Simpson's rule, 20 discs, two apical planes across each other
  std::optional<double> single_plane_ml;  // in the imaging plane, where it shows the long axis
  LongAxis axis;
  std::optional<RingFrame> mitral, tricuspid, aortic;
};

// Positions and planes are those in the picture. With bent rays or travel times these lie along the
// sound paths. Lengths, strains, volumes and displacements are true values.
struct FrameTruth {
  std::vector<std::uint16_t> picture_ids;  // structures at the picture's pixels, from 1
  std::vector<std::uint8_t> labels;        // the same by the scene's numbers
  std::vector<std::uint32_t> sample_ids;   // structures at the samples
  // Complete, not cut by the sector; along sound paths, as far as the paths reach.
  std::vector<Contour> contours;
  MotionPlanes motion;
  std::optional<FunctionFrame> function;
  std::vector<Vec3f> tracks_m;  // material points, in the order of TruthMaker::tracked()
  // Clears all but function and tracks, which are written to files of the whole loop.
  void forgetPlanes() {
    picture_ids = {};
    labels = {};
    sample_ids = {};
    contours = {};
    motion = {};
  }
  // A channel's plane; one of the two is empty.
  std::span<const float> values(Channel channel) const;
};

}  // namespace echocine
