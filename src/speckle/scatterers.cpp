#include "speckle/scatterers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "speckle/sector_box.h"

namespace echocine {

namespace {

constexpr double kMostScatterers = 5e7;      // 0.3 GB. Our choice
constexpr double kMostBlocks = 2e7;          // looked at; under a second. Our choice
constexpr std::size_t kMostKept = 3e6;       // of these, 0.3 GB. Our choice
constexpr double kBetweenInstants_m = 2e-3;  // tissue moves less to the nearest instant looked at

// Purposes of hashed numbers.
enum : std::uint64_t { kPlaces = 1, kCount = 2, kGauss = 3, kBatch = 4 };

// Point j of an additive sequence in a cube, shifted by a hash: even at any count (Roberts' R3).
Vec3f pointIn(std::uint64_t hash, std::uint32_t j) {
  constexpr double kSteps[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const auto along = [&](int axis) {
    const double start = uniformFromHash(hashOf(hash, axis));
    // The jitter keeps neighbours from the sequence's lattice: a grating would show.
    const double jitter = 0.35 * uniformFromHash(hashOf(hash, j, axis + 3)) / std::cbrt(j + 1.0);
    const double at = start + kSteps[axis] * (j + 1.0) + jitter;
    return static_cast<float>(at - std::floor(at));
  };
  return {along(0), along(1), along(2)};
}

Vec3f placeInCube(const EightPlaces& eight, std::size_t lane) {
  constexpr float kOfEdge = 1.0f / kCubeEdge;
  return kOfEdge * Vec3f{static_cast<float>(eight.u[lane]), static_cast<float>(eight.v[lane]),
                         static_cast<float>(eight.w[lane])};
}

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

// Whether what moves with the block may be seen at an instant that dropUnseen() looks at: false
// only where that would drop all of it. A disc that holds every disc about a part of the moved
// block has the sum of the half edges for its radius. Behind the probe angles wrap, and nothing is
// left out.
bool movesIntoView(const BeamView& view, const Material& material, Vec3f low_m, double edge_m) {
  constexpr double kRounding_m = 1e-4;  // of angles, to 1e-4 rad at a sector's end, and of floats
  const Box moves = material.movesOver(low_m);
  const Vec3d low = toDouble(low_m) + moves.lo,
              high = toDouble(low_m) + Vec3d{edge_m, edge_m, edge_m} + moves.hi;
  const Vec3d middle = 0.5 * (low + high), half = 0.5 * (high - low);
  if (middle.z <= 0) return true;
  const double margin_m = kBetweenInstants_m + kRounding_m;
  return view.sees(
      Extent{middle.x, middle.z, half.x + half.z + margin_m, low.y - margin_m, high.y + margin_m});
}

double pathOf(const Probe& probe, Vec3d p) {
  return !probe.isFan() ? p.z : std::hypot(p.x, p.z) - probe.face_radius_m;
}

}  // namespace

GaussianTable::GaussianTable(int seed)
    : real_(kStarts + kMostOfBatch + kFloatLanes), imaginary_(real_.size()) {
  for (std::vector<float>* part : {&real_, &imaginary_}) {
    const std::uint64_t purpose = kGauss + (part == &real_ ? 16 : 32);
    double sum = 0, squares = 0;
    std::vector<double> drawn(kStarts);
    for (std::uint32_t i = 0; i < kStarts; ++i) {
      drawn[i] = normalFromHashes(hashOf(seed, purpose, i, 0), hashOf(seed, purpose, i, 1));
      sum += drawn[i];
      squares += drawn[i] * drawn[i];
    }
    const double mean = sum / kStarts;
    const double scale = 1 / std::sqrt(2 * (squares / kStarts - mean * mean));
    for (std::size_t i = 0; i < part->size(); ++i)
      (*part)[i] = static_cast<float>((drawn[i % kStarts] - mean) * scale);
  }
}

struct Scatterers::Block {
  Vec3f low_m;
  float edge_m = 0;
  std::uint64_t pattern = 0;
  double wanted = 0;  // scatterers, before they are whole
  std::vector<Vec3f> places_m;
  std::vector<std::uint16_t> groups;
};

// Blocks of tissue that beams may reach at some instant.
std::vector<Scatterers::Block> Scatterers::blocksInReach(const Probe& probe,
                                                         const PointSpread& spread,
                                                         const BeamView& view,
                                                         const SpeckleSettings& settings,
                                                         const Material& material) {
  const CubeLattice lattice = material.lattice();
  const double edge_m = static_cast<double>(lattice.block_m);
  const double along_m = material.reachAlong_m(), across_m = material.reachAcross_m();
  const double ball_m = edge_m * std::numbers::sqrt2 / 2 + along_m;
  const double half_y_m =
      across_m + kElevationCut *
                     std::max(spread.elevationWidth(0), spread.elevationWidth(std::min(
                                                            probe.face_radius_m + probe.max_depth_m,
                                                            probe.max_depth_m + 2 * ball_m)));
  const SectorBox box = sectorBox(probe, ball_m, along_m, edge_m);
  const BlockRange xs = blocksOver(box.x, lattice.origin_m.x, lattice.block_m);
  const BlockRange ys = blocksOver({-half_y_m, half_y_m}, lattice.origin_m.y, lattice.block_m);
  const BlockRange zs = blocksOver(box.z, lattice.origin_m.z, lattice.block_m);
  const auto tooLarge = [&](double number) {
    return SceneError(fmt::format(
        "[speckle]: the sector and the tissue that moves into it need over {:.0f} blocks of {:.2g} "
        "mm, the memory limit: use a smaller sector (probe.depth_mm, probe.face_radius_mm)",
        number, edge_m * 1e3));
  };
  if (xs.count() * ys.count() * zs.count() > kMostBlocks) throw tooLarge(kMostBlocks);
  std::vector<Block> blocks;
  double planned = 0;
  for (int iz = zs.begin; iz < zs.end; ++iz)
    for (int iy = ys.begin; iy < ys.end; ++iy) {
      checkpoint();
      for (int ix = xs.begin; ix < xs.end; ++ix) {
        const Vec3f low = lattice.origin_m + lattice.block_m * Vec3f{static_cast<float>(ix),
                                                                     static_cast<float>(iy),
                                                                     static_cast<float>(iz)};
        const Vec3d middle = toDouble(low) + 0.5 * edge_m * Vec3d{1, 1, 1};
        if (!view.sees(Extent{middle.x, middle.z, ball_m, middle.y - 0.5 * edge_m - across_m,
                              middle.y + 0.5 * edge_m + across_m}))
          continue;
        if (!movesIntoView(view, material, low, edge_m)) continue;
        const double wanted =
            settings.per_cell * edge_m * edge_m * edge_m / spread.cellVolume(pathOf(probe, middle));
        planned += wanted;
        if (planned > kMostScatterers)
          throw SceneError(
              fmt::format("speckle.per_cell = {:g} needs over {:g} scatterers, the memory limit: "
                          "use a lower value",
                          settings.per_cell, kMostScatterers));
        if (blocks.size() == kMostKept) throw tooLarge(kMostKept);
        blocks.push_back(
            {low, lattice.block_m, hashOf(settings.seed, kPlaces, ix, iy, iz), wanted, {}, {}});
      }
    }
  return blocks;
}

Scatterers::Scatterers(const Probe& probe, const PointSpread& spread, const BeamView& view,
                       const SpeckleSettings& settings, const Material& material) {
  std::vector<Block> blocks = blocksInReach(probe, spread, view, settings, material);
  parallelBlocks(blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Block& block = blocks[b];
      block.places_m.resize(
          static_cast<std::size_t>(block.wanted + uniformFromHash(hashOf(block.pattern, kCount))));
      for (std::uint32_t j = 0; j < block.places_m.size(); ++j)
        block.places_m[j] = block.low_m + block.edge_m * pointIn(block.pattern, j);
      block.groups.resize(block.places_m.size());
      material.groupsAt(block.places_m, block.groups);
    }
  });
  for (const Block& block : blocks) {
    checkpoint();
    addBlock(block, material);
  }
  dropUnseen(view, material);
  for (const EightPlaces& eight : places_)
    highest_.push_back(*std::max_element(std::begin(eight.v), std::end(eight.v)));
  weigh(material);
}

