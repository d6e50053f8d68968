#include "echo/echo_spread.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "echo/beam_grid.h"

namespace echocine::echo {

namespace {

constexpr double kPatch_m = 12e-3;    // side of a patch: many speckles; our choice
constexpr int kMostLag = 4;           // pixels, each way; our choice
constexpr int kFramesSeen = 6;        // evenly through the loop; our choice
constexpr double kLeastGreys = 1.5;   // deviation of a patch that shows speckle; our choice
constexpr double kSpeckle_db = 5.57;  // deviation of its logarithm: 4.343 pi / sqrt(6)
constexpr double kLogPower = 1.5;     // of Eq. 11
// Blood lies 20 to 30 dB below muscle, and heterogeneous walls look as if by less. Our choice.
constexpr double kMostContrast_db = 40;

// A patch of a frame.
struct Patch {
  int side = 0;
  std::vector<double> left;  // of its greys, without the plane through them
  double mean = 0, deviation = 0;
  double along_m = 0, across_rad = 0;
};

double quantileOf(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// Whole within the sector, and clipped nowhere much.
bool usable(const EchoLoop& loop, const PixelPlane& frame, int left, int top, int side) {
  for (const int j : {0, side - 1})
    for (const int i : {0, side - 1})
      if (!showsEcho(loop, left + i + 0.5, top + j + 0.5)) return false;
  int clipped = 0;
  for (int j = top; j < top + side; ++j)
    for (int i = left; i < left + side; ++i) {
      const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(loop.video.width) +
                      static_cast<std::size_t>(i);
      if (loop.overlay[at] != 0) return false;
      if (frame[at] == 0 || frame[at] == 255) ++clipped;
    }
  return 20 * clipped <= side * side;
}

Patch cutPatch(const PixelPlane& frame, int width, int left, int top, int side) {
  Patch p;
  p.side = side;
  double sum = 0, across = 0, down = 0, squares = 0;
  const double middle = (side - 1) / 2.0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double g = frame[static_cast<std::size_t>(top + j) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(left + i)];
      p.left.push_back(g);
      sum += g, across += (i - middle) * g, down += (j - middle) * g;
      squares += (i - middle) * (i - middle);
    }
  p.mean = sum / (side * side);
  double rest = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      double& g = p.left[static_cast<std::size_t>(j * side + i)];
      g -= p.mean + ((i - middle) * across + (j - middle) * down) / squares;
      rest += g * g;
    }
  p.deviation = std::sqrt(rest / (side * side));
  return p;
}

double correlationAt(const Patch& p, int di, int dj) {
  double sum = 0;
  int n = 0;
  for (int j = 0; j < p.side - dj; ++j)
    for (int i = std::max(0, -di); i < p.side - std::max(0, di); ++i, ++n)
      sum += p.left[static_cast<std::size_t>(j * p.side + i)] *
             p.left[static_cast<std::size_t>((j + dj) * p.side + i + di)];
  return sum / n / (p.deviation * p.deviation);
}

// Eq. 11 by weighted least squares over lags; x, z: of the patch from the apex. False for greys
// that no bell explains.
bool findSpread(Patch& p, double x_m, double z_m, double pixel_m) {
  constexpr double kClear = 0.2, kLeast = 0.01;  // correlations; our choice
  const double r = std::hypot(x_m, z_m);
  double aa = 0, ab = 0, bb = 0, ay = 0, by = 0;
  for (int dj = 0; dj <= kMostLag; ++dj)
    for (int di = dj == 0 ? 1 : -kMostLag; di <= kMostLag; ++di) {
      // Next neighbours count however little they have in common: speckle may be as fine as pixels.
      const double found = correlationAt(p, di, dj);
      if (found < kClear && (dj > 1 || std::abs(di) > 1)) continue;
      const double c = std::clamp(found, kLeast, 0.999), weight = c * c;
      const double along = (di * x_m + dj * z_m) / r, across = (di * z_m - dj * x_m) / r,
                   a = along * along, b = across * across, y = -std::log(c);
      aa += weight * a * a, ab += weight * a * b, bb += weight * b * b;
      ay += weight * a * y, by += weight * b * y;
    }
  const double det = aa * bb - ab * ab;
  if (!(det > 1e-9 * aa * bb)) return false;
  const double a = (ay * bb - by * ab) / det, b = (by * aa - ay * ab) / det;
  if (!(a > 0 && b > 0)) return false;
  // In pixels. The spread due to the width of pixels acts on grey levels and moves no edge.
  const auto width = [](double curvature) {
    return std::sqrt(std::max(0.0, kLogPower / (4 * curvature) - 1.0 / 12));
  };
  p.along_m = width(a) * pixel_m;
  p.across_rad = width(b) * pixel_m / r;
  return true;
}

std::vector<Patch> patchesOf(const EchoLoop& real, double pixel_m) {
  const Video& v = real.video;
  const int side = std::max(2 * kMostLag, static_cast<int>(std::lround(kPatch_m / pixel_m)));
  const int frames = std::min(kFramesSeen, v.frameCount());
  std::vector<Patch> patches;
  for (int f = 0; f < frames; ++f) {
    const PixelPlane& frame = v.frames[static_cast<std::size_t>(f * v.frameCount() / frames)];
    for (int top = 0; top + side <= v.height; top += side / 2)
      for (int left = 0; left + side <= v.width; left += side / 2) {
        if (!usable(real, frame, left, top, side)) continue;
        Patch p = cutPatch(frame, v.width, left, top, side);
        const double x = (left + side / 2.0 - real.sector().apex_x) * pixel_m,
                     z = (top + side / 2.0 - real.sector().apex_y) * pixel_m;
        if (p.deviation < kLeastGreys || !findSpread(p, x, z, pixel_m)) continue;
        p.left.clear();
        patches.push_back(std::move(p));
      }
  }
  return patches;
}

}  // namespace

