#pragma once
// Where the sound of every line is at every depth of the picture: the map from places in the
// picture to places in the heart, where echoes do not stand at straight path lengths.

#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"
#include "scene/scan_geometry.h"

namespace echocine {

// One line. Depths are positions on the picture's depth axis, m; they ascend.
struct SoundPath {
  // Between two knots sound runs straight and in one medium. The first is at depth 0.
  struct Knot {
    double depth_m = 0;
    Vec3d place_m;  // probe frame
  };
  // A stretch inside one closed structure, from 1 in the scene's order; 0 in the background. It
  // begins where the stretch before it ends, the first at depth 0.
  struct Stretch {
    double end_depth_m = 0;
    std::uint16_t id = 0;
  };
  struct Wall {
    SurfaceId surface{};
    bool entering = false;
    double depth_m = 0;
  };
  std::vector<Knot> knots;  // two at least
  std::vector<Stretch> stretches;
  std::vector<Wall> walls;  // every crossing, hidden or not
  SurfaceSet inside;        // the closed structures at depth 0, hidden or not

  // The first knot of the piece that holds a depth; the last piece goes on behind its end.
  std::size_t pieceAt(double depth_m) const;
  std::uint16_t idAt(double depth_m) const;
};

// The paths of a frame along lines that stand closer than the probe's own.
struct SoundPaths {
  Probe probe;       // of the paths: more lines, else the scene's
  int per_line = 1;  // paths from one line of the scene to the next
  std::vector<SoundPath> paths;

  // The path of a line of the scene: the first of its own, over a full turn the middle one.
  std::size_t pathOfLine(std::size_t line) const {
    const auto apart = static_cast<std::size_t>(per_line);
    return line * apart + (probe.isFullTurn() ? apart / 2 : 0);
  }

  // The place of a depth in the picture, on path `line`.
  Vec3d shownAt(std::size_t line, double depth_m) const;

  // Where the picture shows a place of the heart: x and z of the imaging plane, y as it is. The
  // path through (x, z) is sought; beside the sector the outermost path's shift counts.
  // Precondition: there are paths.
  Vec3d shown(Vec3d place_m) const;

 private:
  Vec3d shownAround(Vec3d place_m) const;
};

// The scene's probe with lines no further apart than `spacing_m` at the deepest sample, but 64
// times as many at most; and how many there are for each.
SoundPaths emptyPaths(const Probe& probe, double spacing_m);

}  // namespace echocine