void Scatterers::weigh(const Material& material) {
  if (!material.differs()) return;
  strength_.assign(places_.size() * kFloatLanes, 1);
  parallelBlocks(batches_.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3f> places_m;
    for (std::size_t n = begin; n < end; ++n) {
      const ScattererBatch& b = batches_[n];
      places_m.clear();
      for (std::uint32_t i = b.first; i < b.first + b.count; ++i)
        places_m.push_back(b.low_m +
                           b.edge_m * placeInCube(places_[i / kFloatLanes], i % kFloatLanes));
      material.amplitudes(places_m, b.group, std::span(strength_).subspan(b.first, b.count));
    }
  });
}

// Leaves out what no beam reaches at any instant: most tissue beside the plane does not move far.
void Scatterers::dropUnseen(const BeamView& view, const Material& material) {
  bool looked = false;
  std::vector<bool> seen(batches_.size());
  material.overTheBeat([&](const MaterialFrame& tissue) {
    looked = true;
    for (std::size_t b = 0; b < batches_.size(); ++b) {
      if (b % 4096 == 0) checkpoint();
      seen[b] = seen[b] || view.sees(extentOf(tissue.corners(batches_[b].group, batches_[b].low_m,
                                                             batches_[b].edge_m),
                                              kBetweenInstants_m));
    }
  });
  if (!looked) return;
  std::vector<ScattererBatch> all;
  std::vector<EightPlaces> places;
  std::swap(all, batches_);
  std::swap(places, places_);
  count_ = 0;
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (!seen[b]) continue;
    const auto from = places.begin() + static_cast<std::ptrdiff_t>(eightOf(all[b]));
    all[b].first = static_cast<std::uint32_t>(places_.size() * kFloatLanes);
    places_.insert(places_.end(), from, from + (all[b].count + kFloatLanes - 1) / kFloatLanes);
    count_ += all[b].count;
    batches_.push_back(all[b]);
  }
  places_.shrink_to_fit();
}

