#include "fit/surface_modes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/box.h"
#include "core/check.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "motion/interior/motion_modes.h"
#include "motion/surfaces/probe_placement.h"

namespace echocine::fit {

namespace {

// Our choices. Omitted modes are far below a cell of labels and the width of a pulse; the margin is
// far above what they add up to. A patch is a few millimetres wide and fills whole lanes.
constexpr double kTolerance_m = 2e-6;
constexpr float kMargin_m = 2e-4f;
constexpr std::uint32_t kPatch = 16;
static_assert(3 * kPatch % kFloatLanes == 0 && sizeof(Vec3f) == 3 * sizeof(float));

}  // namespace

void orderByPlace(std::span<const Vec3f> places_m, std::vector<std::uint32_t>& vertices) {
  Box box;
  for (const std::uint32_t v : vertices) box.add(toDouble(places_m[v]));
  constexpr double kSteps = 1023;
  const double extent_m =
      std::max({box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z, 1e-9});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keyed;  // Morton code, vertex
  for (const std::uint32_t v : vertices) {
    const Vec3d at = kSteps / extent_m * (toDouble(places_m[v]) - box.lo);
    std::uint32_t code = 0;
    for (std::uint32_t bit = 0; bit < 10; ++bit)
      code |= (static_cast<std::uint32_t>(at.x) >> bit & 1) << (3 * bit) |
              (static_cast<std::uint32_t>(at.y) >> bit & 1) << (3 * bit + 1) |
              (static_cast<std::uint32_t>(at.z) >> bit & 1) << (3 * bit + 2);
    keyed.emplace_back(code, v);
  }
  std::sort(keyed.begin(), keyed.end());
  keyed.erase(std::unique(keyed.begin(), keyed.end()), keyed.end());
  vertices.clear();
  for (const auto& [code, v] : keyed) vertices.push_back(v);
}

SurfacePatches patchesOf(std::span<const SurfaceTopology> surfaces) {
  std::vector<SurfacePatch> patches;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const std::size_t first_patch = patches.size();
    for (std::uint32_t v = 0; v < surfaces[s].vertex_count; v += kPatch)
      patches.push_back({s, v, std::min(v + kPatch, surfaces[s].vertex_count), {}});
    for (const Triangle& t : surfaces[s].triangles)
      for (const std::uint32_t v : t) {
        std::vector<std::uint32_t>& touched = patches[first_patch + v / kPatch].touched;
        touched.insert(touched.end(), t.begin(), t.end());
      }
  }
  for (SurfacePatch& patch : patches) {
    std::sort(patch.touched.begin(), patch.touched.end());
    patch.touched.erase(std::unique(patch.touched.begin(), patch.touched.end()),
                        patch.touched.end());
  }
  return std::make_shared<const std::vector<SurfacePatch>>(std::move(patches));
}

SurfaceModes::SurfaceModes(std::span<const SurfaceFrame* const> hearts,
                           const std::vector<std::vector<std::uint32_t>>& kept,
                           SurfacePatches patches)
    : patches_(std::move(patches)) {
  const auto per_heart = 1 / static_cast<double>(hearts.size());
  std::vector<Vec3f> means_m, off_m;
  std::vector<std::size_t> first;  // by surface
  for (std::size_t s = 0; s < kept.size(); ++s) {
    first.push_back(means_m.size());
    vertices_.push_back(kept[s].size());
    for (const std::uint32_t v : kept[s]) {
      Vec3d sum;
      for (const SurfaceFrame* heart : hearts) sum = sum + toDouble(heart->positions_m[s][v]);
      means_m.push_back(toFloat(per_heart * sum));
      for (const SurfaceFrame* heart : hearts)
        off_m.push_back(heart->positions_m[s][v] - means_m.back());
    }
  }
  // motionModes() counts the sum over hearts.
  const MotionModes modes = motionModes(off_m, hearts.size(), kTolerance_m / std::sqrt(per_heart));
  count_ = modes.count;
  for (const std::vector<double>& row : modes.keyframe_from_mode)
    mode_of_heart_.insert(mode_of_heart_.end(), row.begin(), row.end());
  const auto modeAt = [&](std::size_t point, std::size_t m) {
    return m == 0 ? means_m[point] : modes.shapes_m[point * count_ + m - 1];
  };
  for (std::size_t s = 0; s < kept.size(); ++s)
    surfaces_m_.push_back(blocksOf(
        kept[s].size(), [&](std::size_t v, std::size_t m) { return modeAt(first[s] + v, m); }));
  const auto middleOf = [&](const SurfacePatch& patch, const auto& at) {
    Vec3d sum;
    for (std::size_t v = patch.first; v < patch.end; ++v)
      sum = sum + toDouble(at(first[patch.surface] + v));
    return toFloat(1.0 / (patch.end - patch.first) * sum);
  };
  middles_m_ = blocksOf(patches_->size(), [&](std::size_t p, std::size_t m) {
    return middleOf((*patches_)[p], [&](std::size_t point) { return modeAt(point, m); });
  });
  for (const SurfacePatch& patch : *patches_)
    for (std::size_t m = 0; m <= count_; ++m) {
      const auto at = [&](std::size_t point) { return modeAt(point, m); };
      const Vec3f middle_m = middleOf(patch, at);
      float most_m = 0;
      for (const std::uint32_t v : patch.touched)
        most_m = std::max(most_m, length(at(first[patch.surface] + v) - middle_m));
      radii_m_.push_back(most_m);
    }
}

