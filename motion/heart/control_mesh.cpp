#include "motion/heart/control_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "motion/mesh/edge_sides.h"

namespace echocine::heart {
namespace {

constexpr int kCorners = 12;
// A vertex of the geodesic sphere, exactly: its weights of the icosahedron's corners.
using Weights = std::array<int, kCorners>;

std::array<Vec3d, kCorners> icosahedronCorners() {
  std::array<Vec3d, kCorners> corners;
  corners[0] = {0, 0, -1};
  corners[11] = {0, 0, 1};
  const double z = 1 / std::sqrt(5.0), r = 2 * z;
  for (int i = 0; i < 5; ++i) {
    const double lower_rad = 2 * std::numbers::pi * i / 5;
    const double upper_rad = lower_rad + std::numbers::pi / 5;
    corners[1 + i] = {r * std::cos(lower_rad), r * std::sin(lower_rad), -z};
    corners[6 + i] = {r * std::cos(upper_rad), r * std::sin(upper_rad), z};
  }
  return corners;
}

std::vector<Face> icosahedronFaces() {
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t next = (i + 1) % 5;
    faces.push_back({0, 1 + next, 1 + i});
    faces.push_back({1 + i, 1 + next, 6 + i});
    faces.push_back({6 + i, 1 + next, 6 + next});
    faces.push_back({6 + i, 6 + next, 11});
  }
  return faces;
}

// Neighbourhood of a vertex in its Loop limit.
struct Neighbourhood {
  std::vector<std::uint32_t> ring;      // all neighbours
  std::vector<std::uint32_t> boundary;  // neighbours along the edge of a sheet
  double weight = 0;                    // of each of those that count, in the limit position
};

// By Loop's rules; the edge of a sheet is a cubic B-spline.
double limitWeight(const Neighbourhood& around) {
  const double n = static_cast<double>(around.ring.size());
  const double centre = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
  const double beta = (0.625 - centre * centre) / n;
  return around.boundary.empty() ? 1 / (n + 0.375 / beta) : 1.0 / 6;
}

std::vector<Neighbourhood> neighbourhoods(std::size_t vertex_count,
                                          const std::vector<Face>& faces) {
  std::vector<Neighbourhood> result(vertex_count);
  const std::vector<Side> sides = sortedSides(faces);
  forEachEdge(sides, [&](std::span<const Side> edge) {
    const std::uint32_t a = sideStart(faces, edge[0].side), b = sideEnd(faces, edge[0].side);
    result[a].ring.push_back(b);
    result[b].ring.push_back(a);
    if (edge.size() > 1) return;
    result[a].boundary.push_back(b);
    result[b].boundary.push_back(a);
  });
  for (Neighbourhood& around : result) around.weight = limitWeight(around);
  return result;
}

}  // namespace

namespace {

SphereMesh madeSphere(int frequency) {
  const auto corners = icosahedronCorners();
  SphereMesh sphere;
  std::map<Weights, std::uint32_t> known;
  for (const Face& face : icosahedronFaces()) {
    const auto vertex = [&](int i, int j) {
      Weights weights{};
      weights[face[0]] += frequency - i - j;
      weights[face[1]] += i;
      weights[face[2]] += j;
      const auto next = static_cast<std::uint32_t>(sphere.directions.size());
      const auto [place, is_new] = known.try_emplace(weights, next);
      if (is_new) {
        Vec3d sum;
        for (int k = 0; k < kCorners; ++k) sum = sum + double(weights[k]) * corners[k];
        sphere.directions.push_back(normalised(sum));
      }
      return place->second;
    };
    for (int i = 0; i < frequency; ++i)
      for (int j = 0; i + j < frequency; ++j) {
        sphere.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 < frequency)
          sphere.faces.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return sphere;
}

}  // namespace

// A heart uses the same few meshes at every instant.
const SphereMesh& geodesicSphere(int frequency) {
  static std::mutex mutex;
  static std::map<int, SphereMesh> made;
  const std::lock_guard lock(mutex);
  const auto found = made.find(frequency);
  return found != made.end() ? found->second
                             : made.emplace(frequency, madeSphere(frequency)).first->second;
}

std::vector<Face> sheetFaces(int rows, int columns) {
  std::vector<Face> faces;
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const auto here = static_cast<std::uint32_t>(row * columns + column);
      const auto below = static_cast<std::uint32_t>(here + columns);
      faces.push_back({here, here + 1, below + 1});
      faces.push_back({here, below + 1, below});
    }
  return faces;
}