// By group and half block: small cubes are left out sooner. Points of a cube ascend across the
// imaging plane, so that those beyond the beam are contiguous.
void Scatterers::addBlock(const Block& block, const Material& material) {
  std::map<std::uint32_t, std::vector<Vec3f>> parts;
  const float half_m = 0.5f * block.edge_m;
  for (std::size_t i = 0; i < block.places_m.size(); ++i) {
    const Vec3f in = block.places_m[i] - block.low_m;
    const std::uint32_t half =
        material.coarse(block.groups[i])
            ? 0
            : (in.x >= half_m) + 2u * (in.y >= half_m) + 4u * (in.z >= half_m);
    parts[8u * block.groups[i] + half].push_back(block.places_m[i]);
  }
  for (auto& part : parts) {
    const std::uint32_t key = part.first;
    std::vector<Vec3f>& places_m = part.second;
    std::sort(places_m.begin(), places_m.end(), [](Vec3f a, Vec3f b) { return a.y < b.y; });
    const auto group = static_cast<std::uint16_t>(key / 8);
    const float edge_m = material.coarse(group) ? block.edge_m : half_m;
    const auto offset = [&](std::uint32_t bit) { return key & bit ? half_m : 0.0f; };
    for (std::size_t first = 0; first < places_m.size(); first += kMostOfBatch)
      addBatch(std::span<const Vec3f>(places_m).subspan(
                   first, std::min<std::size_t>(kMostOfBatch, places_m.size() - first)),
               block.low_m + Vec3f{offset(1), offset(2), offset(4)}, edge_m, group,
               material.blood(group), hashOf(block.pattern, kBatch, key, first));
  }
}

void Scatterers::addBatch(std::span<const Vec3f> places_m, Vec3f low_m, float edge_m,
                          std::uint16_t group, bool blood, std::uint64_t pattern) {
  batches_.push_back({low_m, edge_m, static_cast<std::uint32_t>(places_.size() * kFloatLanes),
                      static_cast<std::uint32_t>(places_m.size()), group, blood, pattern});
  count_ += places_m.size();
  const auto stepsOf = [&](float along_m) {
    return static_cast<std::uint16_t>(
        std::lround(std::clamp(along_m / edge_m, 0.0f, 1.0f) * static_cast<float>(kCubeEdge)));
  };
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    const std::size_t lane = i % kFloatLanes;
    if (lane == 0) places_.push_back({});
    const Vec3f in_m = places_m[i] - low_m;
    places_.back().u[lane] = stepsOf(in_m.x);
    places_.back().v[lane] = stepsOf(in_m.y);
    places_.back().w[lane] = stepsOf(in_m.z);
  }
}

}  // namespace echocine
