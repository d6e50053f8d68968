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
constexpr std::size_t kPatchNumbers = 3 * kPatch, kPatchLanes = kPatchNumbers / kFloatLanes;
static_assert(kPatchNumbers % (2 * kFloatLanes) == 0 && sizeof(Vec3f) == 3 * sizeof(float));
constexpr float kMostSteps = 32767;

// Two lanes of a patch: those of the second in the upper halves.
struct TwoLanes {
  Floats8 first, second;
};
TwoLanes twoLanesAt(const std::uint32_t* from) {
  const Ints8 both = intsAt(from);
  return {__builtin_convertvector(both << 16 >> 16, Floats8),
          __builtin_convertvector(both >> 16, Floats8)};
}

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
  std::vector<std::size_t> first;  // point, by surface
  std::size_t points = 0;
  for (const std::vector<std::uint32_t>& of_surface : kept) {
    first.push_back(points);
    points += of_surface.size();
  }
  std::vector<Vec3f> off_m;  // by point, of each heart from the mean
  off_m.reserve(points * hearts.size());
  for (std::size_t s = 0; s < kept.size(); ++s) {
    std::vector<Vec3f>& mean_m = means_m_.emplace_back();
    for (const std::uint32_t v : kept[s]) {
      Vec3d sum;
      for (const SurfaceFrame* heart : hearts) sum = sum + toDouble(heart->positions_m[s][v]);
      mean_m.push_back(toFloat(per_heart * sum));
      for (const SurfaceFrame* heart : hearts)
        off_m.push_back(heart->positions_m[s][v] - mean_m.back());
    }
  }
  // motionModes() counts the sum over hearts.
  const MotionModes modes = motionModes(off_m, hearts.size(), kTolerance_m / std::sqrt(per_heart));
  count_ = modes.count;
  for (const std::vector<double>& row : modes.keyframe_from_mode)
    mode_of_heart_.insert(mode_of_heart_.end(), row.begin(), row.end());
  const auto modeAt = [&](std::size_t s, std::size_t v, std::size_t m) {
    return m == 0 ? means_m_[s][v] : modes.shapes_m[(first[s] + v) * count_ + m - 1];
  };
  const auto middleOf = [&](const SurfacePatch& patch, std::size_t m) {
    Vec3d sum;
    for (std::size_t v = patch.first; v < patch.end; ++v)
      sum = sum + toDouble(modeAt(patch.surface, v, m));
    return toFloat(1.0 / (patch.end - patch.first) * sum);
  };
  shapes_.reserve(patches_->size() * count_ * kPatchNumbers / 2);
  std::vector<Vec3f> middles_m;  // by patch, mean and mode
  std::vector<float> radii_m;
  for (const SurfacePatch& patch : *patches_) {
    for (std::size_t m = 0; m <= count_; ++m) {
      middles_m.push_back(middleOf(patch, m));
      float most_m = 0;
      for (const std::uint32_t v : patch.touched)
        most_m = std::max(most_m, length(modeAt(patch.surface, v, m) - middles_m.back()));
      radii_m.push_back(most_m);
    }
    addPatch(patch,
             std::span(modes.shapes_m).subspan((first[patch.surface] + patch.first) * count_));
  }
  middles_m_ = blocksOf(3 * patches_->size(), [&](std::size_t i, std::size_t m) {
    const Vec3f middle_m = middles_m[i / 3 * (count_ + 1) + m];
    return i % 3 == 0 ? middle_m.x : i % 3 == 1 ? middle_m.y : middle_m.z;
  });
  radii_m_ = blocksOf(patches_->size(),
                      [&](std::size_t p, std::size_t m) { return radii_m[p * (count_ + 1) + m]; });
}

