#pragma once
// The coherent stage: the tracer decides how bright a place is, material scatterers decide the
// phase. The mean over seeds is the picture without speckle, for any beam model.

#include <memory>
#include <optional>
#include <span>

#include "scene/unrolled_turn.h"
#include "speckle/coherent_ratio.h"
#include "speckle/splat.h"
#include "trace/coherent_echoes.h"

namespace echocine {

class Speckle {
 public:
  // Draws the scatterers, or shares those of another speckle whose probe differs in lines and
  // samples alone. Uses the threads of the enclosing withThreads(); the same for any number.
  Speckle(const Probe& probe, const PointSpread& spread, const SpeckleSettings& settings,
          const Material& material, std::shared_ptr<const Scatterers> drawn = nullptr);
  Speckle(Speckle&&) = delete;

  const PointSpread& spread() const { return spread_; }
  const std::shared_ptr<const Scatterers>& drawn() const { return scatterers_; }
  std::size_t scatterers() const { return scatterers_->count(); }
  // Reference places of scatterers lie within this of the imaging plane.
  double farthestAcross_m() const;

  // Intensities after the average over the beam, in place. A function of the instant alone: any
  // frame by itself has the bytes that it has in its loop. Thread-safe. echoes: what of the
  // intensities is coherent; empty: nothing.
  void apply(const MaterialFrame& tissue, double time_s, std::span<float> intensities,
             const CoherentEchoes& echoes = {}) const {
    apply(tissue, time_s, intensities, echoes, {0, lines_});
  }
  // The same of some lines; those within their reach have to be as without speckle. field: if not
  // null and not empty, receives the field of these lines.
  void apply(const MaterialFrame& tissue, double time_s, std::span<float> intensities,
             const CoherentEchoes& echoes, LineRange lines, EchoField* field = nullptr) const;
  LineRange reach(LineRange lines) const {
    return turn_ ? LineRange{0, lines_} : ratio_.reach(lines);
  }

 private:
  void applyAround(const MaterialFrame& tissue, double time_s, std::span<float> intensities,
                   const CoherentEchoes& echoes, LineRange lines, EchoField* field) const;
  double renewalOf(const ScattererBatch& batch) const;
  void addUp(const MaterialFrame& tissue, double time_s, LineRange lines, SplatLists& splats) const;
  void addSheets(std::span<const Vec3f> places_m, double time_s, SplatLists& splats) const;

  SpeckleSettings settings_;
  int lines_;
  std::optional<UnrolledTurn> turn_;
  PointSpread spread_;
  BeamView view_;
  GaussianTable gaussian_;
  std::shared_ptr<const Scatterers> scatterers_;
  Splatter splatter_;
  CoherentRatio ratio_;
};

}  // namespace echocine
