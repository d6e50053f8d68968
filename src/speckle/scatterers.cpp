#include "speckle/scatterers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "speckle/across_range.h"
#include "speckle/block_search.h"

namespace echocine {

namespace {

constexpr auto kOfEight = static_cast<std::uint32_t>(kFloatLanes);

// Purposes of hashed numbers.
enum : std::uint64_t { kCount = 2, kGauss = 3, kBatch = 4 };

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

// Range of each batch that a beam can reach at instants of overTheBeat() and between them; all of
// it without instants. Blood has its whole range: a test would take longer than its strengths.
std::vector<AcrossRange> seenOverTheBeat(std::span<const ScattererBatch> batches,
                                         const Material& material, const BeamView& view) {
  AcrossRange all;
  std::swap(all.first, all.last);
  std::vector<AcrossRange> seen(batches.size());
  for (std::size_t n = 0; n < batches.size(); ++n)
    if (batches[n].blood) seen[n] = all;
  bool looked = false;
  material.overTheBeat([&](const MaterialFrame& tissue) {
    looked = true;
    parallelBlocks(batches.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const ScattererBatch& b = batches[n];
        if (b.blood) continue;
        const CubeCorners corners = tissue.corners(b.group, b.low_m, b.edge_m);
        for (const float beside_m : {-kBetweenInstants_m, kBetweenInstants_m}) {
          CubeCorners moved = corners;
          for (Vec3f& corner : moved) corner.y += beside_m;
          seen[n].add(AcrossRange(view.cubeOf(moved).across));
        }
      }
    });
  });
  if (!looked) std::ranges::fill(seen, all);
  return seen;
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

// The scatterers of some blocks. Numbers of places begin at 0.
struct Scatterers::Drawn {
  std::vector<ScattererBatch> batches;
  std::vector<EightPlaces> places;

  void add(const TissueBlock& block, const Material& material);

 private:
  void addBatch(std::span<const Vec3f> places_m, ScattererBatch batch);
};

Scatterers::Scatterers(const Probe& probe, const PointSpread& spread, const BeamView& view,
                       const SpeckleSettings& settings, const Material& material) {
  constexpr std::size_t kTogether = 16;
  const std::vector<TissueBlock> blocks = searchBlocks(probe, spread, view, settings, material);
  std::vector<Drawn> drawn((blocks.size() + kTogether - 1) / kTogether);
  parallelBlocks(blocks.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) drawn[begin / kTogether].add(blocks[b], material);
  });
  for (Drawn& some : drawn) {
    checkpoint();
    take(some);
  }
  places_.shrink_to_fit();
  for (const EightPlaces& eight : places_)
    highest_.push_back(*std::max_element(std::begin(eight.v), std::end(eight.v)));
  weigh(material, view);
}

void Scatterers::take(Drawn& drawn) {
  const auto first = static_cast<std::uint32_t>(places_.size() * kFloatLanes);
  for (ScattererBatch& batch : drawn.batches) {
    batch.first += first;
    count_ += batch.count;
    batches_.push_back(batch);
  }
  places_.insert(places_.end(), drawn.places.begin(), drawn.places.end());
  drawn = {};
}

void Scatterers::weigh(const Material& material, const BeamView& view) {
  if (!material.differs()) return;
  strength_.assign(places_.size() * kFloatLanes, 1);
  const std::vector<AcrossRange> seen = seenOverTheBeat(batches_, material, view);
  parallelBlocks(batches_.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3f> places_m;
    for (std::size_t n = begin; n < end; ++n) {
      const ScattererBatch& b = batches_[n];
      const std::uint32_t from = firstOf(b, seen[n].first), to = endOf(b, seen[n].last);
      if (from >= to) continue;
      places_m.clear();
      for (std::uint32_t i = b.first + from; i < b.first + to; ++i)
        places_m.push_back(b.low_m +
                           b.edge_m * placeInCube(places_[i / kFloatLanes], i % kFloatLanes));
      material.amplitudes(places_m, b.group,
                          std::span(strength_).subspan(b.first + from, to - from));
    }
  });
}