double edgeShiftPerWidth(double contrast_db) {
  const double least = std::pow(10, -contrast_db / 10);
  double first = 0, all = 0;
  constexpr double kStep = 0.02, kEnd = 6;
  for (double t = -kEnd; t <= kEnd; t += kStep) {
    const double share = 0.5 * std::erfc(-t / std::sqrt(2.0)),
                 slope = std::exp(-t * t / 2) / (least / (1 - least) + share);
    first += t * slope, all += slope;
  }
  return -first / all;
}

void EchoSpread::prepare() {
  per_width_ = patches > 0 && contrast_db > 0 ? edgeShiftPerWidth(contrast_db) : 0;
}

double EchoSpread::shift(double range_m, double c) const {
  const double across_m = across_rad * range_m;
  return per_width_ *
         std::sqrt(along_m * along_m * c * c + across_m * across_m * std::max(0.0, 1 - c * c));
}

EchoSpread measureSpread(const EchoLoop& real, double metres_per_pixel) {
  const std::vector<Patch> patches = patchesOf(real, metres_per_pixel);
  std::vector<double> means;
  for (const Patch& p : patches) means.push_back(p.mean);
  const double dark = quantileOf(means, 0.25), bright = quantileOf(means, 0.75);
  std::vector<double> along, across, of_dark, of_bright;
  for (const Patch& p : patches) {
    if (p.mean >= bright) of_bright.push_back(p.deviation);
    if (p.mean > dark) continue;
    along.push_back(p.along_m), across.push_back(p.across_rad), of_dark.push_back(p.deviation);
  }
  EchoSpread out;
  out.patches = static_cast<int>(patches.size());
  if (patches.empty()) return out;
  out.along_m = quantileOf(along, 0.25);
  out.across_rad = quantileOf(across, 0.25);
  const double greys_per_db =
      0.5 * (quantileOf(of_dark, 0.25) + quantileOf(of_bright, 0.25)) / kSpeckle_db;
  out.contrast_db =
      std::min((quantileOf(means, 0.9) - quantileOf(means, 0.1)) / greys_per_db, kMostContrast_db);
  out.prepare();
  return out;
}

}  // namespace echocine::echo
