// Systolic peak velocity s' of the mitral ring in the shipped heart, measured and exact.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "doppler/spectrum.h"
#include "frame/loop_instant.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/names.h"
#include "scene/scan_geometry.h"
#include "scene/scene_reader.h"
#include "support/all_cases.h"
#include "support/paths.h"

namespace echocine {
namespace {

constexpr MModeTarget kRings[] = {MModeTarget::mitral_septal, MModeTarget::mitral_lateral};

SpectrumRequest ringRequest(MModeTarget ring) {
  SpectrumRequest wanted;
  wanted.at.through = ring;
  wanted.step_s = 0.02;
  return wanted;
}

Scene shippedHeart() {
  return readScene(std::filesystem::path(support::kSourceDir) /
                   "examples/beating_heart/scene.toml");
}

// Velocities at the ring of one frame, along its line: of the ring's point by the mesh, and power-
// weighted means of the estimate and of the truth over the tissue within 4 mm.
struct RingVelocities {
  double ring = 0, measured = 0, tissue = 0;
};
RingVelocities atRing(const Simulator& simulator, const DopplerRequest& request, int frame,
                      MModeTarget target) {
  const Scene& scene = simulator.scene();
  const Probe& probe = scene.probe;
  const DopplerFrame made =
      makeDopplerFrame(simulator, request, frame, simulator.referenceIntensity());
  const auto pointAt = [&](double time_s) {
    return *targetIn(simulator.truthAt(instantOf(simulator.cardiacClock(), scene, time_s)), scene,
                     target);
  };
  constexpr double kStep_s = 1e-3, kReach_m = 4e-3;
  const Vec3d place = pointAt(made.time.time_s);
  const int line = lineThrough(probe, place, target);
  const Vec3d moved = pointAt(made.time.time_s + kStep_s) - pointAt(made.time.time_s - kStep_s);
  RingVelocities out;
  out.ring = -dot(moved, lineGeometry(probe, line).direction) / (2 * kStep_s);
  const ScanGeometry geometry(probe);
  double weight = 0;
  for (int i = 0; i < probe.lines; ++i)
    for (int k = 0; k < probe.samples; ++k) {
      const auto at = static_cast<std::size_t>(i * probe.samples + k);
      const auto exact = static_cast<double>(made.exact_m_s[at]);
      const LineGeometry along = lineGeometry(probe, i);
      if (std::isnan(exact) ||
          length(along.origin + geometry.sampleDepth(k) * along.direction - place) > kReach_m)
        continue;
      const auto power = static_cast<double>(made.measured.power[at]);
      if (!(power > 0)) continue;  // no echo
      weight += power;
      out.measured += power * static_cast<double>(made.measured.velocity_m_s[at]);
      out.tissue += power * exact;
    }
  out.measured /= weight;
  out.tissue /= weight;
  return out;
}

TEST(DopplerHeart, TheEstimateAtTheMovingRingHasItsVelocity) {
  const DopplerRequest request;
  withThreads(0, [&] {
    const Simulator simulator(spectrumScene(shippedHeart(), request, ringRequest(kRings[0])));
    for (const MModeTarget ring : kRings) {
      RingVelocities peak;
      double squares = 0;
      int frames = 0;                              // with echo at the ring: a border may be lost
      for (int frame = 2; frame <= 14; ++frame) {  // systole at 50 frames a second
        const RingVelocities v = atRing(simulator, request, frame, ring);
        if (std::isnan(v.measured)) continue;
        peak.ring = std::max(peak.ring, v.ring);
        peak.measured = std::max(peak.measured, v.measured);
        peak.tissue = std::max(peak.tissue, v.tissue);
        squares += (v.measured - v.tissue) * (v.measured - v.tissue);
        ++frames;
      }
      ASSERT_GE(frames, 4);
      const double rms = std::sqrt(squares / frames);
      std::printf("[ MEASURED ] %s, moving: s' %.2f cm/s, tissue %.2f, ring %.2f; RMS %.2f\n",
                  std::string(nameOf(ring)).c_str(), 100 * peak.measured, 100 * peak.tissue,
                  100 * peak.ring, 100 * rms);
      EXPECT_GT(peak.ring, 0.06);
      EXPECT_LT(rms, 0.06 * peak.ring);
      EXPECT_NEAR(peak.measured, peak.tissue, 0.06 * peak.ring);
      EXPECT_NEAR(peak.measured, peak.ring, 0.15 * peak.ring);
    }
  });
}

// The sample volume stands still, and the ring moves out of it towards the apex: the tissue behind
// the ring is slower.
TEST(DopplerHeart, ASampleVolumeThatStandsStillShowsLess) {
  const DopplerRequest request;
  withThreads(0, [&] {
    for (const MModeTarget ring :
         support::casesOf<MModeTarget>({std::begin(kRings), std::end(kRings)}, 1)) {
      const SpectrumRequest wanted = ringRequest(ring);
      const Simulator simulator(spectrumScene(shippedHeart(), request, wanted));
      const Spectrum made =
          makeSpectrum(simulator, request, wanted, simulator.referenceIntensity(), {});
      std::printf("[ MEASURED ] %s, spectrum: s' %.2f cm/s, ring %.2f\n",
                  std::string(nameOf(ring)).c_str(), 100 * made.mean_peak, 100 * made.exact_peak);
      EXPECT_GT(made.mean_peak, 0.75 * made.exact_peak);
      EXPECT_LT(made.mean_peak, 1.02 * made.exact_peak);
    }
  });
}

}  // namespace
}  // namespace echocine
