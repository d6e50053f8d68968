// A loop against itself, and against itself changed in a known way: the comparison finds what was
// done to it.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "compare/compare.h"
#include "compare/frame_discrepancy.h"
#include "compare/results.h"
#include "core/parallel.h"
#include "support/all_cases.h"
#include "support/cine_frames.h"
#include "support/echo_video.h"
#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine::compare {

using namespace echo;
namespace {

using namespace support;

class Planted : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::vector<PixelPlane> drawn = drawnLoop(Drawing{});
    writeLossless(folder / "plain.avi", drawn, plain.width, plain.height);
  }

  Comparison against(const Drawing& changed, bool sectors_known = true,
                     CompareOptions options = {}) {
    writeLossless(folder / "changed.avi", changed);
    options.synthetic = folder / "plain.avi";
    options.real = folder / "changed.avi";
    if (sectors_known) {  // both: the planted change is then all that is left
      options.synthetic_side.sector = options.real_side.sector = "160,5,-40,40,12,225";
    }
    Comparison c;
    withThreads(2, [&] { c = compareLoops(options); });
    return c;
  }
  const Drawing plain{};
  TempFolder folder;
};

TEST_F(Planted, ItselfIsPerfect) {
  for (const bool known : casesOf<bool>({false, true}, 1)) {
    const Comparison c = against(plain, known);
    for (const FrameResult& f : c.frames) {
      EXPECT_EQ(f.before.rms, 0);
      EXPECT_EQ(f.before.ncc, 1);
      EXPECT_NEAR(f.before.ssim, 1, 1e-9);
      EXPECT_NEAR(f.synthetic_place, f.real_frame, 1e-9);
    }
    EXPECT_LT(c.discrepancy, 1e-4);
    EXPECT_EQ(c.space.used, false);
    EXPECT_EQ(c.time.shift_frames, 0);
  }
}

TEST_F(Planted, HalfAFrameOfTimeIsFound) {
  for (const double shift : casesOf<double>({5.5, 0.5}, 1)) {
    Drawing d = plain;
    d.time_shift = shift;
    const Comparison c = against(d);
    EXPECT_NEAR(std::remainder(c.time.shift_frames - shift, 24), 0, 0.1);
    EXPECT_GT(c.time.confidence, 0.8);
    std::printf("time shift %.1f frames found as %.3f\n", shift, c.time.shift_frames);
  }
}

TEST_F(Planted, APixelOfShiftIsFound) {
  Drawing d = plain;
  d.shift_x = 1;
  d.shift_y = -1;
  const Comparison c = against(d);
  EXPECT_TRUE(c.space.used);
  EXPECT_NEAR(c.space.placement.shift_x_px, 1, 0.1);
  EXPECT_NEAR(c.space.placement.shift_y_px, -1, 0.1);
  EXPECT_NEAR(c.space.placement.scale, 1, 0.001);
  EXPECT_LT(c.discrepancy, 1 - 0.995 * c.overlap);
  std::printf("shift (1, -1) px found as (%.3f, %.3f)\n", c.space.placement.shift_x_px,
              c.space.placement.shift_y_px);
}

TEST_F(Planted, OnePerCentOfScaleIsFound) {
  for (const double scale : casesOf<double>({1.01, 0.99}, 1)) {
    Drawing d = plain;  // about the apex, so that no shift comes with it
    d.scale = scale;
    d.shift_x = 160 * (1 - scale);
    d.shift_y = 5 * (1 - scale);
    const Comparison c = against(d);
    EXPECT_NEAR(c.space.placement.scale, scale, 0.001);
    EXPECT_LT(std::hypot(c.space.placement.shift_x_px, c.space.placement.shift_y_px), 0.15);
    std::printf("scale %.2f found as %.5f\n", scale, c.space.placement.scale);
  }
}

