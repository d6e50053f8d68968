#include "fit/surface_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/check.h"
#include "core/lanes.h"
#include "motion/interior/motion_modes.h"

namespace echocine::fit {

namespace {

// Our choices. Omitted modes are far below a cell of labels and the width of a pulse; the margin is
// far above what they add up to.
constexpr double kTolerance_m = 2e-6;
constexpr float kMargin_m = 2e-4f;
constexpr std::size_t kPatchNumbers = 3 * kPatch, kPatchLanes = kPatchNumbers / kFloatLanes;
static_assert(kPatchNumbers % (6 * kFloatLanes) == 0 && sizeof(Vec3f) == 3 * sizeof(float));
// A mode that moves no vertex of a patch by more is omitted there: a heart has about a tenth of
// each mode.
constexpr float kLeast_m = 1e-5f;
// Coordinates that are packed together: two of 16 bits, or three of 10 with steps of up to 4
// micrometres.
constexpr int kWide = 2, kNarrow = 3;
constexpr int packedBits(int together) {
  return 32 / together;
}
constexpr int mostSteps(int together) {
  return (1 << (packedBits(together) - 1)) - 1;
}
constexpr float kMostNarrow_m = 4e-6f * mostSteps(kNarrow);

using PatchLanes = std::array<Floats8, kPatchLanes>;

// Appends the coordinates of a patch in steps, up to mostSteps() of them.
void pack(const std::array<float, kPatchNumbers>& numbers_m, float step_m, int together,
          std::vector<std::uint32_t>& out) {
  const auto count = static_cast<std::size_t>(together),
             bits = static_cast<std::size_t>(packedBits(together)), begin = out.size();
  out.resize(begin + kPatchNumbers / count, 0);
  for (std::size_t i = 0; i < kPatchNumbers; ++i) {
    const auto steps = static_cast<std::uint32_t>(std::lround(numbers_m[i] / step_m));
    const std::size_t lane = i / kFloatLanes;
    out[begin + lane / count * kFloatLanes + i % kFloatLanes] |= (steps & ((1u << bits) - 1))
                                                                 << (lane % count * bits);
  }
}

// Adds packed coordinates times a factor, and returns the end of them.
template <int kTogether>
const std::uint32_t* addPacked(const std::uint32_t* from, float factor, PatchLanes& sums) {
  constexpr int kBits = packedBits(kTogether);
  for (std::size_t i = 0; i < kPatchLanes; i += kTogether, from += kFloatLanes) {
    const Ints8 packed = intsAt(from);
    for (int lane = 0; lane < kTogether; ++lane)
      sums[i + static_cast<std::size_t>(lane)] +=
          factor *
          __builtin_convertvector(packed << (32 - kBits * (lane + 1)) >> (32 - kBits), Floats8);
  }
  return from;
}

}  // namespace

SurfaceModes::SurfaceModes(std::span<const SurfaceFrame* const> hearts,
                           const std::vector<std::vector<std::uint32_t>>& kept,
                           SurfacePatches patches,
                           const std::vector<std::vector<double>>& at_places)
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
  const MotionModes modes =
      motionModes(off_m, hearts.size(), kTolerance_m / std::sqrt(per_heart), at_places);
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
  parts_.reserve(patches_->size());
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

// shapes_m: by vertex of the patch, then mode.
void SurfaceModes::addPatch(const SurfacePatch& patch, std::span<const Vec3f> shapes_m) {
  std::vector<std::array<float, kPatchNumbers>> numbers_m(count_);
  std::vector<float> most_m(count_, 0);
  for (std::size_t m = 0; m < count_; ++m)
    for (std::size_t v = 0; v < patch.end - patch.first; ++v) {
      const Vec3f p = shapes_m[v * count_ + m];
      std::memcpy(&numbers_m[m][3 * v], &p, sizeof p);
      most_m[m] = std::max({most_m[m], std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  const auto addTerms = [&](int together) {
    for (std::uint32_t m = 0; m < count_; ++m) {
      if (most_m[m] < kLeast_m || (most_m[m] > kMostNarrow_m) != (together == kWide)) continue;
      terms_.push_back({m, most_m[m] / static_cast<float>(mostSteps(together))});
      pack(numbers_m[m], terms_.back().step_m, together, shapes_);
    }
    return terms_.size();
  };
  Part& part = parts_.emplace_back(Part{shapes_.size(), terms_.size(), 0, 0});
  part.narrow = addTerms(kWide);
  part.end = addTerms(kNarrow);
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
  PatchLanes sums;
  for (std::size_t i = 0; i < kPatchLanes; ++i)
    sums[i] = i * kFloatLanes < numbers
                  ? someLanesAt(mean_m + i * kFloatLanes, numbers - i * kFloatLanes)
                  : Floats8{};
  const Part& part = parts_[p];
  const std::uint32_t* from = shapes_.data() + part.shapes;
  const auto factorOf = [&](std::size_t term) {
    return factors[terms_[term].mode + 1] * terms_[term].step_m;
  };
  for (std::size_t t = part.first; t < part.narrow; ++t)
    from = addPacked<kWide>(from, factorOf(t), sums);
  for (std::size_t t = part.narrow; t < part.end; ++t)
    from = addPacked<kNarrow>(from, factorOf(t), sums);
  auto* const to = reinterpret_cast<float*>(&out_m[patch.first]);
  for (std::size_t i = 0; i * kFloatLanes < numbers; ++i)
    storeSome(sums[i], numbers - i * kFloatLanes, to + i * kFloatLanes);
}

SurfaceFrame SurfaceModes::blend(std::span<const float> shares) const {
  SurfaceFrame frame;
  blend(shares, std::vector<char>(patches_->size(), 1), frame);
  return frame;
}

void SurfaceModes::blend(std::span<const float> shares, std::span<const char> wanted,
                         SurfaceFrame& frame) const {
  CHECK_EQ(wanted.size(), patches_->size());
  const std::vector<float> factors = factorsOf(shares);
  frame.positions_m.resize(means_m_.size());
  for (std::size_t s = 0; s < means_m_.size(); ++s) frame.positions_m[s].resize(means_m_[s].size());
  for (std::size_t p = 0; p < wanted.size(); ++p)
    if (wanted[p] != 0) blendPatch(p, factors, frame.positions_m[(*patches_)[p].surface]);
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

}  // namespace echocine::fit
