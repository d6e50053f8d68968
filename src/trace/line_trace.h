#pragma once
// A traced scan line before it is sampled: a few segments of constant medium and a few
// echoes. `Depth` is the position on the image's depth axis: the path length, or 1540 m/s times
// half the travel time.

#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"

namespace echocine {

// One medium along a scan line. Path length l and attenuation exponent A = 4 sum alpha l grow
// linearly.
struct MediumSegment {
  double begin_depth_m = 0, end_depth_m = 0;
  double begin_path_m = 0, path_per_depth = 1;    // l
  double begin_exponent = 0, exponent_per_m = 0;  // A in nepers, and dA per metre of depth
  double strength_m2_sr =
      0;  // eta_b V times the losses prod (1-R)^2: intensity times l^2, unattenuated
  MediumId medium{};
  // The closed structure, from 1 in the scene's order; 0 in the background.
  std::uint16_t structure = 0;
};

// Steepest lean of a wall, tan (84 degrees); steeper ones are limited to it. Our choice; the lobe
// cos^2 leaves under a hundredth of the echo of steeper walls.
inline constexpr double kSteepestLean = 10;

// The echo of one interface.
struct Echo {
  double depth_m = 0;
  double intensity = 0;  // relative to I_S: W cos^n times the losses before it, unattenuated
  double exponent = 0;   // A up to it
  // The interface's normal over the cosine it has with the ray, at most 1e3: a ray turned by a
  // small angle towards a unit vector e meets the interface l e.tilt earlier. Where several rays
  // make a beam.
  Vec3d tilt{};
  // Which wall it is, and where: by these the echoes of neighbouring lines are linked.
  SurfaceId surface{};
  MediumId before{}, after{};  // of a membrane: what is around it, and its own
  Vec3d point{};               // probe frame
};

// Echoes integrated over the beams' cells, of all lines of a frame: each lies in a sample of one
// line. The first `count` of the rows are filled, which are some whole lanes longer; their memory
// is used again from frame to frame.
struct CellEchoes {
  std::size_t count = 0;
  std::vector<std::uint32_t> at;            // line * samples + sample
  std::vector<double> intensity, exponent;  // as of an Echo in the middle of its sample
  std::vector<double> filled;  // intensity if the interface filled the cell, within this sample
  // Where echoes have a coherent part: that part, and the place in the sample, 0 to 1.
  std::vector<float> coherent_part, place;

  // Room for so many, and for whole lanes.
  void reserve(std::size_t most) {
    constexpr std::size_t kMoreThanLanes = 64;
    if (at.size() >= most + kMoreThanLanes) return;
    const std::size_t size = 2 * most + kMoreThanLanes;
    at.resize(size);
    intensity.resize(size);
    exponent.resize(size);
    filled.resize(size);
    coherent_part.resize(size);
    place.resize(size);
  }
};

// One crossing as the walk along a line judged it; what integration over the beam's cell needs of
// it.
struct InterfaceHit {
  SurfaceId surface{};
  bool entering = false;
  bool seen = false;           // an interface here: the media differ, or a membrane
  bool ends = false;           // total reflection ended the line here
  MediumId before{}, after{};  // of a membrane: what is around it, and its own
  Vec3d point;                 // probe frame
  double path_m = 0, depth_m = 0;
  double path_per_depth = 1;                   // of the medium before
  double exponent = 0, exponent_per_path = 0;  // A at it, and dA/dl before it
  double passed = 1;  // prod (1-R)^2 before it, times what a thin layer makes of its echo
  // Snell's direction at it by its parts along the line, across it in the imaging plane and out of
  // that plane: {1, 0, 0} until a speed differs.
  Vec3d wave{1, 0, 0};
};

// Segments follow each other without gap from depth 0; after the last one the ray has ended.
struct LineTrace {
  std::vector<MediumSegment> segments;
  std::vector<Echo> echoes;
  std::vector<InterfaceHit> hits;  // in order; only on request
  // With the hits: where the last segment ends, probe frame, and the closed surfaces at depth 0.
  Vec3d end_m;
  SurfaceSet inside;

  void clear() {
    segments.clear();
    echoes.clear();
    hits.clear();
  }
};

}  // namespace echocine
