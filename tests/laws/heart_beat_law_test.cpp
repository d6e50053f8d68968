// The parametric heart's own volume curve: its phases are found again in the volumes that its
// ventricle encloses, at slow, usual and fast heart rates.

#include <gtest/gtest.h>

#include <functional>

#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;

// The left ventricle's cavity at any phase, without all that lies round it.
class BeatingVentricle {
 public:
  explicit BeatingVentricle(const Dials& dials)
      : parameters_(heart::parametersFrom(dials)), cycle_(parameters_), left_(parameters_) {}

  double millilitres(double phase) {
    left_.contract(cycle_.at(phase).left);
    const auto point = [this](Vec3d d) { return left_.cavityPoint(d); };
    return 1e6 * fluxVolume({heart::pointsOn(sphere_, point), sphere_.faces});
  }
  double atRest() { return millilitres(0); }
  const heart::Cycle& cycle() const { return cycle_; }
  double beat() const { return cycle_.durations().beat(); }

 private:
  heart::Parameters parameters_;
  heart::Cycle cycle_;
  heart::LeftVentricle left_;
  heart::SphereMesh sphere_ = heart::geodesicSphere(12);
};

// The phase in [low, high] where a monotone curve passes a value, to a thousandth of a beat.
double crossing(double low, double high, double value, const std::function<double(double)>& curve) {
  const bool rises = curve(high) > curve(low);
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high);
    ((curve(middle) < value) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Means and standard deviations, ms: ejection by the regressions of rest (50 and 75 bpm, 379 - 1.8
// HR, sd 11) and exercise (120 bpm, 371 - 1.2 HR, sd 14); isovolumic phases of the Copenhagen City
// Heart Study (40 +- 10, 96 +- 19).
struct Published {
  double bpm, ejection_ms, ejection_sd_ms;
};

class HeartBeatLaw : public testing::TestWithParam<Published> {};

// A curve that starts level is seen to have started late, and one that ends level to have ended
// early: 0.03 % of the stroke volume are ejected and filled within 3 ms, and the last 0.03 % take
// 12 ms, since flow fades out.
constexpr double kSeenShare = 3e-4, kLate_ms = 4, kEarly_ms = 14;

TEST_P(HeartBeatLaw, DurationsAreFoundAgainInTheVolumes) {
  const Published& row = GetParam();
  BeatingVentricle ventricle({{"hr", row.bpm}});
  const auto volume = [&](double phase) { return ventricle.millilitres(phase); };
  const double closes = ventricle.cycle().events().aortic_closes;
  const double full = ventricle.atRest(), empty = volume(closes), stroke = full - empty;
  const double opens = crossing(0, closes, full - kSeenShare * stroke, volume);
  const double shuts = crossing(0, closes, empty + kSeenShare * stroke, volume);
  const double fills = crossing(closes, 0.999, empty + kSeenShare * stroke, volume);
  const double to_ms = 1e3 * ventricle.beat();
  EXPECT_NEAR(opens * to_ms, 40, 10 + kLate_ms);
  EXPECT_NEAR((shuts - opens) * to_ms, row.ejection_ms, row.ejection_sd_ms + kEarly_ms);
  EXPECT_NEAR((fills - shuts) * to_ms, 96, 19 + kEarly_ms);
  // Against the heart's own account, much closer.
  const PhaseDurations& told = ventricle.cycle().durations();
  EXPECT_NEAR(opens * to_ms, 1e3 * told.isovolumic_contraction_s, kLate_ms);
  EXPECT_NEAR((shuts - opens) * to_ms, 1e3 * told.ejection_s, kEarly_ms);
  EXPECT_NEAR((fills - closes) * to_ms, 1e3 * told.isovolumic_relaxation_s, kLate_ms);
  std::printf("%3.0f bpm: contraction %.0f, ejection %.0f, relaxation %.0f ms\n", row.bpm,
              opens * to_ms, (shuts - opens) * to_ms, (fills - shuts) * to_ms);
}

TEST_P(HeartBeatLaw, TheVolumeStandsStillFallsStandsStillAndRises) {
  BeatingVentricle ventricle({{"hr", GetParam().bpm}});
  const double full = ventricle.atRest(), constant = 0.003 * full;
  const CycleEvents& e = ventricle.cycle().events();
  const double empty = ventricle.millilitres(e.aortic_closes);
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    EXPECT_NEAR(ventricle.millilitres(share * e.aortic_opens), full, constant) << share;
    const double relaxing = std::lerp(e.aortic_closes, e.mitral_opens, share);
    EXPECT_NEAR(ventricle.millilitres(relaxing), empty, constant) << share;
  }
  double before = full;
  for (int i = 1; i <= 12; ++i) {
    const double now = ventricle.millilitres(std::lerp(e.aortic_opens, e.aortic_closes, i / 12.0));
    EXPECT_LT(now, before + 1e-3 * full) << i;
    before = now;
  }
  for (int i = 1; i <= 20; ++i) {
    const double now = ventricle.millilitres(std::lerp(e.mitral_opens, 1 - 1e-6, i / 20.0));
    EXPECT_GT(now, before - 1e-3 * full) << i;  // so the curve has one minimum, a plateau
    before = now;
  }
  EXPECT_NEAR(before, full, constant);
}

INSTANTIATE_TEST_SUITE_P(Rates, HeartBeatLaw,
                         testing::Values(Published{50, 289, 11}, Published{75, 244, 11},
                                         Published{120, 227, 14}));

// At rest about 70 % of the stroke volume come in rapid filling, 20 in diastasis, 10 by the kick.
TEST(HeartBeat, FillingSharesAtRestAreThePublishedOnes) {
  BeatingVentricle ventricle({{"hr", 65}});
  const CycleEvents& e = ventricle.cycle().events();
  const double full = ventricle.atRest(), empty = ventricle.millilitres(e.aortic_closes);
  const double after_rapid = ventricle.millilitres(e.diastasis_begins),
               before_kick = ventricle.millilitres(e.atrial_kick_begins), stroke = full - empty;
  EXPECT_NEAR((after_rapid - empty) / stroke, 0.70, 0.03);
  EXPECT_NEAR((before_kick - after_rapid) / stroke, 0.20, 0.03);
  EXPECT_NEAR((full - before_kick) / stroke, 0.10, 0.02);
}

TEST(HeartBeat, TheAtrialShareIsTheDialledOne) {
  BeatingVentricle ventricle({{"hr", 65}, {"atrial-share", 0.35}});
  const CycleEvents& e = ventricle.cycle().events();
  const double full = ventricle.atRest(), empty = ventricle.millilitres(e.aortic_closes);
  EXPECT_NEAR((full - ventricle.millilitres(e.atrial_kick_begins)) / (full - empty), 0.35, 0.01);
}

}  // namespace
}  // namespace echocine
