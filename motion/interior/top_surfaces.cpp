#include "motion/interior/top_surfaces.h"

#include <algorithm>
#include <cmath>

namespace echocine {

TopSurfaces::TopSurfaces(std::vector<Closed> closed) : closed_(std::move(closed)) {
  std::sort(closed_.begin(), closed_.end(), [](const Closed& a, const Closed& b) {
    return a.priority != b.priority ? a.priority > b.priority : a.id > b.id;
  });
  for (std::size_t i = 0; i < closed_.size(); ++i) {
    const std::size_t id = index(closed_[i].id);
    if (rank_.size() <= id) rank_.resize(id + 1, closed_.size());
    rank_[id] = i;
  }
}

std::optional<SurfaceId> TopSurfaces::at(Vec3d place_m, std::optional<SurfaceId> without) const {
  for (const Closed& surface : closed_)
    if (surface.id != without && surface.columns.contains(place_m)) return surface.id;
  return std::nullopt;
}

// False where the surface holds the whole box, which hides all weaker ones.
bool TopSurfaces::Within::add(const Closed& surface, const Box& box_m) {
  if (surface.columns.mayPass(box_m)) {
    asked_.push_back(&surface);
  } else if (surface.columns.contains(box_m.lo)) {
    else_ = surface.id;
    return false;
  }
  return true;
}

TopSurfaces::Within TopSurfaces::within(const Box& box_m) const {
  Within within;
  for (const Closed& surface : closed_)
    if (!within.add(surface, box_m)) break;
  return within;
}

TopSurfaces::Within TopSurfaces::Within::within(const Box& box_m) const {
  Within within;
  for (const Closed* surface : asked_)
    if (!within.add(*surface, box_m)) return within;
  within.else_ = else_;
  return within;
}

std::optional<SurfaceId> TopSurfaces::Within::at(Vec3d place_m) const {
  for (const Closed* surface : asked_)
    if (surface->columns.contains(place_m)) return surface->id;
  return else_;
}

std::vector<std::optional<SurfaceId>> TopSurfaces::Within::surfaces() const {
  std::vector<std::optional<SurfaceId>> surfaces;
  for (const Closed* surface : asked_) surfaces.emplace_back(surface->id);
  surfaces.push_back(else_);
  return surfaces;
}

bool TopSurfaces::hides(Vec3d place_m, SurfaceId surface) const {
  for (std::size_t i = 0; i < rank_[index(surface)]; ++i)
    if (closed_[i].columns.contains(place_m)) return true;
  return false;
}

// Weakest first, each over what the weaker left.
void TopSurfaces::alongX(double start, double step, double y, double z,
                         std::span<std::int16_t> row) const {
  std::fill(row.begin(), row.end(), kNone);
  const auto last = static_cast<double>(row.size());
  thread_local std::vector<Columns::Crossing> crossings;
  for (auto surface = closed_.rbegin(); surface != closed_.rend(); ++surface) {
    surface->columns.crossings(y, z, crossings);
    int winding = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      winding += crossings[i].change;
      if (winding <= 0) continue;
      const auto from = std::clamp(std::ceil((crossings[i].x - start) / step), 0.0, last),
                 to = std::clamp(std::ceil((crossings[i + 1].x - start) / step), 0.0, last);
      std::fill(row.begin() + static_cast<std::ptrdiff_t>(from),
                row.begin() + static_cast<std::ptrdiff_t>(to),
                static_cast<std::int16_t>(index(surface->id)));
    }
  }
}

}  // namespace echocine