// Multiples of the lanes. Highest v of the eights ascend.
std::uint32_t Scatterers::firstOf(const ScattererBatch& b, float v) const {
  const std::uint16_t *const begin = highest(b), *const end = begin + eightsOf(b);
  const auto at = std::lower_bound(begin, end, v, [](std::uint16_t high, float least) {
    return static_cast<float>(high) < least;
  });
  return static_cast<std::uint32_t>(at - begin) * kOfEight;
}
std::uint32_t Scatterers::endOf(const ScattererBatch& b, float v) const {
  const std::uint16_t *const begin = highest(b), *const end = begin + eightsOf(b);
  const auto at = std::upper_bound(begin, end, v, [](float most, std::uint16_t high) {
    return most < static_cast<float>(high);
  });
  return std::min(static_cast<std::uint32_t>(at - begin + 1) * kOfEight, b.count);
}

// By group and cube, for the cubes that a beam reaches. A place depends on its number alone, so
// what is left out changes no other. Points of a cube ascend across the imaging plane, so that
// those beyond the beam are contiguous.
void Scatterers::Drawn::add(const TissueBlock& block, const Material& material) {
  const auto count =
      static_cast<std::uint32_t>(block.wanted + uniformFromHash(hashOf(block.pattern, kCount)));
  bool seen[8];
  for (std::uint32_t half = 0; half < 8; ++half) seen[half] = block.seesHalf(half, material);
  std::vector<Vec3f> in_view_m;
  for (std::uint32_t j = 0; j < count; ++j) {
    const Vec3f place_m = block.low_m + block.edge_m * pointIn(block.pattern, j);
    if (seen[halfOf(block, place_m)]) in_view_m.push_back(place_m);
  }
  std::vector<std::uint16_t> groups(in_view_m.size());
  material.groupsAt(in_view_m, groups);
  std::map<std::uint32_t, std::vector<Vec3f>> cubes;  // by group and number
  for (std::size_t i = 0; i < in_view_m.size(); ++i) {
    const std::uint32_t cube = material.coarse(groups[i]) ? 0 : halfOf(block, in_view_m[i]);
    if (block.sees(groups[i], cube)) cubes[8u * groups[i] + cube].push_back(in_view_m[i]);
  }
  for (auto& [key, places_m] : cubes) {
    std::sort(places_m.begin(), places_m.end(), [](Vec3f a, Vec3f b) { return a.y < b.y; });
    const auto group = static_cast<std::uint16_t>(key / 8);
    const float edge_m = material.coarse(group) ? block.edge_m : 0.5f * block.edge_m;
    const Vec3f low_m = block.low_m + cubeOffset(key % 8, edge_m);
    for (std::size_t first = 0; first < places_m.size(); first += kMostOfBatch)
      addBatch(std::span<const Vec3f>(places_m).subspan(
                   first, std::min<std::size_t>(kMostOfBatch, places_m.size() - first)),
               {low_m, edge_m, 0, 0, group, material.blood(group), material.surroundings(group),
                hashOf(block.pattern, kBatch, key, first)});
  }
}

void Scatterers::Drawn::addBatch(std::span<const Vec3f> places_m, ScattererBatch batch) {
  batch.first = static_cast<std::uint32_t>(places.size() * kFloatLanes);
  batch.count = static_cast<std::uint32_t>(places_m.size());
  batches.push_back(batch);
  const auto stepsOf = [&](float along_m) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(along_m / batch.edge_m, 0.0f, 1.0f) *
                                                  static_cast<float>(kCubeEdge)));
  };
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    const std::size_t lane = i % kFloatLanes;
    if (lane == 0) places.push_back({});
    const Vec3f in_m = places_m[i] - batch.low_m;
    places.back().u[lane] = stepsOf(in_m.x);
    places.back().v[lane] = stepsOf(in_m.y);
    places.back().w[lane] = stepsOf(in_m.z);
  }
}

}  // namespace echocine