// shapes_m: by vertex of the patch, then mode. The largest coordinate is kMostSteps steps.
void SurfaceModes::addPatch(const SurfacePatch& patch, std::span<const Vec3f> shapes_m) {
  const std::size_t vertices = patch.end - patch.first;
  for (std::size_t m = 0; m < count_; ++m) {
    float most_m = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
      const Vec3f p = shapes_m[v * count_ + m];
      most_m = std::max({most_m, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const float step_m = most_m / kMostSteps;
    steps_m_.push_back(step_m);
    const std::size_t begin = shapes_.size();
    shapes_.resize(begin + kPatchNumbers / 2, 0);
    if (step_m == 0) continue;
    for (std::size_t v = 0; v < vertices; ++v) {
      const Vec3f p = shapes_m[v * count_ + m];
      std::size_t i = 3 * v;
      for (const float number_m : {p.x, p.y, p.z}) {
        const auto steps = static_cast<std::uint16_t>(std::lround(number_m / step_m));
        const std::size_t lane = i / kFloatLanes;
        shapes_[begin + lane / 2 * kFloatLanes + i % kFloatLanes] |= std::uint32_t{steps}
                                                                     << (lane % 2 * 16);
        ++i;
      }
    }
  }
}

template <typename At>
SurfaceModes::Blocks SurfaceModes::blocksOf(std::size_t numbers, const At& at) const {
  const std::size_t block = kFloatLanes * (count_ + 1);
  Blocks blocks((numbers + kFloatLanes - 1) / kFloatLanes * block, 0);
  for (std::size_t i = 0; i < numbers; ++i)
    for (std::size_t m = 0; m <= count_; ++m)
      blocks[i / kFloatLanes * block + m * kFloatLanes + i % kFloatLanes] = at(i, m);
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

void SurfaceModes::sum(const Blocks& blocks, std::span<const float> factors,
                       std::span<float> out) const {
  const float* from = blocks.data();
  for (std::size_t i = 0; i < out.size(); i += kFloatLanes) {
    Floats8 sum{};
    for (const float factor : factors) {
      sum += factor * lanesAt(from);
      from += kFloatLanes;
    }
    storeSome(sum, out.size() - i, &out[i]);
  }
}

void SurfaceModes::blendPatch(std::size_t p, std::span<const float> factors,
                              std::vector<Vec3f>& out_m) const {
  const SurfacePatch& patch = (*patches_)[p];
  const std::size_t numbers = 3 * (patch.end - patch.first);
  const auto* const mean_m = reinterpret_cast<const float*>(&means_m_[patch.surface][patch.first]);
  Floats8 sums[kPatchLanes];
  for (std::size_t i = 0; i < kPatchLanes; ++i)
    sums[i] = i * kFloatLanes < numbers
                  ? someLanesAt(mean_m + i * kFloatLanes, numbers - i * kFloatLanes)
                  : Floats8{};
  const std::uint32_t* from = shapes_.data() + p * count_ * kPatchNumbers / 2;
  for (std::size_t m = 0; m < count_; ++m) {
    const float factor = factors[m + 1] * steps_m_[p * count_ + m];
    for (std::size_t i = 0; i < kPatchLanes; i += 2) {
      const TwoLanes two = twoLanesAt(from);
      sums[i] += factor * two.first;
      sums[i + 1] += factor * two.second;
      from += kFloatLanes;
    }
  }
  auto* const to = reinterpret_cast<float*>(&out_m[patch.first]);
  for (std::size_t i = 0; i * kFloatLanes < numbers; ++i)
    storeSome(sums[i], numbers - i * kFloatLanes, to + i * kFloatLanes);
}

SurfaceFrame SurfaceModes::blend(std::span<const float> shares) const {
  return blend(shares, std::vector<Side>(patches_->size(), Side::near));
}

SurfaceFrame SurfaceModes::blend(std::span<const float> shares, std::span<const Side> sides) const {
  CHECK_EQ(sides.size(), patches_->size());
  const std::vector<float> factors = factorsOf(shares);
  SurfaceFrame frame;
  for (const std::vector<Vec3f>& mean_m : means_m_) frame.positions_m.emplace_back(mean_m.size());
  for (std::size_t p = 0; p < sides.size(); ++p) {
    const SurfacePatch& patch = (*patches_)[p];
    std::vector<Vec3f>& out_m = frame.positions_m[patch.surface];
    if (sides[p] == Side::near)
      blendPatch(p, factors, out_m);
    else
      std::fill(out_m.begin() + patch.first, out_m.begin() + patch.end,
                Vec3f{0, sides[p] == Side::above ? 1.0f : -1.0f, 0});
  }
  return frame;
}

std::vector<SurfaceModes::Ball> SurfaceModes::balls(std::span<const float> shares) const {
  std::vector<float> factors = factorsOf(shares), numbers_m(3 * patches_->size()),
                     radii_m(patches_->size());
  sum(middles_m_, factors, numbers_m);
  for (float& factor : factors) factor = std::abs(factor);
  sum(radii_m_, factors, radii_m);
  std::vector<Ball> out;
  for (std::size_t p = 0; p < radii_m.size(); ++p)
    out.push_back(
        {{numbers_m[3 * p], numbers_m[3 * p + 1], numbers_m[3 * p + 2]}, kMargin_m + radii_m[p]});
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
