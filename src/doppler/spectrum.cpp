#include "doppler/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "core/units.h"
#include "frame/loop_instant.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/names.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "truth/frame_truth.h"

namespace echocine {

namespace {

constexpr int kBins = 128, kLeastWindow = 4;
constexpr double kMostSpectrumPulses = 1 << 17;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The samples of the volume along its line.
struct Volume {
  int line = 0, first = 0, end = 0;
  double depth_m = 0;  // of its middle
};

Volume volumeAt(const Simulator& simulator, const SpectrumRequest& request) {
  const Probe& probe = simulator.scene().probe;
  const ScanGeometry geometry(probe);
  Volume volume;
  const SpectrumPlace& at = request.at;
  if (at.through) {
    const FrameTruth truth = simulator.truthAt(simulator.cardiacClock().at(0));
    const std::optional<Vec3d> point = targetIn(truth, simulator.scene(), *at.through);
    if (!point)
      throw SceneError(
          fmt::format("--through {}: the imaging plane does not show it; use a view that does",
                      nameOf(*at.through)));
    volume.line = lineThrough(probe, *point, *at.through);
    volume.depth_m = geometry.pathOf(*point);
  } else {
    volume.line = lineAt(probe, at.place.value_or(0), geometry.angular() ? "--angle" : "--offset");
    volume.depth_m = *at.depth_m;
  }
  const auto sampleAt = [&](double depth_m) {
    return static_cast<int>(std::floor((depth_m - probe.min_depth_m) / probe.sampleSpacing()));
  };
  volume.first =
      std::clamp(sampleAt(volume.depth_m - 0.5 * request.volume_m), 0, probe.samples - 1);
  volume.end = std::clamp(sampleAt(volume.depth_m + 0.5 * request.volume_m), volume.first,
                          probe.samples - 1) +
               1;
  return volume;
}

std::size_t pulseCount(const Simulator& simulator, double prf_hz) {
  const double duration_s =
      simulator.cardiacClock().frameCount() / simulator.scene().acquisition.frame_rate_hz;
  const double wanted = std::max(1.0, std::floor(duration_s * prf_hz));
  if (wanted > kMostSpectrumPulses)
    throw SceneError(fmt::format("--prf: {:g} Hz gives {:.0f} pulses, accepted: at most {:.0f}",
                                 prf_hz, wanted, kMostSpectrumPulses));
  return static_cast<std::size_t>(wanted);
}

// z_k(t_n): one vector per pulse.
using Pulses = std::vector<std::vector<std::complex<double>>>;

Pulses receive(const Simulator& simulator, double prf_hz, const Volume& volume, double white,
               const Monitor& monitor) {
  const Scene& scene = simulator.scene();
  const CardiacClock& clock = simulator.cardiacClock();
  const std::size_t count = pulseCount(simulator, prf_hz);
  const auto first =
      static_cast<std::size_t>(volume.line) * static_cast<std::size_t>(scene.probe.samples);
  Pulses pulses(count);
  const std::size_t made = parallelOrdered(
      0, count, 2 * static_cast<std::size_t>(threadCount()), monitor.keep_going,
      [&](std::size_t n) -> std::shared_ptr<void> {
        FrameTime at = instantOf(clock, scene, static_cast<double>(n) / prf_hz);
        at.frame = 0;  // rays of a beam differ between frames, not between pulses
        const PulseField z = receivePulse(simulator, at, white, {volume.line, volume.line + 1});
        for (int k = volume.first; k < volume.end; ++k) {
          const std::size_t i = first + static_cast<std::size_t>(k);
          pulses[n].emplace_back(z.real[i], z.imaginary[i]);
        }
        return nullptr;
      },
      [&](std::size_t n, const std::shared_ptr<void>&) {
        monitor.tell({Task::rendering, n + 1, count});
      });
  if (made < count) throw Stopped();
  return pulses;
}

// (D5), of the pulses of a window that begins at one of them. It may begin before the loop or end
// after it.
void addColumn(const Pulses& pulses, std::ptrdiff_t begin, int length, Spectrum& spectrum) {
  const auto first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(begin, 0)),
             end = std::min(static_cast<std::size_t>(begin + length), pulses.size());
  std::vector<double> powers(kBins, 0.0);
  const std::size_t samples = pulses.front().size();
  double squares = 0;
  std::vector<double> taper;
  for (std::size_t n = first; n < end; ++n) {
    const double at = (static_cast<double>(static_cast<std::ptrdiff_t>(n) - begin) + 0.5) / length;
    taper.push_back(0.5 - 0.5 * std::cos(2 * std::numbers::pi * at));
    squares += taper.back() * taper.back();
  }
  for (int b = 0; b < kBins; ++b) {
    const double per_pulse = std::numbers::pi * (2 * (b + 0.5) / kBins - 1);
    for (std::size_t k = 0; k < samples; ++k) {
      std::complex<double> sum;
      for (std::size_t n = first; n < end; ++n)
        sum +=
            taper[n - first] * pulses[n][k] * std::polar(1.0, -per_pulse * static_cast<double>(n));
      powers[static_cast<std::size_t>(b)] += std::norm(sum);
    }
  }
  for (const double power : powers)
    spectrum.power.push_back(
        static_cast<float>(squares > 0 ? power / squares / static_cast<double>(samples) : 0));
  std::complex<double> r1;
  for (std::size_t n = first; n + 1 < end; ++n)
    for (std::size_t k = 0; k < samples; ++k) r1 += pulses[n][k] * std::conj(pulses[n + 1][k]);
  spectrum.mean_m_s.push_back(r1 == 0.0 ? kNone
                                        : -spectrum.nyquist_m_s * std::arg(r1) / std::numbers::pi);
}

// Mean over the tissue of the volume.
double tissueVelocity(const Simulator& simulator, const FrameTime& time, const Volume& volume) {
  const std::vector<float> exact = simulator.truthAt(time).motion.beam_m_s;
  const int samples = simulator.scene().probe.samples;
  double sum = 0, count = 0;
  for (int k = volume.first; k < volume.end; ++k) {
    const auto v = static_cast<double>(exact[static_cast<std::size_t>(volume.line * samples + k)]);
    if (std::isnan(v)) continue;
    sum += v;
    ++count;
  }
  return count > 0 ? sum / count : kNone;
}

// The ring's point in the plane, along the line, from 1 ms before to 1 ms after.
double ringVelocity(const Simulator& simulator, const FrameTime& time, const Volume& volume,
                    MModeTarget ring) {
  constexpr double kStep_s = 1e-3;
  const Scene& scene = simulator.scene();
  const CardiacClock& clock = simulator.cardiacClock();
  const double before_s = std::max(time.time_s - kStep_s, 0.0), after_s = time.time_s + kStep_s;
  const auto pointAt = [&](double time_s) {
    return targetIn(simulator.truthAt(instantOf(clock, scene, time_s)), scene, ring);
  };
  const std::optional<Vec3d> before = pointAt(before_s), after = pointAt(after_s);
  if (!before || !after) return kNone;
  return -dot(*after - *before, lineGeometry(scene.probe, volume.line).direction) /
         (after_s - before_s);
}

double exactVelocity(const Simulator& simulator, const FrameTime& time, const Volume& volume,
                     const std::optional<MModeTarget>& through) {
  return through && isRing(*through) ? ringVelocity(simulator, time, volume, *through)
                                     : tissueVelocity(simulator, time, volume);
}

void findPeaks(const Simulator& simulator, Spectrum& spectrum) {
  const std::optional<ValveTimes>& valves = simulator.truth()->valves();
  if (!valves) return;
  const auto peakOf = [&](const std::vector<double>& velocity_m_s) {
    double peak = -std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < spectrum.times.size(); ++t) {
      if (spectrum.times[t].beat != 0 || spectrum.times[t].phase > valves->aortic_closes) break;
      if (!std::isnan(velocity_m_s[t])) peak = std::max(peak, velocity_m_s[t]);
    }
    return std::isinf(peak) ? 0 : peak;
  };
  spectrum.mean_peak = peakOf(spectrum.mean_m_s);
  spectrum.exact_peak = peakOf(spectrum.exact_m_s);
}

