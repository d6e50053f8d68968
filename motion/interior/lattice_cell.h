#pragma once
// One cell of a group's lattice: interpolation from its eight nodes.

#include <cstddef>

#include "core/lanes.h"
#include "core/vec3.h"

namespace echocine {

// Positions of a cell's nodes in a group's displacements: rows along x at (y, z) of (0, 0), (0, 1),
// (1, 0) and (1, 1), and the offset of the second node of each.
struct CellNodes {
  std::size_t rows[4];
  std::size_t right;
};

inline Floats4 lanesOf(Vec3f v) {
  return Floats4{v.x, v.y, v.z, 0};
}
inline Vec3f vectorOf(Floats4 v) {
  return {v[0], v[1], v[2]};
}

// A displacement in a cell, trilinear, and its change from one side of the cell to the other along
// each axis.
struct CellValue {
  Floats4 value, along_x, along_y, along_z;
};

// The displacements of a cell's nodes, in metres.
struct CellCorners {
  Floats4 d[4][2];

  static CellCorners of(const Vec3f* displacement_m, const CellNodes& nodes) {
    CellCorners corners;
    for (std::size_t i = 0; i < 4; ++i) {
      corners.d[i][0] = lanesOf(displacement_m[nodes.rows[i]]);
      corners.d[i][1] = lanesOf(displacement_m[nodes.rows[i] + nodes.right]);
    }
    return corners;
  }

  CellCorners operator-(const CellCorners& other) const {
    CellCorners less = *this;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t x = 0; x < 2; ++x) less.d[i][x] -= other.d[i][x];
    return less;
  }

  // in_cell: 0 to 1 from side to side.
  CellValue at(Floats4 in_cell) const {
    const Floats4 x = Floats4{} + in_cell[0], y = Floats4{} + in_cell[1],
                  z = Floats4{} + in_cell[2];
    Floats4 step[4], row[4];
    for (std::size_t i = 0; i < 4; ++i) {
      step[i] = d[i][1] - d[i][0];
      row[i] = d[i][0] + x * step[i];
    }
    const Floats4 up[2] = {row[1] - row[0], row[3] - row[2]};
    const Floats4 low = row[0] + z * up[0], high = row[2] + z * up[1];
    const Floats4 on[2] = {step[0] + z * (step[1] - step[0]), step[2] + z * (step[3] - step[2])};
    return {low + y * (high - low), on[0] + y * (on[1] - on[0]), high - low,
            up[0] + y * (up[1] - up[0])};
  }
};

}  // namespace echocine
