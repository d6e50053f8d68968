#include "doppler/doppler.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "frame/loop_instant.h"
#include "frame/making.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/names.h"
#include "signal/signal_chain.h"
#include "truth/frame_truth.h"

namespace echocine {

namespace {

constexpr double kMostGate_m = 0.02;

void refusePacket(const Scene& scene, const DopplerRequest& request) {
  const double most_hz = kScannerSpeed / (2 * scene.probe.max_depth_m);
  if (!(request.prf_hz >= 1 && request.prf_hz <= most_hz))
    throw SceneError(fmt::format(
        "--prf: {:g} Hz, accepted: 1 to {:.0f} Hz, at which echoes from {:.0f} mm "
        "return in time",
        request.prf_hz, std::floor(most_hz), millimetresFromMetres(scene.probe.max_depth_m)));
  const int least = leastPulses(request.wall);
  if (request.pulses < least || request.pulses > kMostPulses)
    throw SceneError(fmt::format("--pulses: {}, accepted with wall filter {}: {} to {}",
                                 request.pulses, nameOf(request.wall), least, kMostPulses));
  if (!(request.gate_m >= 0 && request.gate_m <= kMostGate_m))
    throw SceneError(fmt::format("--gate: {:g} mm, accepted: 0 to {:g} mm",
                                 millimetresFromMetres(request.gate_m),
                                 millimetresFromMetres(kMostGate_m)));
  const double packet_s = (request.pulses - 1) / request.prf_hz;
  const double frame_s = 1 / scene.acquisition.frame_rate_hz;
  if (packet_s > frame_s)
    throw SceneError(fmt::format(
        "--pulses: {} pulses at {:g} Hz take {:.3g} ms, a frame takes {:.3g} ms; reduce them, or "
        "raise --prf",
        request.pulses, request.prf_hz, 1e3 * packet_s, 1e3 * frame_s));
}

}  // namespace

Scene dopplerScene(Scene scene, const DopplerRequest& request) {
  refusePacket(scene, request);
  scene.speckle.on = true;
  scene.acquisition.rolling = false;
  scene.artefacts.persistence = 0;
  scene.output.channels = {Channel::velocity_beam};
  scene.output.exr = scene.output.cine = true;
  scene.output.png = scene.output.dicom = scene.output.report = false;
  scene.truth = {};
  return scene;
}

PulseField receivePulse(const Simulator& simulator, const FrameTime& time, double white,
                        LineRange lines) {
  const std::shared_ptr<Workspace> w = simulator.workspace();
  Making making{.still = true, .counted = false, .persists = false, .keeps_field = true};
  if (lines.count() < simulator.scene().probe.lines) making.lines = lines;
  simulator.make(time, making, *w);
  if (w->polar.field.empty())
    throw SceneError(
        "tissue Doppler needs echoes of tissue: no medium scatters, or effects omit it");
  simulator.chain().addFields(white, time.time_s, lines, w->polar.field);
  EchoField field = std::move(w->polar.field);
  w->polar.field = {};
  return {std::move(field.real), std::move(field.imaginary)};
}

DopplerFrame makeDopplerFrame(const Simulator& simulator, const DopplerRequest& request, int frame,
                              double white) {
  const Scene& scene = simulator.scene();
  DopplerFrame made;
  made.time = simulator.cardiacClock().at(frame);
  std::vector<PulseField> pulses;
  for (int n = 0; n < request.pulses; ++n) {
    const double offset_s = (n - 0.5 * (request.pulses - 1)) / request.prf_hz;
    FrameTime at = instantOf(simulator.cardiacClock(), scene, made.time.time_s + offset_s);
    at.frame = frame;  // rays of a beam differ between frames, not between pulses
    pulses.push_back(receivePulse(simulator, at, white, {0, scene.probe.lines}));
  }
  made.measured = estimateVelocity(pulses, WallFilter(request.wall, request.pulses), scene.probe,
                                   request.prf_hz, request.gate_m);
  const std::shared_ptr<Workspace> w = simulator.workspace();
  simulator.make(made.time, {.still = true, .counted = false, .persists = false, .white = white},
                 *w);
  made.greys = std::move(w->greys);
  w->greys = {};
  made.exact_m_s = std::move(simulator.truthAt(made.time, w.get()).motion.beam_m_s);
  for (std::size_t i = 0; i < made.exact_m_s.size(); ++i) {
    if (!std::isnan(made.exact_m_s[i])) continue;
    made.measured.velocity_m_s[i] = std::numeric_limits<float>::quiet_NaN();
    made.measured.variance_m2_s2[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return made;
}

}  // namespace echocine