void refuse(const char* option, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw SceneError(fmt::format("{}: {:g} {}, accepted: {:g} to {:g} {}", option, value, unit, least,
                               most, unit));
}

}  // namespace

Scene spectrumScene(Scene scene, const DopplerRequest& request, const SpectrumRequest& spectrum) {
  refuse("--volume", millimetresFromMetres(spectrum.volume_m), 0, 50, "mm");
  if (!spectrum.at.through)
    refuse("--depth", millimetresFromMetres(*spectrum.at.depth_m),
           millimetresFromMetres(scene.probe.min_depth_m),
           millimetresFromMetres(scene.probe.max_depth_m), "mm");
  scene = dopplerScene(std::move(scene), request);
  if (!spectrum.at.through) return scene;
  refuseWithoutRoles(scene, *spectrum.at.through);
  scene.truth.contours = scene.truth.function = true;
  return scene;
}

void checkSpectrum(const Simulator& simulator, const DopplerRequest& request,
                   const SpectrumRequest& spectrum) {
  volumeAt(simulator, spectrum);
  pulseCount(simulator, request.prf_hz);
}

Spectrum makeSpectrum(const Simulator& simulator, const DopplerRequest& request,
                      const SpectrumRequest& wanted, double white, const Monitor& monitor) {
  const Scene& scene = simulator.scene();
  Spectrum spectrum;
  spectrum.bins = kBins;
  spectrum.nyquist_m_s = nyquistVelocity(scene.probe, request.prf_hz);
  const Volume volume = volumeAt(simulator, wanted);
  spectrum.line = volume.line;
  spectrum.depth_m = volume.depth_m;
  const Pulses pulses = receive(simulator, request.prf_hz, volume, white, monitor);
  const int length =
      std::max(kLeastWindow, static_cast<int>(std::lround(wanted.window_s * request.prf_hz)));
  const auto count = static_cast<std::ptrdiff_t>(pulses.size());
  for (int t = 0;; ++t) {
    const double time_s = t * wanted.step_s;
    const std::ptrdiff_t middle = std::lround(time_s * request.prf_hz);
    if (middle >= count) break;
    spectrum.times.push_back(instantOf(simulator.cardiacClock(), scene, time_s));
    addColumn(pulses, middle - length / 2, length, spectrum);
    checkpoint();
  }
  spectrum.columns = static_cast<int>(spectrum.times.size());
  spectrum.exact_m_s.resize(spectrum.times.size());
  parallelBlocks(spectrum.times.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      spectrum.exact_m_s[t] =
          exactVelocity(simulator, spectrum.times[t], volume, wanted.at.through);
  });
  findPeaks(simulator, spectrum);
  return spectrum;
}

}  // namespace echocine