template <typename At>
SurfaceModes::Blocks SurfaceModes::blocksOf(std::size_t points, const At& at) const {
  const std::size_t block = kFloatLanes * (count_ + 1);
  Blocks blocks((3 * points + kFloatLanes - 1) / kFloatLanes * block, 0);
  for (std::size_t point = 0; point < points; ++point)
    for (std::size_t m = 0; m <= count_; ++m) {
      const Vec3f p = at(point, m);
      std::size_t i = 3 * point;
      for (const float number : {p.x, p.y, p.z}) {
        blocks[i / kFloatLanes * block + m * kFloatLanes + i % kFloatLanes] = number;
        ++i;
      }
    }
  return blocks;
}

// Factor of the mean, then those of the modes.
std::vector<float> SurfaceModes::factorsOf(std::span<const float> shares) const {
  CHECK_EQ(shares.size() * count_, mode_of_heart_.size());
  std::vector<float> factors{1};
  for (std::size_t m = 0; m < count_; ++m) {
    double sum = 0;
    for (std::size_t n = 0; n < shares.size(); ++n)
      sum += static_cast<double>(shares[n]) * mode_of_heart_[n * count_ + m];
    factors.push_back(static_cast<float>(sum));
  }
  return factors;
}

// first: of the points of `blocks`, at the beginning of a block.
void SurfaceModes::sum(const Blocks& blocks, std::span<const float> factors, std::size_t first,
                       std::span<Vec3f> out_m) const {
  const float* from = blocks.data() + 3 * first * factors.size();
  const std::size_t numbers = 3 * out_m.size();
  auto* const to = reinterpret_cast<float*>(out_m.data());
  for (std::size_t i = 0; i < numbers; i += kFloatLanes) {
    Floats8 sum{};
    for (const float factor : factors) {
      sum += factor * lanesAt(from);
      from += kFloatLanes;
    }
    storeSome(sum, numbers - i, to + i);
  }
}

SurfaceFrame SurfaceModes::blend(std::span<const float> shares) const {
  return blend(shares, std::vector<Side>(patches_->size(), Side::near));
}

SurfaceFrame SurfaceModes::blend(std::span<const float> shares, std::span<const Side> sides) const {
  CHECK_EQ(sides.size(), patches_->size());
  const std::vector<float> factors = factorsOf(shares);
  SurfaceFrame frame;
  for (const std::size_t vertices : vertices_) frame.positions_m.emplace_back(vertices);
  for (std::size_t p = 0, end = 0; p < sides.size(); p = end) {
    const SurfacePatch& patch = (*patches_)[p];
    const auto joins = [&](std::size_t other) {
      return sides[other] == sides[p] && (*patches_)[other].surface == patch.surface;
    };
    for (end = p + 1; end < sides.size() && joins(end);) ++end;
    const auto out_m = std::span(frame.positions_m[patch.surface])
                           .subspan(patch.first, (*patches_)[end - 1].end - patch.first);
    if (sides[p] == Side::near)
      sum(surfaces_m_[patch.surface], factors, patch.first, out_m);
    else
      std::fill(out_m.begin(), out_m.end(), Vec3f{0, sides[p] == Side::above ? 1.0f : -1.0f, 0});
  }
  return frame;
}

std::vector<SurfaceModes::Ball> SurfaceModes::balls(std::span<const float> shares) const {
  const std::vector<float> factors = factorsOf(shares);
  std::vector<Vec3f> middles_m(patches_->size());
  sum(middles_m_, factors, 0, middles_m);
  std::vector<Ball> out;
  const float* radius_m = radii_m_.data();
  for (const Vec3f middle_m : middles_m) {
    float sum_m = kMargin_m;
    for (const float factor : factors) sum_m += std::abs(factor) * *radius_m++;
    out.push_back({middle_m, sum_m});
  }
  return out;
}

std::vector<SurfaceFrame> blendNearPlane(std::span<const SurfaceModes> frames,
                                         std::span<const float> shares, const PlaneTilt& tilt) {
  using Side = SurfaceModes::Side;
  const Pose pose = turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad);
  const auto tilted = [&](Vec3f p) { return toFloat(pose.fromWorld(toDouble(p))); };
  std::vector<std::vector<Side>> own(frames.size());
  parallelBlocks(frames.size(), 1, [&](std::size_t f, std::size_t) {
    for (const SurfaceModes::Ball& ball : frames[f].balls(shares)) {
      const float y = tilted(ball.middle_m).y;
      own[f].push_back(y > ball.radius_m    ? Side::above
                       : y < -ball.radius_m ? Side::below
                                            : Side::near);
    }
  });
  std::vector<SurfaceFrame> out(frames.size());
  parallelBlocks(frames.size(), 1, [&](std::size_t f, std::size_t) {
    std::vector<Side> sides = own[f];
    // Pieces of the frame before take their motion from here.
    const std::vector<Side>& before = own[(f + frames.size() - 1) % frames.size()];
    for (std::size_t p = 0; p < sides.size(); ++p)
      if (before[p] == Side::near) sides[p] = Side::near;
    out[f] = frames[f].blend(shares, sides);
    if (tilt.rotate_rad == 0 && tilt.tilt_rad == 0) return;
    for (std::size_t p = 0; p < sides.size(); ++p) {
      if (sides[p] != Side::near) continue;
      const SurfacePatch& patch = frames[f].patches()[p];
      std::vector<Vec3f>& positions_m = out[f].positions_m[patch.surface];
      for (std::size_t v = patch.first; v < patch.end; ++v) positions_m[v] = tilted(positions_m[v]);
    }
  });
  return out;
}

}  // namespace echocine::fit
