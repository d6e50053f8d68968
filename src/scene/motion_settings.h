#pragma once
// The keyframes of a scene's structures, their repairs, and their motion over the beat.

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/vec3.h"
#include "scene/named.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// cycle: from one keyframe to the next as the published volume curve goes, for hearts with a
// few known instants.
enum class Interpolation { linear, catmull_rom, spline, fourier, cycle };

template <>
struct NamesOf<Interpolation> {
  static constexpr Named<Interpolation> kAll[] = {{Interpolation::linear, "linear"},
                                                  {Interpolation::catmull_rom, "catmull-rom"},
                                                  {Interpolation::spline, "spline"},
                                                  {Interpolation::fourier, "fourier"},
                                                  {Interpolation::cycle, "cycle"}};
};

struct MotionSettings {
  double mesh_unit_m = 1e-3;
  double mesh_scale = 1;  // scale of all mesh coordinates, before the offset
  Vec3d mesh_offset_m{};  // added to all positions
  Interpolation interpolation = Interpolation::catmull_rom;
  bool interpolation_given = false;  // by the scene; else chosen by the number of keyframes
  int subdivision = 0;               // Loop levels
  std::optional<double> keyframe_heart_rate_hz;  // of the keyframes' beat
  std::optional<double>
      end_systole_phase;                // of the keyframes; else the published value for the rate
  std::vector<double> keyframe_phases;  // of keyframes without their own phases; empty: even
  SourcePlace interpolation_place, subdivision_place;
};

struct Keyframe {
  std::vector<std::filesystem::path> files;  // the mesh, then its lids
  double phase = 0;                          // [0, 1)
  // Meshes in memory, in the order of `files`, which then are only their names in messages; empty:
  // all are read from disk.
  std::vector<std::shared_ptr<const TriangleMesh>> meshes{};
};

// Repairs of a structure's meshes before the checks, in this order.
struct Repairs {
  bool weld = false;             // one vertex for each point of the surface
  bool drop_degenerate = false;  // faces without area, duplicate faces
  bool orient = false;           // all faces look outward
  bool split = false;            // closed sheets, separated at edges of more than two faces
  bool fill_holes = false;       // a fan over every open rim
  bool any() const { return weld || drop_degenerate || orient || split || fill_holes; }
};

}  // namespace echocine
