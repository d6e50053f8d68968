#pragma once
// The `t` statements of an OBJ file, as OpenSubdiv's example shapes write them.

#include <cstddef>
#include <string_view>
#include <vector>

#include "motion/mesh/mesh.h"

namespace echocine {

// Collects creases and corners while a file is read and joins them to its mesh at the end, since
// tags may stand before the faces they name.
//   t crease 2/1/0 <v0> <v1> <sharpness>
//   t corner 1/1/0 <v> <sharpness>
// Vertices count from 0, unlike those of faces. Errors are SceneErrors that start with the line's
// number.
class ObjTags {
 public:
  // `rest`: what follows the `t`.
  void read(std::string_view rest, std::size_t line_number);

  // Every edge must be one of a triangle and every vertex exist; naming one twice is accepted when
  // the sharpness is the same. Sharpness 0 is no tag, 10 and more are infinitely sharp.
  void joinTo(TriangleMesh& mesh);

 private:
  struct Crease {
    SharpEdge edge;
    std::size_t line;
  };
  struct Corner {
    SharpVertex vertex;
    std::size_t line;
  };
  void checkVertices(const TriangleMesh& mesh) const;
  void checkEdges(const TriangleMesh& mesh) const;

  std::vector<Crease> creases_;
  std::vector<Corner> corners_;
};

}  // namespace echocine