// With nobody telling the sectors: found, and the rest registered, they carry the whole change.
TEST_F(Planted, FoundSectorsAndRegistrationTogetherCarryTheChange) {
  Drawing d = plain;
  d.scale = 1.01;
  d.shift_x = -2.5;
  d.shift_y = 1;
  const Comparison c = against(d, false);
  const Placement& p = c.space.placement;
  const double px_per_px = p.scale * c.real.sector().r_max / c.synthetic.sector().r_max;
  EXPECT_NEAR(px_per_px, 1.01, 0.002);
  const auto carried = [&](double x, double y) {  // a point of the plain picture in the changed one
    const Sector &s = c.synthetic.sector(), &r = c.real.sector();
    const double dx = x - s.apex_x, dy = y - s.apex_y, angle = std::atan2(dx, dy) + p.rotation_rad;
    const double radius = px_per_px * std::hypot(dx, dy);
    return PicturePoint{r.apex_x + p.shift_x_px + radius * std::sin(angle),
                        r.apex_y + p.shift_y_px + radius * std::cos(angle)};
  };
  for (const auto& [x, y] :
       {std::pair(165.0, 115.0), std::pair(120.0, 70.0), std::pair(200.0, 180.0)}) {
    EXPECT_NEAR(carried(x, y).x, 1.01 * x - 2.5, 0.3);
    EXPECT_NEAR(carried(x, y).y, 1.01 * y + 1, 0.3);
  }
}

TEST_F(Planted, TheGreyCurveIsFound) {
  Drawing d = plain;
  d.gamma = 0.6;
  CompareOptions options;
  options.knot_count = 16;
  options.monotone = true;
  const Comparison c = against(d, true, options);
  double worst = 0;
  for (std::size_t i = 1; i + 1 < c.curve.knots.size(); ++i)
    worst =
        std::max(worst, std::abs(c.curve.values[i] - 255 * std::pow(c.curve.knots[i] / 255, 0.6)));
  EXPECT_LT(worst, 3);
  EXPECT_GT(c.mean_before.rms, 20);
  EXPECT_LT(c.mean_after.rms, 2);
  std::printf("gamma 0.6: curve within %.2f greys, RMS %.2f before, %.2f after\n", worst,
              c.mean_before.rms, c.mean_after.rms);
}

TEST_F(Planted, NoiseIsMeasuredAndMovesNothing) {
  Drawing d = plain;
  d.noise = 6;
  const Comparison c = against(d);
  // Bilinear sampling anywhere between pixels averages noise: its squared weights are 4/9 in the
  // mean.
  EXPECT_NEAR(c.mean_before.rms, 6 * 2.0 / 3, 0.2);
  EXPECT_LT(std::hypot(c.space.placement.shift_x_px, c.space.placement.shift_y_px), 0.1);
  EXPECT_NEAR(std::remainder(c.time.shift_frames, 24), 0, 0.1);
  EXPECT_LT(c.discrepancy, 0.1);
}

// The call without files: the drawing in beam space as a tracer would hand it over.
TEST_F(Planted, TheCallWithoutFilesIsLeastAtTheRightInstant) {
  SideOptions side;
  side.mm_per_pixel = 0.5;
  const EchoLoop real = readLoop(folder / "plain.avi", side, true);
  Probe probe;
  probe.first_angle_rad = plain.sector.first_rad;
  probe.last_angle_rad = plain.sector.last_rad;
  probe.min_depth_m = 5e-4 * plain.sector.r_min;
  probe.max_depth_m = 5e-4 * plain.sector.r_max;
  probe.lines = 160;
  probe.samples = 500;
  const auto beams = [&](double phase) {
    std::vector<float> grey;
    for (int i = 0; i < probe.lines; ++i)
      for (int k = 0; k < probe.samples; ++k) {
        const double angle =
            probe.first_angle_rad + (probe.last_angle_rad - probe.first_angle_rad) * i / 159;
        const double r = (probe.min_depth_m + (k + 0.5) * probe.sampleSpacing()) / 5e-4;
        grey.push_back(static_cast<float>(std::pow(
            ringGrey(plain, 160 + r * std::sin(angle), 5 + r * std::cos(angle), phase), 0.7)));
      }
    return grey;
  };
  std::vector<double> values;
  withThreads(2, [&] {
    FrameDiscrepancy d(real, probe);
    EXPECT_EQ(d.realFrames(), 24);
    for (int j = 0; j < 24; j += 3) values.push_back(d(3, beams(j / 24.0)));
  });
  const auto least = std::min_element(values.begin(), values.end());
  EXPECT_EQ(least - values.begin(), 1);  // frame 3 of 24
  EXPECT_LT(*least, 0.05);
  EXPECT_GT(values[4], 5 * *least);
}

