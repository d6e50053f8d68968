#pragma once
// The `t` statements of an OBJ file, in the syntax of OpenSubdiv's example shapes.

#include <cstddef>
#include <string_view>
#include <vector>

#include "motion/mesh/mesh.h"

namespace echocine {

// Collects creases and corners while a file is read and adds them to its mesh at the end, because
// tags may precede their faces.
//   t crease 2/1/0 <v0> <v1> <sharpness>
//   t corner 1/1/0 <v> <sharpness>
// Vertices count from 0, unlike those of faces. Errors are SceneErrors that start with the line's
// number.
class ObjTags {
 public:
  // `rest`: the text after the `t`.
  void read(std::string_view rest, std::size_t line_number);

  // Every edge and vertex must exist in the mesh. Repeated tags must have equal sharpness.
  // Sharpness 0 is no tag; 10 and more are infinitely sharp.
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
