#include "motion/heart/envelope.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/lanes.h"
#include "motion/heart/four_points.h"
#include "motion/heart/heart_units.h"

namespace echocine::heart {
namespace {

const std::vector<Vec3d>& sacDirections() {
  static const std::vector<Vec3d>& directions = geodesicSphere(Envelope::kFrequency).directions;
  return directions;
}

constexpr double kCone_rad = 13 * kDegree;

// Cells of a cube's faces, seen from its centre, with the directions whose cones a point in the
// cell can reach, by fours. The last of them may be repeated.
class ConeCells {
 public:
  struct Near {
    FourPoints directions;
    std::array<std::size_t, kDoubleLanes> numbers;
  };

  ConeCells() {
    for (std::size_t face = 0; face < 6; ++face)
      for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column)
          cells_.push_back(nearCell(face, row, column));
  }

  // Those of a point, relative to the centre.
  const std::vector<Near>& about(Vec3d from) const {
    const std::array<double, 3> p{from.x, from.y, from.z};
    std::size_t axis = std::abs(p[1]) > std::abs(p[0]) ? 1 : 0;
    if (std::abs(p[2]) > std::abs(p[axis])) axis = 2;
    const double scale = 0.5 * kSide / std::max(std::abs(p[axis]), kTiny);
    const auto cell = [&](double at) {
      return std::min(static_cast<std::size_t>(at * scale + 0.5 * kSide), kSide - std::size_t{1});
    };
    const std::size_t face = 2 * axis + (p[axis] < 0 ? 1 : 0);
    return cells_[(face * kSide + cell(p[(axis + 1) % 3])) * kSide + cell(p[(axis + 2) % 3])];
  }

 private:
  static constexpr int kSide = 8;

  static Vec3d onCube(std::size_t face, double row, double column) {
    std::array<double, 3> p{};
    const std::size_t axis = face / 2;
    p[axis] = face % 2 == 0 ? 1 : -1;
    p[(axis + 1) % 3] = 2 * row / kSide - 1;
    p[(axis + 2) % 3] = 2 * column / kSide - 1;
    return normalised(Vec3d{p[0], p[1], p[2]});
  }

  // The corners of a cell are its places farthest from the middle.
  static std::vector<Near> nearCell(std::size_t face, int row, int column) {
    const Vec3d middle = onCube(face, row + 0.5, column + 0.5);
    double radius_rad = 0;
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        radius_rad =
            std::max(radius_rad, std::acos(dot(middle, onCube(face, row + i, column + j))));
    const double least = std::cos(kCone_rad + radius_rad + 0.1 * kDegree);  // room for rounding
    std::vector<Vec3d> directions;
    std::vector<std::size_t> numbers;
    for (std::size_t d = 0; d < sacDirections().size(); ++d)
      if (dot(middle, sacDirections()[d]) >= least) {
        directions.push_back(sacDirections()[d]);
        numbers.push_back(d);
      }
    std::vector<Near> near;
    for (std::size_t i = 0; i < numbers.size(); i += kDoubleLanes) {
      near.push_back({fourPointsAt(directions, i), {}});
      for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
        near.back().numbers[lane] = numbers[std::min(i + lane, numbers.size() - 1)];
    }
    return near;
  }

  std::vector<std::vector<Near>> cells_;
};

// The farthest point within a cone about each direction.
std::vector<double> farthestIn(std::span<const Vec3d> points, Vec3d centre) {
  static const ConeCells cells;
  const double cos_cone = std::cos(kCone_rad);
  std::vector<double> farthest_m(sacDirections().size(), 0);
  for (const Vec3d point : points) {
    const Vec3d from = point - centre;
    const double distance = length(from), least = cos_cone * distance;
    const FourPoints from_all = inAllLanes(from);
    for (const auto& [directions, numbers] : cells.about(from)) {
      const Doubles4 reached =
          dot(from_all, directions) >= least ? Doubles4{} + distance : Doubles4{};
      for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
        double& farthest = farthest_m[numbers[lane]];
        farthest = std::max(farthest, reached[lane]);
      }
    }
  }
  return farthest_m;
}

// The directions in the mean around each one, with their weights.
struct Share {
  std::size_t direction;
  double weight;
};
const std::vector<std::vector<Share>>& sharesAbout() {
  static const std::vector<std::vector<Share>> shares = [] {
    const double cos_mean = std::cos(12.9 * kDegree);
    std::vector<std::vector<Share>> made(sacDirections().size());
    for (std::size_t d = 0; d < made.size(); ++d)
      for (std::size_t e = 0; e < made.size(); ++e) {
        const double cosine = dot(sacDirections()[d], sacDirections()[e]);
        if (cosine >= cos_mean) made[d].push_back({e, (cosine - cos_mean) / (1 - cos_mean)});
      }
    return made;
  }();
  return shares;
}

}  // namespace

// The farthest point within a cone, then the mean over a cone of equal width. The result is smooth.
// It is not closer than the point itself, because it is a mean of maxima over cones that contain
// the point.
Envelope::Envelope(std::span<const Vec3d> points, Vec3d centre) : centre_(centre) {
  const std::vector<double> farthest_m = farthestIn(points, centre);
  for (const std::vector<Share>& shares : sharesAbout()) {
    double sum = 0, weights = 0;
    for (const auto& [direction, weight] : shares) {
      sum += weight * farthest_m[direction];
      weights += weight;
    }
    reach_m_.push_back(sum / weights);
  }
}

std::vector<Vec3d> Envelope::points(double gap_m) const {
  std::vector<Vec3d> surface;
  surface.reserve(reach_m_.size());
  for (std::size_t d = 0; d < reach_m_.size(); ++d)
    surface.push_back(centre_ + (reach_m_[d] + gap_m) * sacDirections()[d]);
  return surface;
}

}  // namespace echocine::heart