// One method whatever the noise: greys that hardly correlate are registered as those that do.
TEST_F(Planted, TheShiftIsFoundHoweverLikeTheLoopsAre) {
  for (const double noise : casesOf<double>({200, 20}, 1)) {
    Drawing d = plain;
    d.shift_x = 5;
    d.shift_y = -3;
    d.noise = noise;
    const Comparison c = against(d);
    EXPECT_NEAR(c.space.placement.shift_x_px, 5, 0.005 * noise) << noise;
    EXPECT_NEAR(c.space.placement.shift_y_px, -3, 0.005 * noise) << noise;
    EXPECT_GT(c.space.confidence, 0.15) << noise;
    std::printf(
        "shift (5, -3) px under noise of %.0f greys found as (%.2f, %.2f), NCC %.2f, "
        "confidence %.2f\n",
        noise, c.space.placement.shift_x_px, c.space.placement.shift_y_px, c.mean_before.ncc,
        c.space.confidence);
  }
}

// Noise alone lies as well anywhere: the confidence says so, and rivals are told.
TEST_F(Planted, ALoopWithoutTheHeartIsRegisteredWithoutConfidence) {
  Drawing d = plain;
  d.gamma = 30;  // black
  d.noise = 60;
  const Comparison c = against(d);
  EXPECT_LT(c.space.confidence, 0.15);
  ASSERT_FALSE(c.space.rivals.empty());
  EXPECT_GE(c.space.rivals.front().unlike, c.space.unlike);
  const auto space = summaryJson(c).at("space");
  EXPECT_EQ(space.at("rivals").size(), c.space.rivals.size());
  std::printf("noise alone: confidence %.3f, %zu rivals\n", c.space.confidence,
              c.space.rivals.size());
}

// Farther than the slope of one hill leads: the lattice finds the view.
TEST_F(Planted, AViewFarOffIsSearchedForAndFound) {
  Drawing d = plain;
  d.shift_x = 16;
  d.shift_y = 24;
  d.noise = 4;
  const Comparison c = against(d);
  EXPECT_TRUE(c.space.used);
  EXPECT_FALSE(c.space.at_limit);
  EXPECT_NEAR(c.space.placement.shift_x_px, 16, 0.5);
  EXPECT_NEAR(c.space.placement.shift_y_px, 24, 0.5);
  EXPECT_LT(c.overlap, 1);
  EXPECT_LT(c.discrepancy, 1 - 0.8 * c.overlap);
  EXPECT_GT(c.discrepancy_as_placed, 2 * c.discrepancy);
  std::printf("shift (16, 24) px found as (%.2f, %.2f), D %.3f from %.3f\n",
              c.space.placement.shift_x_px, c.space.placement.shift_y_px, c.discrepancy,
              c.discrepancy_as_placed);
}

TEST_F(Planted, MoreOfAnyChangeIsMoreDiscrepancy) {
  CompareOptions options;
  options.align_space = false;
  options.real_side.ed_frame = options.synthetic_side.ed_frame = 0;  // as one would time it
  struct Change {
    const char* what;
    std::function<void(Drawing&, double)> to;
    std::vector<double> amounts;
    double at_least = 0;  // of the largest
  };
  const Change changes[] = {
      {"shift", [](Drawing& d, double a) { d.shift_x = a; }, casesOf<double>({8, 4, 2}, 1), 0.2},
      {"noise", [](Drawing& d, double a) { d.noise = a; }, casesOf<double>({60, 20}, 1)},
      {"scale", [](Drawing& d, double a) { d.scale = a; }, casesOf<double>({1.05, 1.02}, 1)},
      {"time", [](Drawing& d, double a) { d.time_shift = a; }, casesOf<double>({6, 3}, 1)},
  };
  const double unchanged = against(plain, true, options).discrepancy;
  for (Change change : changes) {
    std::sort(change.amounts.begin(), change.amounts.end());
    double last = unchanged;
    for (const double amount : change.amounts) {
      Drawing d = plain;
      change.to(d, amount);
      const double now = against(d, true, options).discrepancy;
      EXPECT_GT(now, last) << change.what << " " << amount;
      EXPECT_LT(now, 2);
      last = now;
    }
    EXPECT_GT(last, change.at_least) << change.what;
  }
}

TEST_F(Planted, ThreadsChangeNothing) {
  Drawing d = plain;
  d.shift_x = 1;
  d.noise = 4;
  writeLossless(folder / "changed.avi", d);
  CompareOptions options;
  options.synthetic = folder / "plain.avi";
  options.real = folder / "changed.avi";
  std::vector<std::string> csv;
  for (const int threads : {1, 4})
    withThreads(threads, [&] { csv.push_back(framesCsv(compareLoops(options))); });
  EXPECT_EQ(csv[0], csv[1]);
}

}  // namespace
}  // namespace echocine::compare
