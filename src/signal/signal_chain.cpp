#include "signal/signal_chain.h"

#include <algorithm>

#include "core/units.h"
#include "signal/log_compression.h"
#include "signal/sector_loss.h"
#include "signal/time_gain.h"

namespace echocine {

namespace {

std::vector<float> gainsOf(const Scene& scene, const EffectPlan& plan) {
  const SignalSettings& s = scene.signal;
  if (s.tgc == Tgc::mean) return gainsAgainst(plan.mean_loss);
  if (s.tgc == Tgc::table) return timeGains(s.tgc_table, scene.probe);
  if (s.tgc == Tgc::nominal && plan.attenuation)
    return nominalGains(s.nominal_gain_np_per_m_hz * scene.probe.frequency_hz, scene.probe);
  return {};
}

}  // namespace

SignalChain::SignalChain(const Scene& scene, const EffectPlan& plan)
    : settings_(scene.signal),
      all_lines_{0, scene.probe.lines},
      samples_(scene.probe.samples),
      gains_(gainsOf(scene, plan)),
      fields_(scene, plan, gains_),
      geometry_(pictureGeometry(scene)),
      converter_(scene.probe, geometry_, scene.output.width, scene.output.height,
                 GreyCurve(scene.signal), ScanConverter::averagedOver(scene, geometry_)) {
  SignalSettings average = scene.signal;
  if (plan.rays_per_beam > 1) average.beam_width = BeamWidth::none;  // the rays are the beam
  if (plan.beam_width && average.beam_width == BeamWidth::profile && scene.probe.lines > 1) {
    profile_.emplace(scene.probe, scene.signal.pulse_cycles);
    average.beam_width = BeamWidth::none;
  }
  if (plan.beam_width) beam_.emplace(scene.probe, average);
  const ArtefactSettings& a = scene.artefacts;
  losses_ = sectorLosses(scene.probe, a, plan);
  if (plan.haze) haze_.emplace(scene.probe, a.haze_db, a.haze_width_rad);
  if (plan.reverberation) tail_.emplace(scene.probe, a.reverberation_db, a.reverberation_length_m);
}

void SignalChain::process(Intensities& intensities, LineRange lines) const {
  if (!gains_.empty()) applyTimeGains(gains_, intensities);
  averageOverBeam(intensities.values, haze_ ? all_lines_ : lines, BeamPart::whole);
  if (!losses_.empty()) applySectorLosses(losses_, intensities);
  if (haze_) haze_->add(intensities);
  if (!tail_) return;
  const auto samples = static_cast<std::size_t>(samples_);
  tail_->add(std::span<float>(intensities)
                 .subspan(static_cast<std::size_t>(lines.first) * samples,
                          static_cast<std::size_t>(lines.count()) * samples));
}

// Side lobes take in all lines.
void SignalChain::averageOverBeam(std::vector<float>& plane, LineRange lines, BeamPart part) const {
  if (beam_) beam_->apply(plane, profile_ ? all_lines_ : lines);
  if (profile_) profile_->apply(plane, lines, part);
}

std::vector<int> SignalChain::taken(LineRange lines) const {
  const auto all = static_cast<std::size_t>(all_lines_.end);
  const int samples = samples_;
  if (haze_ || profile_) return std::vector<int>(all, samples);
  if (beam_) return beam_->taken(lines);
  std::vector<int> taken(all, 0);
  std::fill(taken.begin() + lines.first, taken.begin() + lines.end, samples);
  return taken;
}

void SignalChain::process(CoherentEchoes& echoes, LineRange lines) const {
  if (echoes.empty()) return;
  for (std::vector<float>* plane : {&echoes.intensity, &echoes.real, &echoes.imaginary}) {
    if (!gains_.empty()) applyTimeGains(gains_, *plane);
    averageOverBeam(*plane, lines, BeamPart::main_lobe);
    if (!losses_.empty()) applySectorLosses(losses_, *plane);
  }
}

Greys SignalChain::compress(Intensities&& intensities, double reference_intensity, double time_s,
                            const EchoField& field) const {
  const double white = reference_intensity * intensityFromDecibels(-settings_.gain_db);
  Greys greys(intensities.release());
  if (fields_.adds()) fields_.add(white, time_s, field, greys);
  compressIntensities(greys, white, settings_.dynamic_range_db, greys);
  return greys;
}

}  // namespace echocine
