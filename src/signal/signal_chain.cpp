#include "signal/signal_chain.h"

#include <algorithm>

#include "core/units.h"
#include "signal/harmonic.h"
#include "signal/log_compression.h"
#include "signal/sector_loss.h"
#include "signal/time_gain.h"

namespace echocine {

namespace {

void multiply(std::vector<float>& gains, const std::vector<float>& by) {
  if (gains.empty()) gains.assign(by.size(), 1);
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] *= by[k];
}

std::vector<float> gainsOfPath(const Scene& scene, const EffectPlan& plan) {
  const SignalSettings& s = scene.signal;
  if (s.tgc == Tgc::mean) return gainsAgainst(plan.mean_loss);
  if (s.tgc == Tgc::table) return timeGains(s.tgc_table, scene.probe);
  if (s.tgc == Tgc::nominal && plan.attenuation)
    return nominalGains(s.nominal_gain_np_per_m_hz * scene.probe.frequency_hz, scene.probe);
  return {};
}

// The examiner evens the build-up of the second harmonic, unless the gain is stated.
std::vector<float> gainsOf(const Scene& scene, const EffectPlan& plan) {
  std::vector<float> gains = gainsOfPath(scene, plan);
  const SignalSettings& s = scene.signal;
  if (s.near_gain_db != 0)
    multiply(gains, timeGains({{0, s.near_gain_db}, {s.near_gain_depth_m, 0}}, scene.probe));
  if (plan.harmonic && (s.tgc == Tgc::mean || s.tgc == Tgc::perfect))
    multiply(gains, gainsOfBuildUp(scene.probe));
  return gains;
}

// Haze comes in equal parts from the sent and the received wave. The harmonic of a weak wave is
// its square, so the sent half is lost.
double hazeLevel(const ArtefactSettings& artefacts, const EffectPlan& plan) {
  return artefacts.haze_db - (plan.harmonic ? decibelsFromIntensity(2) : 0);
}

BeamPulse pulseOf(const Scene& scene, const EffectPlan& plan) {
  const SignalSettings& s = scene.signal;
  return {s.pulse_cycles, plan.harmonic, plan.downshift ? s.nominal_gain_np_per_m_hz : 0,
          plan.receive_aperture ? s.receive_f_number : 0};
}

}  // namespace

SignalChain::SignalChain(const Scene& scene, const EffectPlan& plan)
    : settings_(scene.signal),
      all_lines_{0, scene.probe.lines},
      samples_(scene.probe.samples),
      turn_(UnrolledTurn::of(scene.probe)),
      gains_(gainsOf(scene, plan)),
      fields_(scene, plan, gains_),
      geometry_(pictureGeometry(scene)),
      converter_(scene.probe, geometry_, scene.output.width, scene.output.height,
                 GreyCurve(scene.signal), ScanConverter::averagedOver(scene, geometry_)) {
  const Probe& probe = turn_ ? turn_->probe() : scene.probe;
  SignalSettings average = scene.signal;
  if (plan.rays_per_beam > 1) average.beam_width = BeamWidth::none;  // the rays are the beam
  if (plan.beam_width && average.beam_width == BeamWidth::profile && scene.probe.lines > 1) {
    profile_.emplace(probe, pulseOf(scene, plan));
    average.beam_width = BeamWidth::none;
  }
  if (plan.beam_width) beam_.emplace(probe, average, turn_ ? 0.5 * scene.probe.lines : 0);
  const ArtefactSettings& a = scene.artefacts;
  if (plan.edge_enhancement) edges_.emplace(probe, scene.signal);
  losses_ = sectorLosses(scene.probe, a, plan);
  if (plan.harmonic) build_up_ = buildUps(scene.probe);
  if (plan.lung) lung_.emplace(scene);
  if (plan.haze) haze_.emplace(scene.probe, hazeLevel(a, plan), a.haze_width_rad);
  if (plan.reverberation) tail_.emplace(scene.probe, a.reverberation_db, a.reverberation_length_m);
}

void SignalChain::process(Intensities& intensities, LineRange lines,
                          std::span<const std::uint32_t> media) const {
  if (!build_up_.empty()) applyTimeGains(build_up_, intensities);
  if (!gains_.empty()) applyTimeGains(gains_, intensities);
  if (lung_ && !media.empty()) lung_->add(media, intensities.values);
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
  if (!beam_ && !profile_) return;
  if (turn_) {
    std::vector<float> sector;
    turn_->unroll(plane, sector);
    const LineRange all{0, turn_->probe().lines}, some = turn_->unrolled(lines);
    if (beam_) beam_->apply(sector, profile_ ? all : some);
    if (profile_) profile_->apply(sector, some, part);
    return turn_->take(sector, lines, plane.data());
  }
  if (beam_) beam_->apply(plane, profile_ ? all_lines_ : lines);
  if (profile_) profile_->apply(plane, lines, part);
}

void SignalChain::enhanceEdges(Greys& greys) const {
  if (!turn_) return edges_->apply(greys);
  std::vector<float> sector;
  turn_->unroll(greys.values, sector);
  edges_->apply(sector);
  turn_->take(sector, all_lines_, greys.values.data());
}

std::vector<int> SignalChain::taken(LineRange lines) const {
  const auto all = static_cast<std::size_t>(all_lines_.end);
  const int samples = samples_;
  if (haze_ || profile_ || turn_) return std::vector<int>(all, samples);
  if (beam_) return beam_->taken(lines);
  std::vector<int> taken(all, 0);
  std::fill(taken.begin() + lines.first, taken.begin() + lines.end, samples);
  return taken;
}

void SignalChain::process(CoherentEchoes& echoes, LineRange lines) const {
  if (echoes.empty()) return;
  for (std::vector<float>* plane : {&echoes.intensity, &echoes.real, &echoes.imaginary}) {
    if (!build_up_.empty()) applyTimeGains(build_up_, *plane);
    if (!gains_.empty()) applyTimeGains(gains_, *plane);
    averageOverBeam(*plane, lines, BeamPart::main_lobe);
    if (!losses_.empty()) applySectorLosses(losses_, *plane);
  }
}

void SignalChain::addFields(double white, double time_s, LineRange lines, EchoField& field) const {
  fields_.addTo(field, white * intensityFromDecibels(-settings_.pictureGain_db()), time_s, lines);
}

LineRange SignalChain::greysFrom(LineRange lines) const {
  if (!edges_) return lines;
  if (turn_) return all_lines_;
  return {std::max(lines.first - edges_->halfLines(), all_lines_.first),
          std::min(lines.end + edges_->halfLines(), all_lines_.end)};
}

Greys SignalChain::compress(Intensities&& intensities, double reference_intensity, double time_s,
                            const EchoField& field) const {
  const double white = reference_intensity * intensityFromDecibels(-settings_.pictureGain_db());
  Greys greys(intensities.release());
  if (fields_.adds()) fields_.add(white, time_s, field, greys);
  compressIntensities(greys, white, settings_.dynamic_range_db, greys);
  if (edges_) enhanceEdges(greys);
  return greys;
}

}  // namespace echocine
