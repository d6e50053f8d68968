#include "speckle/block_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "speckle/sector_box.h"

namespace echocine {

namespace {

constexpr double kMostScatterers = 5e7;  // 0.3 GB. Our choice
constexpr double kMostBlocks = 2e7;      // looked at; under a second. Our choice
constexpr std::size_t kMostKept = 3e6;   // of these, 0.3 GB. Our choice
constexpr auto kBetween_m = static_cast<double>(kBetweenInstants_m);
constexpr std::size_t kBlocksTogether = 64;  // in a task. Our choice
constexpr std::uint8_t kAllCubes = 255;

constexpr std::uint64_t kBlockPattern = 1;  // purpose of the hashed number

// Numbers of blocks.
struct BlockRange {
  int begin, end;
  double count() const { return std::max(end - begin, 0); }
};
BlockRange blocksOver(SectorBox::Range range, float origin_m, float edge_m) {
  const double origin = static_cast<double>(origin_m), edge = static_cast<double>(edge_m);
  const auto number = [](double at) { return static_cast<int>(std::clamp(at, -1e9, 1e9)); };
  return {number(std::floor((range.low_m - origin) / edge)),
          number(std::ceil((range.high_m - origin) / edge))};
}

double pathOf(const Probe& probe, Vec3d p) {
  return !probe.isFan() ? p.z : std::hypot(p.x, p.z) - probe.face_radius_m;
}

// Blocks within the largest motion of any tissue.
class BlockSearch {
 public:
  BlockSearch(const Probe& probe, const PointSpread& spread, const BeamView& view,
              const SpeckleSettings& settings, const Material& material)
      : probe_(probe),
        spread_(spread),
        view_(view),
        settings_(settings),
        material_(material),
        lattice_(material.lattice()),
        edge_m_(static_cast<double>(lattice_.block_m)),
        across_m_(material.reachAcross_m()),
        ball_m_(edge_m_ * std::numbers::sqrt2 / 2 + material.reachAlong_m()) {}

  std::vector<TissueBlock> search() {
    findBlocks();
    markSeen();
    std::erase_if(blocks_, [](const TissueBlock& block) {
      return std::ranges::none_of(block.parts, [](const BlockPart& p) { return p.seen != 0; });
    });
    refuseTooMany();
    return std::move(blocks_);
  }

 private:
  SceneError tooLarge(double number) const {
    return SceneError(fmt::format(
        "[speckle]: the sector and the tissue that moves into it need over {:.0f} blocks of {:.2g} "
        "mm, the memory limit: use a smaller sector (probe.depth_mm, probe.face_radius_mm)",
        number, edge_m_ * 1e3));
  }
  void findBlocks();
  void addIfNear(int ix, int iy, int iz, std::vector<TissueBlock>& blocks) const;
  void findParts(std::vector<TissueBlock>& blocks) const;
  bool movesIntoView(Vec3f low_m, std::uint16_t group) const;
  void markSeen();
  void lookAt(const MaterialFrame& tissue, TissueBlock& block) const;
  void refuseTooMany() const;

