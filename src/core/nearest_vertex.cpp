#include "core/nearest_vertex.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/box.h"
#include "core/check.h"

namespace echocine {

namespace {

// Bins along the longest side, our choice: points of a surface are then a few to each that has any.
int binsFor(std::size_t points) {
  return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(points)) / 4), 8, 64);
}

}  // namespace

NearestVertex::NearestVertex(std::span<const Vec3f> points_m) {
  CHECK_LT(std::size_t{0}, points_m.size());
  Box box;
  for (const Vec3f p : points_m) box.add(toDouble(p));
  const Vec3d size = box.hi - box.lo;
  low_m_ = toFloat(box.lo);
  edge_m_ = static_cast<float>(std::max({size.x, size.y, size.z, 1e-9}) / binsFor(points_m.size()));
  const auto bins = [&](double length) {
    return static_cast<int>(length / static_cast<double>(edge_m_)) + 1;
  };
  nx_ = bins(size.x);
  ny_ = bins(size.y);
  nz_ = bins(size.z);
  starts_.assign(bin(0, 0, nz_) + 1, 0);
  std::vector<std::size_t> of(points_m.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    const Vec3f p = points_m[i];
    of[i] = bin(binOf(p.x, low_m_.x, nx_), binOf(p.y, low_m_.y, ny_), binOf(p.z, low_m_.z, nz_));
    ++starts_[of[i] + 1];
  }
  for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
  points_m_.resize(of.size());
  numbers_.resize(of.size());
  std::vector<std::uint32_t> next = starts_;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const std::uint32_t place = next[of[i]]++;
    points_m_[place] = points_m[i];
    numbers_[place] = static_cast<std::uint32_t>(i);
  }
}

std::size_t NearestVertex::bin(int x, int y, int z) const {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
          static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(nx_) +
         static_cast<std::size_t>(x);
}

int NearestVertex::binOf(float at, float low, int count) const {
  return std::clamp(static_cast<int>((at - low) / edge_m_), 0, count - 1);
}

// Shells of bins about the place's own, until none that is left can be nearer.
std::optional<std::uint32_t> NearestVertex::placeOf(Vec3f place_m, float reach_m) const {
  const Vec3f held{std::clamp(place_m.x, low_m_.x, low_m_.x + edge_m_ * static_cast<float>(nx_)),
                   std::clamp(place_m.y, low_m_.y, low_m_.y + edge_m_ * static_cast<float>(ny_)),
                   std::clamp(place_m.z, low_m_.z, low_m_.z + edge_m_ * static_cast<float>(nz_))};
  const int cx = binOf(held.x, low_m_.x, nx_), cy = binOf(held.y, low_m_.y, ny_),
            cz = binOf(held.z, low_m_.z, nz_);
  const Vec3f off = place_m - held;
  const float outside = std::sqrt(off.x * off.x + off.y * off.y + off.z * off.z);
  // From there to the nearest side of its bin.
  const auto toSide = [&](float at, float low, int bin) {
    const float in = at - low - edge_m_ * static_cast<float>(bin);
    return std::min(in, edge_m_ - in);
  };
  const float inside =
      std::max(std::min({toSide(held.x, low_m_.x, cx), toSide(held.y, low_m_.y, cy),
                         toSide(held.z, low_m_.z, cz)}),
               0.0f);
  float best2 = reach_m * reach_m;
  std::optional<std::uint32_t> best;
  const auto look = [&](std::size_t first_bin, std::size_t last_bin) {
    for (std::uint32_t i = starts_[first_bin]; i < starts_[last_bin + 1]; ++i) {
      const Vec3f d = points_m_[i] - place_m;
      const float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
      if (d2 < best2) {
        best2 = d2;
        best = i;
      }
    }
  };
  // No point of the bins with this number along an axis is nearer along it. Rounding moves a point
  // by far less than the margin.
  const auto along = [&](float at, float low, int bin) {
    const float in = at - low - edge_m_ * static_cast<float>(bin);
    return std::max(std::max(-in, in - edge_m_) - 1e-3f * edge_m_, 0.0f);
  };
  for (int shell = 0; shell <= std::max({nx_, ny_, nz_}); ++shell) {
    const float least =
        shell == 0 ? 0 : std::max(static_cast<float>(shell - 1) * edge_m_ + inside - outside, 0.0f);
    if (best2 < least * least) break;
    const int x0 = cx - shell, x1 = cx + shell;
    for (int z = std::max(cz - shell, 0); z <= std::min(cz + shell, nz_ - 1); ++z) {
      const float off_z = along(place_m.z, low_m_.z, z);
      if (off_z * off_z > best2) continue;
      for (int y = std::max(cy - shell, 0); y <= std::min(cy + shell, ny_ - 1); ++y) {
        const float off_y = along(place_m.y, low_m_.y, y);
        if (off_y * off_y + off_z * off_z > best2) continue;
        if (std::abs(z - cz) == shell || std::abs(y - cy) == shell) {  // a row's bins are one run
          look(bin(std::max(x0, 0), y, z), bin(std::min(x1, nx_ - 1), y, z));
          continue;
        }
        if (x0 >= 0) look(bin(x0, y, z), bin(x0, y, z));
        if (x1 < nx_) look(bin(x1, y, z), bin(x1, y, z));
      }
    }
  }
  return best;
}

}  // namespace echocine
