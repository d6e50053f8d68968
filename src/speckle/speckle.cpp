#include "speckle/speckle.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/hash_random.h"

namespace echocine {

Speckle::Speckle(const Probe& probe, const PointSpread& spread, const SpeckleSettings& settings,
                 const Material& material, std::shared_ptr<const Scatterers> drawn)
    : settings_(settings),
      lines_(probe.lines),
      turn_(UnrolledTurn::of(probe)),
      spread_(spread),
      view_(probe, spread_),
      gaussian_(settings.seed),
      scatterers_(
          drawn ? std::move(drawn)
                : std::make_shared<const Scatterers>(probe, spread_, view_, settings, material)),
      splatter_(probe, spread_),
      ratio_(turn_ ? turn_->probe() : probe, spread_, view_, settings.smoothing_m) {}

double Speckle::farthestAcross_m() const {
  double farthest_m = 0;
  for (const ScattererBatch& batch : scatterers_->batches())
    farthest_m = std::max({farthest_m, static_cast<double>(-batch.low_m.y),
                           static_cast<double>(batch.low_m.y + batch.edge_m)});
  return farthest_m;
}

double Speckle::renewalOf(const ScattererBatch& batch) const {
  if (batch.blood) return settings_.blood_time_s;
  const double renewed_s = static_cast<double>(batch.surroundings) * settings_.surroundings_time_s;
  return renewed_s > 0 ? renewed_s : settings_.tissue_time_s;
}

void Speckle::addUp(const MaterialFrame& tissue, double time_s, LineRange lines,
                    SplatLists& splats) const {
  turn_ ? splats.startTurn(lines_, turn_->beside()) : splats.start(lines_, lines);
  for (const ScattererBatch& batch : scatterers_->batches()) {
    const BeamCube cube = view_.cubeOf(tissue.corners(batch.group, batch.low_m, batch.edge_m));
    if (!view_.sees(cube, lines)) continue;
    GaussianMix mix = mixAt(gaussian_, batch.pattern, time_s, renewalOf(batch),
                            batch.blood || batch.surroundings == 0);
    mix.strength = scatterers_->strength(batch);
    splatter_.add(cube, *scatterers_, batch, mix, splats);
  }
  addSheets(tissue.onSheets(), time_s, splats);
  splats.settle();
}

// Eight places in a cube's stead, by runs of the table that belong to the seed.
void Speckle::addSheets(std::span<const Vec3f> places_m, double time_s, SplatLists& splats) const {
  constexpr std::uint64_t kSheets = 5;
  const float beyond = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < places_m.size(); first += kMostOfBatch) {
    const GaussianMix mix =
        mixAt(gaussian_, hashOf(settings_.seed, kSheets, first), time_s, settings_.tissue_time_s);
    const std::size_t count = std::min<std::size_t>(kMostOfBatch, places_m.size() - first);
    for (std::size_t j = 0; j < count; j += kFloatLanes) {
      CubeCorners eight;
      for (std::size_t i = 0; i < kFloatLanes; ++i)
        eight[i] = j + i < count ? places_m[first + j + i] : Vec3f{0, beyond, 1};
      splatter_.addPlaces(view_.cubeOf(eight), mix, static_cast<std::uint32_t>(j), splats);
    }
  }
}

void Speckle::apply(const MaterialFrame& tissue, double time_s, std::span<float> intensities,
                    const CoherentEchoes& echoes, LineRange lines, EchoField* field) const {
  if (turn_) return applyAround(tissue, time_s, intensities, echoes, lines, field);
  thread_local SplatLists splats;
  thread_local CoherentRatio::Rows rows;
  addUp(tissue, time_s, reach(lines), splats);
  ratio_.apply(splats, rows, intensities, echoes, lines, field);
}

// The sums of a full turn, as those of a sector that repeats the lines on both sides of the seam.
void Speckle::applyAround(const MaterialFrame& tissue, double time_s, std::span<float> intensities,
                          const CoherentEchoes& echoes, LineRange lines, EchoField* field) const {
  thread_local SplatLists splats;
  thread_local CoherentRatio::Rows rows;
  addUp(tissue, time_s, {0, lines_}, splats);
  std::vector<float> sector;
  turn_->unroll(intensities, sector);
  CoherentEchoes around;
  if (!echoes.empty()) {
    turn_->unroll(echoes.intensity, around.intensity);
    turn_->unroll(echoes.real, around.real);
    turn_->unroll(echoes.imaginary, around.imaginary);
  }
  EchoField of_sector;
  if (field && !field->empty()) of_sector.resize(sector.size());
  ratio_.apply(splats, rows, sector, around, turn_->unrolled(lines), &of_sector);
  turn_->take(sector, lines, intensities.data());
  if (of_sector.empty()) return;
  turn_->take(of_sector.mean, lines, field->mean.data());
  turn_->take(of_sector.real, lines, field->real.data());
  turn_->take(of_sector.imaginary, lines, field->imaginary.data());
}

}  // namespace echocine
