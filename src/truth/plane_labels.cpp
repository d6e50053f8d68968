#include "truth/plane_labels.h"

#include <algorithm>
#include <cmath>

namespace echocine {

PlaneLabels::PlaneLabels(const Scene& scene, const PictureGrid& grid)
    : probe_(scene.probe), grid_(grid) {
  for (std::size_t s = 0; s < scene.structures.size(); ++s)
    if (!scene.structures[s].membrane) weakest_first_.push_back(static_cast<std::uint16_t>(s + 1));
  std::stable_sort(weakest_first_.begin(), weakest_first_.end(),
                   [&](std::uint16_t a, std::uint16_t b) {
                     return scene.structures[a - 1u].priority < scene.structures[b - 1u].priority;
                   });
  for (int row = 0; row < grid.height; ++row) {
    row_spans_.push_back(spans_.size());
    bool before = false;
    for (int column = 0; column < grid.width; ++column) {
      const bool shown = inScanArea(probe_, grid.xOf(column), grid.zOf(row));
      const auto c = static_cast<std::uint32_t>(column);
      if (shown && !before) spans_.emplace_back(c, c);
      if (shown) spans_.back().second = c + 1;
      before = shown;
    }
  }
  row_spans_.push_back(spans_.size());
}

// Half-open at the edge's ends, so that a contour crosses a row an even number of times.
void PlaneLabels::crossRows(const ContourEdge& edge,
                            std::vector<std::vector<RowCrossing>>& rows) const {
  const Vec3d from = edge.cut.from, to = edge.cut.to;
  const auto rowNear = [&](double z, double more) {
    const double row = std::floor(z / grid_.metres_per_pixel + grid_.origin_y_px - 0.5) + more;
    return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(grid_.height)));
  };
  const int end = rowNear(std::max(from.z, to.z), 2);
  for (int row = rowNear(std::min(from.z, to.z), 0); row < end; ++row) {
    const double z = grid_.zOf(row);
    if ((from.z >= z) == (to.z >= z)) continue;
    const double s = (z - from.z) / (to.z - from.z);
    rows[static_cast<std::size_t>(row)].push_back(
        {from.x + s * (to.x - from.x), from.z >= z ? 1 : -1});
  }
}

void PlaneLabels::fillRow(std::vector<RowCrossing>& crossings, std::uint16_t id, int row,
                          Ids& ids) const {
  std::sort(crossings.begin(), crossings.end(), [](const RowCrossing& a, const RowCrossing& b) {
    return a.x_m < b.x_m || (a.x_m == b.x_m && a.change < b.change);
  });
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width);
  const auto columnFrom = [&](double x_m) {
    const double column = std::ceil(x_m / grid_.metres_per_pixel + grid_.origin_x_px - 0.5);
    return static_cast<std::uint32_t>(std::clamp(column, 0.0, static_cast<double>(grid_.width)));
  };
  const auto r = static_cast<std::size_t>(row);
  const auto paint = [&](std::uint32_t from, std::uint32_t to) {
    for (std::size_t s = row_spans_[r]; s < row_spans_[r + 1]; ++s) {
      const std::uint32_t begin = std::max(from, spans_[s].first),
                          end = std::min(to, spans_[s].second);
      if (begin < end)
        std::fill(ids.begin() + static_cast<std::ptrdiff_t>(first + begin),
                  ids.begin() + static_cast<std::ptrdiff_t>(first + end), id);
    }
  };
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].change;
    if (winding == 0) continue;
    paint(columnFrom(crossings[i].x_m), columnFrom(crossings[i + 1].x_m));
  }
}

void PlaneLabels::picture(std::span<const ContourEdge> edges, Ids& ids) const {
  ids.assign(static_cast<std::size_t>(grid_.width) * static_cast<std::size_t>(grid_.height), 0);
  thread_local std::vector<std::vector<RowCrossing>> rows;
  thread_local std::vector<std::vector<std::size_t>> of_surface;
  rows.resize(static_cast<std::size_t>(grid_.height));
  of_surface.assign(kMaxSurfaces, {});
  for (std::size_t i = 0; i < edges.size(); ++i) of_surface[index(edges[i].surface)].push_back(i);
  for (const std::uint16_t id : weakest_first_) {
    const std::vector<std::size_t>& mine = of_surface[id - 1u];
    if (mine.empty()) continue;
    for (auto& row : rows) row.clear();
    for (const std::size_t i : mine) crossRows(edges[i], rows);
    for (int row = 0; row < grid_.height; ++row)
      if (auto& crossings = rows[static_cast<std::size_t>(row)]; !crossings.empty())
        fillRow(crossings, id, row, ids);
  }
}

void PlaneLabels::samples(std::span<const RayCrossings> lines,
                          std::vector<std::uint32_t>& ids) const {
  const auto count = static_cast<std::size_t>(probe_.samples);
  ids.clear();
  ids.reserve(lines.size() * count);
  const double spacing_m = probe_.sampleSpacing();
  const auto sampleFrom = [&](double path_m) {
    const double sample = std::ceil((path_m - probe_.min_depth_m) / spacing_m - 0.5);
    return static_cast<std::size_t>(std::clamp(sample, 0.0, static_cast<double>(count)));
  };
  for (std::size_t line = 0; line < lines.size(); ++line) {
    InsideSet inside = lines[line].inside;
    const auto winner = [&]() -> std::uint32_t {
      for (auto id = weakest_first_.rbegin(); id != weakest_first_.rend(); ++id)
        if (inside[*id - 1u]) return *id;
      return 0;
    };
    std::size_t begin = 0;
    std::uint32_t now = winner();
    for (const Crossing& crossing : lines[line].crossings) {
      const std::size_t end = sampleFrom(crossing.distance_m);
      if (end > begin) {
        ids.insert(ids.end(), end - begin, now);
        begin = end;
      }
      inside[index(crossing.surface)] = crossing.entering;
      now = winner();
    }
    ids.insert(ids.end(), count - begin, now);
  }
}

}  // namespace echocine