  const Probe& probe_;
  const PointSpread& spread_;
  const BeamView& view_;
  const SpeckleSettings& settings_;
  const Material& material_;
  const CubeLattice lattice_;
  const double edge_m_;
  const double across_m_, ball_m_;  // reach of a block's tissue across the plane and in it
  std::vector<TissueBlock> blocks_;
};

// Slab by slab, so that blocks beyond the motion of their own tissue are never many.
void BlockSearch::findBlocks() {
  const double deepest_m =
      std::min(probe_.face_radius_m + probe_.max_depth_m, probe_.max_depth_m + 2 * ball_m_);
  const double half_y_m = across_m_ + kElevationCut * std::max(spread_.elevationWidth(0),
                                                               spread_.elevationWidth(deepest_m));
  const SectorBox box = sectorBox(probe_, ball_m_, material_.reachAlong_m(), edge_m_);
  const BlockRange xs = blocksOver(box.x, lattice_.origin_m.x, lattice_.block_m);
  const BlockRange ys = blocksOver({-half_y_m, half_y_m}, lattice_.origin_m.y, lattice_.block_m);
  const BlockRange zs = blocksOver(box.z, lattice_.origin_m.z, lattice_.block_m);
  if (xs.count() * ys.count() * zs.count() > kMostBlocks) throw tooLarge(kMostBlocks);
  std::vector<TissueBlock> slab;
  for (int iz = zs.begin; iz < zs.end; ++iz) {
    slab.clear();
    for (int iy = ys.begin; iy < ys.end; ++iy) {
      checkpoint();
      for (int ix = xs.begin; ix < xs.end; ++ix) addIfNear(ix, iy, iz, slab);
    }
    findParts(slab);
    std::ranges::move(slab, std::back_inserter(blocks_));
    if (blocks_.size() > kMostKept) throw tooLarge(kMostKept);
  }
}

void BlockSearch::addIfNear(int ix, int iy, int iz, std::vector<TissueBlock>& blocks) const {
  const Vec3f low =
      lattice_.origin_m + lattice_.block_m * Vec3f{static_cast<float>(ix), static_cast<float>(iy),
                                                   static_cast<float>(iz)};
  const Vec3d middle = toDouble(low) + 0.5 * edge_m_ * Vec3d{1, 1, 1};
  if (!view_.sees(Extent{middle.x, middle.z, ball_m_, middle.y - 0.5 * edge_m_ - across_m_,
                         middle.y + 0.5 * edge_m_ + across_m_}))
    return;
  const double wanted =
      settings_.per_cell * edge_m_ * edge_m_ * edge_m_ / spread_.cellVolume(pathOf(probe_, middle));
  blocks.push_back(
      {low, lattice_.block_m, hashOf(settings_.seed, kBlockPattern, ix, iy, iz), wanted, {}});
}

// The groups of each block whose own motion may bring them into view.
void BlockSearch::findParts(std::vector<TissueBlock>& blocks) const {
  parallelBlocks(blocks.size(), kBlocksTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (const std::uint16_t group : material_.groupsIn(blocks[b].low_m))
        if (movesIntoView(blocks[b].low_m, group)) blocks[b].parts.push_back({group, 0});
  });
  std::erase_if(blocks, [](const TissueBlock& block) { return block.parts.empty(); });
}

// Whether what moves with the block may be seen at an instant that lookAt() tests: false only where
// that would leave out all of it. A disc that holds every disc about a part of the moved block has
// the sum of the half edges for its radius. Behind the probe angles wrap, and nothing is left out.
bool BlockSearch::movesIntoView(Vec3f low_m, std::uint16_t group) const {
  constexpr double kRounding_m = 1e-4;  // of angles, to 1e-4 rad at a sector's end, and of floats
  const Box moves = material_.movesOver(low_m, group);
  const Vec3d low = toDouble(low_m) + moves.lo,
              high = toDouble(low_m) + Vec3d{edge_m_, edge_m_, edge_m_} + moves.hi;
  const Vec3d middle = 0.5 * (low + high), half = 0.5 * (high - low);
  if (middle.z <= 0) return true;
  const double margin_m = kBetween_m + kRounding_m;
  return view_.sees(
      Extent{middle.x, middle.z, half.x + half.z + margin_m, low.y - margin_m, high.y + margin_m});
}

void BlockSearch::markSeen() {
  bool looked = false;
  material_.overTheBeat([&](const MaterialFrame& tissue) {
    looked = true;
    parallelBlocks(blocks_.size(), kBlocksTogether, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) lookAt(tissue, blocks_[b]);
    });
  });
  if (looked) return;
  for (TissueBlock& block : blocks_)
    for (BlockPart& part : block.parts) part.seen = kAllCubes;
}

void BlockSearch::lookAt(const MaterialFrame& tissue, TissueBlock& block) const {
  for (BlockPart& part : block.parts) {
    const bool coarse = material_.coarse(part.group);
    const float edge_m = coarse ? block.edge_m : 0.5f * block.edge_m;
    for (std::uint32_t cube = 0; cube < (coarse ? 1u : 8u); ++cube) {
      if (part.seen >> cube & 1) continue;
      const Vec3f low_m = block.low_m + cubeOffset(cube, edge_m);
      if (view_.sees(extentOf(tissue.corners(part.group, low_m, edge_m), kBetween_m)))
        part.seen = static_cast<std::uint8_t>(part.seen | 1u << cube);
    }
  }
}

void BlockSearch::refuseTooMany() const {
  double planned = 0;
  for (const TissueBlock& block : blocks_) planned += block.wanted;
  if (planned > kMostScatterers)
    throw SceneError(fmt::format(
        "speckle.per_cell = {:g} needs over {:g} scatterers at {:g} MHz, the memory limit: use a "
        "lower value or a lower probe.frequency_mhz",
        settings_.per_cell, kMostScatterers, 1e-6 * probe_.frequency_hz));
}

}  // namespace

Vec3f cubeOffset(std::uint32_t cube, float edge_m) {
  return {cube & 1 ? edge_m : 0, cube & 2 ? edge_m : 0, cube & 4 ? edge_m : 0};
}

std::uint32_t halfOf(const TissueBlock& block, Vec3f place_m) {
  const float half_m = 0.5f * block.edge_m;
  const Vec3f in = place_m - block.low_m;
  return (in.x >= half_m) + 2u * (in.y >= half_m) + 4u * (in.z >= half_m);
}

bool TissueBlock::seesHalf(std::uint32_t half, const Material& material) const {
  return std::ranges::any_of(parts, [&](const BlockPart& part) {
    return (part.seen >> (material.coarse(part.group) ? 0 : half) & 1) != 0;
  });
}

bool TissueBlock::sees(std::uint16_t group, std::uint32_t cube) const {
  const auto part =
      std::ranges::find_if(parts, [&](const BlockPart& p) { return p.group == group; });
  return part != parts.end() && (part->seen >> cube & 1) != 0;
}

std::vector<TissueBlock> searchBlocks(const Probe& probe, const PointSpread& spread,
                                      const BeamView& view, const SpeckleSettings& settings,
                                      const Material& material) {
  return BlockSearch(probe, spread, view, settings, material).search();
}

}  // namespace echocine
