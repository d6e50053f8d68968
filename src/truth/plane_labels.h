#pragma once
// Structures in the imaging plane: at the picture's pixels and at the samples of the scan lines,
// exactly at their centres, by the tracer's priority rule.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/plane_slice.h"
#include "scene/scan_geometry.h"
#include "scene/scene.h"

namespace echocine {

// The picture's pixels in the imaging plane: pixel (i, j) has its centre at
// ((i + 1/2 - origin_x_px), (j + 1/2 - origin_y_px)) metres_per_pixel.
struct PictureGrid {
  int width = 0, height = 0;
  double origin_x_px = 0, origin_y_px = 0, metres_per_pixel = 1;

  double xOf(int column) const { return (column + 0.5 - origin_x_px) * metres_per_pixel; }
  double zOf(int row) const { return (row + 0.5 - origin_y_px) * metres_per_pixel; }
};

class PlaneLabels {
 public:
  // 0 in the background, otherwise a structure's position in the scene, from 1.
  using Ids = std::vector<std::uint16_t>;

  PlaneLabels(const Scene& scene, const PictureGrid& grid);

  // Every pixel's structure, rows from the top; 0 outside the scan area. Edges are those of all
  // surfaces of a frame. Thread-safe.
  void picture(std::span<const ContourEdge> edges, Ids& ids) const;

  // Every sample's structure, line-major. Crossings are those of all surfaces. Thread-safe.
  void samples(std::span<const RayCrossings> lines, std::vector<std::uint32_t>& ids) const;

 private:
  struct RowCrossing {
    double x_m;
    int change;
  };
  void crossRows(const ContourEdge& edge, std::vector<std::vector<RowCrossing>>& rows) const;
  void fillRow(std::vector<RowCrossing>& crossings, std::uint16_t id, int row, Ids& ids) const;

  Probe probe_;
  PictureGrid grid_;
  std::vector<std::uint16_t> weakest_first_;  // closed structures, from 1
  // Columns [from, to) of each row that lie in the scan area, and the first span of each row.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> spans_;
  std::vector<std::size_t> row_spans_;
};

}  // namespace echocine
