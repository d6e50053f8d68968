#include "signal/signal_chain.h"

#include "signal/log_compression.h"
#include "signal/time_gain.h"

namespace echocine {

SignalChain::SignalChain(const Scene& scene, const EffectPlan& plan)
    : settings_(scene.signal),
      geometry_(pictureGeometry(scene)),
      converter_(scene.probe, geometry_, scene.output.width, scene.output.height,
                 scene.signal.grey_gamma) {
  SignalSettings average = scene.signal;
  if (plan.rays_per_beam > 1) average.beam_width = BeamWidth::none;  // the rays are the beam
  if (plan.beam_width) beam_.emplace(scene.probe, average);
  if (settings_.tgc == Tgc::mean) gains_ = gainsAgainst(plan.mean_loss);
  if (settings_.tgc == Tgc::table) gains_ = timeGains(settings_.tgc_table, scene.probe);
}

void SignalChain::process(Intensities& intensities) const {
  if (!gains_.empty()) applyTimeGains(gains_, intensities);
  if (beam_) beam_->apply(intensities.values);
}

Greys SignalChain::compress(Intensities&& intensities, double reference_intensity) const {
  Greys greys(intensities.release());
  compressIntensities(greys, reference_intensity, settings_.dynamic_range_db, greys);
  return greys;
}

}  // namespace echocine
