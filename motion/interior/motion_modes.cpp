#include "motion/interior/motion_modes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/lanes.h"

namespace echocine {

namespace {

using Matrix = std::vector<std::vector<double>>;

// Eigenvectors of a symmetric matrix, which becomes diagonal, by Jacobi's rotations.
Matrix diagonalise(Matrix& a) {
  const std::size_t n = a.size();
  Matrix vectors(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) vectors[i][i] = 1;
  const auto rotate = [n](Matrix& m, std::size_t p, std::size_t q, double c, double s) {
    for (std::size_t i = 0; i < n; ++i) {
      const double left = m[i][p], right = m[i][q];
      m[i][p] = c * left - s * right;
      m[i][q] = s * left + c * right;
    }
  };
  const auto turnRows = [n](Matrix& m, std::size_t p, std::size_t q, double c, double s) {
    for (std::size_t i = 0; i < n; ++i) {
      const double upper = m[p][i], lower = m[q][i];
      m[p][i] = c * upper - s * lower;
      m[q][i] = s * upper + c * lower;
    }
  };
  constexpr int kSweeps = 12;  // they converge quadratically: fewer than ten do at this size
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(theta), s = std::sin(theta);
        rotate(a, p, q, c, s);
        turnRows(a, p, q, c, s);
        rotate(vectors, p, q, c, s);
      }
  return vectors;
}

Matrix transposed(const Matrix& a) {
  Matrix out(a.empty() ? 0 : a[0].size(), std::vector<double>(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < out.size(); ++j) out[j][i] = a[i][j];
  return out;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out(a.size(), std::vector<double>(b[0].size(), 0.0));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      for (std::size_t j = 0; j < b[k].size(); ++j) out[i][j] += a[i][k] * b[k][j];
  return out;
}

// Numbers in whole lanes.
std::size_t padded(std::size_t count) {
  return (count + kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes;
}

// Coordinates of a point at each keyframe, or of each mode; 0 in the lanes beyond.
struct Course {
  std::vector<double> x, y, z;

  explicit Course(std::size_t count) : x(padded(count)), y(padded(count)), z(padded(count)) {}
  void set(std::span<const Vec3f> displacement_m) {
    for (std::size_t k = 0; k < displacement_m.size(); ++k) {
      const Vec3d d = toDouble(displacement_m[k]);
      x[k] = d.x;
      y[k] = d.y;
      z[k] = d.z;
    }
  }
};

// Adds the products of kPoints points, one after the other: each sum is loaded and stored once. Of
// the rows of `products` only the part from the diagonal on is whole.
template <std::size_t kPoints>
void addProducts(const Course* courses, std::size_t keyframes, std::vector<double>& products) {
  const std::size_t row = padded(keyframes);
  for (std::size_t i = 0; i < keyframes; ++i)
    for (std::size_t j = i / kDoubleLanes * kDoubleLanes; j < row; j += kDoubleLanes) {
      Doubles4 sum = lanesAt(&products[i * row + j]);
      for (std::size_t p = 0; p < kPoints; ++p) {
        const Course& at = courses[p];
        sum +=
            at.x[i] * lanesAt(&at.x[j]) + at.y[i] * lanesAt(&at.y[j]) + at.z[i] * lanesAt(&at.z[j]);
      }
      store(sum, &products[i * row + j]);
    }
}

Matrix gram(std::span<const Vec3f> displacement_m, std::size_t keyframes) {
  constexpr std::size_t kPointsTogether = 4;
  Matrix products(keyframes, std::vector<double>(keyframes, 0.0));
  if (keyframes == 0) return products;
  const std::size_t row = padded(keyframes);
  std::vector<double> sums(keyframes * row);
  std::vector<Course> courses(kPointsTogether, Course(keyframes));
  std::size_t held = 0;
  for (std::size_t start = 0; start < displacement_m.size(); start += keyframes) {
    courses[held++].set(displacement_m.subspan(start, keyframes));
    if (held < kPointsTogether) continue;
    addProducts<kPointsTogether>(courses.data(), keyframes, sums);
    held = 0;
  }
  for (std::size_t p = 0; p < held; ++p) addProducts<1>(&courses[p], keyframes, sums);
  for (std::size_t i = 0; i < keyframes; ++i)
    for (std::size_t j = i; j < keyframes; ++j) products[i][j] = products[j][i] = sums[i * row + j];
  return products;
}

// The displacements of each point as sums of the modes' parts: `mode_from_keyframe` has a row per
// keyframe.
std::vector<Vec3f> shapesOf(std::span<const Vec3f> displacement_m,
                            const Matrix& mode_from_keyframe) {
  const std::size_t keyframes = mode_from_keyframe.size(), modes = mode_from_keyframe[0].size(),
                    row = padded(modes);
  std::vector<double> factors(keyframes * row);
  for (std::size_t k = 0; k < keyframes; ++k)
    std::ranges::copy(mode_from_keyframe[k],
                      factors.begin() + static_cast<std::ptrdiff_t>(k * row));
  std::vector<Vec3f> shapes_m(displacement_m.size() / keyframes * modes);
  Course course(keyframes), sum(modes);
  for (std::size_t start = 0, to = 0; start < displacement_m.size(); start += keyframes) {
    course.set(displacement_m.subspan(start, keyframes));
    for (std::size_t m = 0; m < row; m += kDoubleLanes) {
      Doubles4 x{}, y{}, z{};
      for (std::size_t k = 0; k < keyframes; ++k) {
        const Doubles4 factor = lanesAt(&factors[k * row + m]);
        x += factor * course.x[k];
        y += factor * course.y[k];
        z += factor * course.z[k];
      }
      store(x, &sum.x[m]);
      store(y, &sum.y[m]);
      store(z, &sum.z[m]);
    }
    for (std::size_t m = 0; m < modes; ++m)
      shapes_m[to++] = toFloat(Vec3d{sum.x[m], sum.y[m], sum.z[m]});
  }
  return shapes_m;
}

}  // namespace

MotionModes motionModes(std::span<const Vec3f> displacement_m, std::size_t keyframes,
                        double tolerance_m, const Matrix& blends) {
  Matrix products = gram(displacement_m, keyframes);
  const Matrix turned = transposed(blends);
  if (!blends.empty()) products = product(product(blends, products), turned);
  const Matrix vectors = diagonalise(products);
  const auto points =
      static_cast<double>(displacement_m.size() / std::max<std::size_t>(keyframes, 1));
  std::vector<std::size_t> kept;
  for (std::size_t m = 0; m < keyframes; ++m)
    if (products[m][m] > tolerance_m * tolerance_m * points) kept.push_back(m);
  std::sort(kept.begin(), kept.end(),
            [&](std::size_t a, std::size_t b) { return products[a][a] > products[b][b]; });
  MotionModes modes;
  modes.count = kept.size();
  for (std::size_t k = 0; k < keyframes; ++k) {
    std::vector<double>& row = modes.keyframe_from_mode.emplace_back();
    for (const std::size_t m : kept) row.push_back(vectors[k][m]);
  }
  const Matrix& rows = modes.keyframe_from_mode;
  if (keyframes > 0)
    modes.shapes_m = shapesOf(displacement_m, blends.empty() ? rows : product(turned, rows));
  return modes;
}

}  // namespace echocine