std::array<std::uint32_t, 4> sheetCorners(int rows, int columns) {
  const auto last_row = static_cast<std::uint32_t>((rows - 1) * columns);
  const auto last_column = static_cast<std::uint32_t>(columns - 1);
  return {0, last_column, last_row, last_row + last_column};
}

double volumeOf(const std::vector<Vec3d>& points, const std::vector<Face>& faces) {
  double six_volumes = 0;
  for (const Face& face : faces)
    six_volumes += dot(points[face[0]], cross(points[face[1]], points[face[2]]));
  return six_volumes / 6;
}

LoopFit::LoopFit(std::size_t vertex_count, const std::vector<Face>& faces,
                 std::span<const std::uint32_t> corners)
    : corners_(corners.begin(), corners.end()) {
  for (const Neighbourhood& around : neighbourhoods(vertex_count, faces)) {
    const auto& others = around.boundary.empty() ? around.ring : around.boundary;
    first_.push_back(static_cast<std::uint32_t>(others_.size()));
    others_.insert(others_.end(), others.begin(), others.end());
    weights_.push_back(around.weight);
  }
  first_.push_back(static_cast<std::uint32_t>(others_.size()));
}

// Loop's limit weights preserve at least a quarter of the finest detail, so each round removes at
// least a quarter of its remainder, and far more of smooth components.
std::vector<LoopFit::FourPoints> LoopFit::controlPoints(
    const std::vector<FourPoints>& wanted) const {
  constexpr int kRounds = 24;
  std::vector<FourPoints> control = wanted, better(wanted.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const double weight = weights_[i], n = first_[i + 1] - first_[i], own = 1 - n * weight;
      FourPoints limit{own * control[i].x, own * control[i].y, own * control[i].z};
      for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k) {
        const FourPoints& other = control[others_[k]];
        limit.x += weight * other.x;
        limit.y += weight * other.y;
        limit.z += weight * other.z;
      }
      better[i] = {control[i].x + wanted[i].x - limit.x, control[i].y + wanted[i].y - limit.y,
                   control[i].z + wanted[i].z - limit.z};
    }
    for (const std::uint32_t corner : corners_) better[corner] = wanted[corner];
    std::swap(control, better);
  }
  return control;
}

std::vector<std::vector<Vec3d>> LoopFit::controlPoints(
    std::span<const std::vector<Vec3d>> instants) const {
  std::vector<std::vector<Vec3d>> control;
  std::vector<FourPoints> wanted;
  for (std::size_t first = 0; first < instants.size(); first += kDoubleLanes) {
    const std::size_t count = std::min(kDoubleLanes, instants.size() - first);
    wanted.assign(instants.front().size(), FourPoints{});
    for (std::size_t lane = 0; lane < count; ++lane)
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Vec3d point = instants[first + lane][i];
        wanted[i].x[lane] = point.x, wanted[i].y[lane] = point.y, wanted[i].z[lane] = point.z;
      }
    const std::vector<FourPoints> found = controlPoints(wanted);
    for (std::size_t lane = 0; lane < count; ++lane) {
      std::vector<Vec3d>& points = control.emplace_back();
      points.reserve(found.size());
      for (const FourPoints& at : found) points.push_back({at.x[lane], at.y[lane], at.z[lane]});
    }
  }
  return control;
}

}  // namespace echocine::heart
