// The sampled beam has no grating lobe, so its main lobe ends where that of the centre frequency
// does.

#include <gtest/gtest.h>

#include "scene/sampled_beam.h"
#include "scene/scan_geometry.h"
#include "support/array_probe.h"

namespace echocine {
namespace {

// In focus a beam falls below a thousandth within three lambda / D, however wide its spectrum.
TEST(GratingLobeLaw, NoFrequencyOfThePulseHasOne) {
  Probe probe = support::arrayProbe();
  const double null = ScanGeometry(probe).wavelength() / probe.aperture_m;
  for (const double cycles : {0.7, 1.0, 2.0, 6.0})
    for (const Apodization receive : {Apodization::uniform, Apodization::hann})
      for (const bool harmonic : {false, true}) {
        probe.receive_apodization = receive;
        const SampledBeam beam(probe, cycles, harmonic);
        const auto profile = beam.at(0);
        EXPECT_LT(profile.mainLobe(), 3 * null) << cycles << harmonic;
        EXPECT_LT(0.5 - profile.integral(0.5), 2e-3) << cycles << harmonic;
        EXPECT_LT(profile.integral(2) - profile.integral(1), 1e-5) << cycles << harmonic;
      }
}

}  // namespace
}  // namespace echocine
