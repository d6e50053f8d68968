// Tissue Doppler of scenes: against truth, and as files.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "doppler/colour_overlay.h"
#include "doppler/doppler_files.h"
#include "motion/cycle/cardiac_clock.h"
#include "plan/loop_plan.h"
#include "support/exr_planes.h"
#include "support/loop_scene.h"
#include "support/moving_plate.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

// A plate in blood: z = 60 mm - stroke (1 - cos(2 pi phase)) / 2, one beat a second.
constexpr int kPlateKeys = 20;

Scene plateScene(const TempFolder& folder, double stroke_mm, const std::string& extra = "") {
  writePlates(folder, kPlateKeys, stroke_mm, 1.5);
  SceneText text;
  text.background = "blood";
  text.probe["lines"] = "24";
  text.probe["samples"] = "400";
  text.probe["sector_deg"] = "30";
  text.motion["interpolation"] = "\"fourier\"";
  text.acquisition["frame_rate_hz"] = "20";
  text.addStructure("plate", "myocardium", "\"plate_*.obj\"");
  text.extra = extra;
  return readScene(folder.write("scene.toml", text.text()));
}

// Mean over the plate of a frame, weighted by power.
struct PlateMean {
  double measured = 0, exact = 0, shown = 0;
};
PlateMean plateMean(const DopplerFrame& frame, double nyquist) {
  PlateMean mean;
  double weight = 0, exact_samples = 0, off = 0;
  for (std::size_t i = 0; i < frame.exact_m_s.size(); ++i) {
    const auto exact = static_cast<double>(frame.exact_m_s[i]);
    EXPECT_EQ(std::isnan(exact), std::isnan(static_cast<double>(frame.measured.velocity_m_s[i])));
    if (std::isnan(exact)) continue;
    const auto power = static_cast<double>(frame.measured.power[i]);
    const auto measured = static_cast<double>(frame.measured.velocity_m_s[i]);
    weight += power;
    off += power * std::remainder(measured - exact, 2 * nyquist);
    mean.shown += power * measured;
    mean.exact += exact;
    ++exact_samples;
  }
  EXPECT_GT(exact_samples, 500);
  mean.exact /= exact_samples;
  mean.measured = mean.exact + off / weight;
  mean.shown /= weight;
  return mean;
}

TEST(Doppler, APlateHasTheVelocityOfItsClosedForm) {
  constexpr double kStroke_mm = 8;
  TempFolder folder;
  const Scene scene = plateScene(folder, kStroke_mm);
  const DopplerRequest request;
  const Simulator simulator(dopplerScene(scene, request));
  const double nyquist = nyquistVelocity(scene.probe, request.prf_hz);
  double worst = 0;
  withThreads(0, [&] {
    for (const int frame : {2, 5, 9, 14, 17}) {
      const DopplerFrame made =
          makeDopplerFrame(simulator, request, frame, simulator.referenceIntensity());
      const double closed =
          1e-3 * kStroke_mm * std::numbers::pi * std::sin(2 * std::numbers::pi * made.time.phase);
      const PlateMean mean = plateMean(made, nyquist);
      // The lines are up to 15 degrees oblique: the mean cosine over them is 0.989.
      EXPECT_NEAR(mean.exact, 0.989 * closed, 0.0005) << frame;
      EXPECT_NEAR(mean.measured, mean.exact, 0.02 * nyquist) << frame;
      worst = std::max(worst, std::abs(mean.measured - mean.exact) / nyquist);
    }
  });
  std::printf("[ MEASURED ] plate: bias at most %.4f of Nyquist\n", worst);
}

// At a low pulse rate the same plate is faster than v_N: its shown velocity is 2 v_N off.
TEST(Doppler, APlateAliasesWhereItMust) {
  TempFolder folder;
  const Scene scene = plateScene(folder, 20);
  DopplerRequest request;
  request.prf_hz = 260;
  request.pulses = 3;
  const Simulator simulator(dopplerScene(scene, request));
  const double nyquist = nyquistVelocity(scene.probe, request.prf_hz);
  withThreads(0, [&] {
    const double white = simulator.referenceIntensity();
    const PlateMean fast = plateMean(makeDopplerFrame(simulator, request, 5, white), nyquist);
    EXPECT_GT(fast.exact, 1.4 * nyquist);
    EXPECT_NEAR(fast.shown, fast.exact - 2 * nyquist, 0.1 * nyquist);
    EXPECT_NEAR(fast.measured, fast.exact, 0.05 * nyquist);
  });
}

TEST(Doppler, ASpectrumFollowsThePlate) {
  TempFolder folder;
  const Scene scene = plateScene(folder, 8);
  DopplerRequest request;
  request.prf_hz = 500;
  SpectrumRequest spectrum;
  spectrum.at.depth_m = 0.062;
  spectrum.step_s = 0.02;
  const Simulator simulator(spectrumScene(scene, request, spectrum));
  withThreads(0, [&] {
    const Spectrum made =
        makeSpectrum(simulator, request, spectrum, simulator.referenceIntensity(), {});
    ASSERT_EQ(made.columns, 50);
    ASSERT_EQ(made.power.size(), static_cast<std::size_t>(made.columns * made.bins));
    const double bin = 2 * made.nyquist_m_s / made.bins;
    double sum = 0, squares = 0;
    for (std::size_t t = 3; t + 3 < 50; ++t) {
      const double closed =
          8e-3 * std::numbers::pi * std::sin(2 * std::numbers::pi * made.times[t].phase);
      EXPECT_NEAR(made.exact_m_s[t], closed, 0.0006) << t;
      const double off = made.mean_m_s[t] - closed;
      EXPECT_LT(std::abs(off), 0.1 * made.nyquist_m_s) << t;
      sum += off / made.nyquist_m_s;
      squares += off * off / (made.nyquist_m_s * made.nyquist_m_s);
      const auto column = made.power.begin() + static_cast<std::ptrdiff_t>(t) * made.bins;
      const auto peak = std::max_element(column, column + made.bins) - column;
      const double at = made.nyquist_m_s * (2 * (static_cast<double>(peak) + 0.5) / made.bins - 1);
      EXPECT_NEAR(at, closed, 8 * bin) << t;
    }
    EXPECT_LT(std::abs(sum / 44), 0.02);
    EXPECT_LT(std::sqrt(squares / 44), 0.03);
    std::printf("[ MEASURED ] spectrum: bias %.4f, RMS %.4f of Nyquist\n", sum / 44,
                std::sqrt(squares / 44));
  });
}

// The mean of a spectrum is that of the velocity, weighted by the squared window about its instant.
// At the start of the loop half of the window remains, the half that falls.
TEST(Doppler, AtTheStartOfALoopTheWindowFallsFromItsMiddle) {
  TempFolder folder;
  DopplerRequest request;
  request.prf_hz = 500;
  SpectrumRequest wanted;
  wanted.at.depth_m = 0.062;
  wanted.window_s = 0.2;
  wanted.step_s = 0.5;
  const Simulator simulator(spectrumScene(plateScene(folder, 8), request, wanted));
  withThreads(0, [&] {
    const Spectrum made =
        makeSpectrum(simulator, request, wanted, simulator.referenceIntensity(), {});
    // The circular mean is the phase of the windowed pulses' autocorrelation.
    std::complex<double> mean;
    for (int b = 0; b < made.bins; ++b)
      mean += std::polar(static_cast<double>(made.power[static_cast<std::size_t>(b)]),
                         std::numbers::pi * (2 * (b + 0.5) / made.bins - 1));
    const double measured = std::arg(mean) / std::numbers::pi * made.nyquist_m_s;
    double squares = 0, closed = 0;
    for (double t = 0; t < 0.5 * wanted.window_s; t += 1e-4) {
      const double h = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * t / wanted.window_s);
      squares += h * h;
      closed += h * h * 8e-3 * std::numbers::pi * std::sin(2 * std::numbers::pi * t);
    }
    // Grain leaves an RMS of 0.0013; a window that rises would give 0.012.
    EXPECT_NEAR(measured, closed / squares, 0.003);
    std::printf("[ MEASURED ] mean velocity at the start %.4f, closed form %.4f m/s\n", measured,
                closed / squares);
  });
}

// Another run into the folder leaves nothing of an earlier one that it does not replace, and one
// that cannot be made leaves the earlier one.
TEST(Doppler, ARunLeavesNoSpectrumOfAnEarlierOne) {
  TempFolder folder;
  const Scene scene = plateScene(folder, 8);
  DopplerOptions options;
  options.folder = folder / "out";
  options.request.prf_hz = 400;
  options.request.pulses = 3;
  options.spectrum.emplace().at.depth_m = 0.065;
  writeDoppler(scene, options);
  const std::string whole = bytesOf(options.folder / "doppler.json");
  const char* const parts[] = {"spectrum.csv.0123abcd.part", "doppler.gif.0123abcd.part",
                               "velocity/frame_0007.exr.0123abcd.part"};
  for (const char* part : parts) folder.write(std::string("out/") + part, "half");
  options.spectrum->at.place = 1;  // rad, outside the sector
  EXPECT_THROW(writeDoppler(scene, options), SceneError);
  EXPECT_EQ(bytesOf(options.folder / "doppler.json"), whole);
  options.spectrum.reset();
  writeDoppler(scene, options);
  EXPECT_FALSE(std::filesystem::exists(options.folder / "spectrum.csv"));
  for (const char* part : parts)
    EXPECT_FALSE(std::filesystem::exists(options.folder / part)) << part;
  EXPECT_TRUE(std::filesystem::exists(options.folder / "doppler.json"));
}

// Colours: the sign and the wrap.
TEST(Doppler, ColoursRunFromBlueToRedAndWrap) {
  const GreyColours colours = dopplerColours();
  EXPECT_EQ(colourIndex(0.25, 0.1), colourIndex(0.05, 0.1));
  EXPECT_EQ(colourIndex(0.12, 0.1), colourIndex(-0.08, 0.1));
  for (const double v : {0.01, 0.05, 0.099}) {
    const PaletteColour towards = colours[colourIndex(v, 0.1)],
                        away = colours[colourIndex(-v, 0.1)];
    EXPECT_GT(towards.red, towards.blue);
    EXPECT_GT(away.blue, away.red);
  }
}

TEST(Doppler, TheFilesAreWholeAndDoNotDependOnThreads) {
  TempFolder folder;
  const Scene scene = plateScene(folder, 8, "[artefacts]\nnoise_db = -50\n");
  std::string first;
  for (const int threads : {1, 3}) {
    DopplerOptions options;
    options.folder = folder / ("t" + std::to_string(threads));
    options.threads = threads;
    options.png = true;
    options.request.prf_hz = 400;
    options.request.pulses = 3;
    options.spectrum.emplace().at.depth_m = 0.065;
    const DopplerSummary made = writeDoppler(scene, options);
    EXPECT_EQ(made.frames, 20);
    EXPECT_LT(std::abs(made.bias_m_s), 0.02 * made.nyquist_m_s);
    std::string all;
    for (const char* name : {"velocity/frame_0007.exr", "velocity/frame_0007.png", "doppler.gif",
                             "spectrum.exr", "spectrum.png", "spectrum.csv", "doppler.json"})
      all += bytesOf(options.folder / name);
    if (first.empty()) first = all;
    EXPECT_TRUE(all == first) << threads;
  }
}

TEST(Doppler, RefusesWhatCannotBeMeasuredInOneLine) {
  TempFolder folder;
  plateScene(folder, 8);
  const auto refusal = [&](const std::string& options) {
    const Outcome o = runShell("%B doppler '" + (folder / "scene.toml").string() + "' -o '" +
                               (folder / "out").string() + "' " + options);
    EXPECT_EQ(o.code, 2) << options << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    return o.err;
  };
  EXPECT_NE(refusal("--prf 9000").find("--prf: 9000 Hz, accepted: 1 to 6416"), std::string::npos);
  EXPECT_NE(refusal("--prf nan").find("--prf"), std::string::npos);
  EXPECT_NE(refusal("--pulses 1").find("accepted with wall filter none: 2 to 64"),
            std::string::npos);
  EXPECT_NE(refusal("--pulses 3 --wall-filter line").find("--pulses: 3, accepted with"),
            std::string::npos);
  EXPECT_NE(refusal("--pulses 60 --prf 500").find("a frame takes 50 ms"), std::string::npos);
  EXPECT_NE(refusal("--depth 500").find("--depth: 500 mm, accepted: 2 to 120 mm"),
            std::string::npos);
  EXPECT_NE(refusal("--gate -1").find("--gate"), std::string::npos);
  EXPECT_NE(refusal("--through mitral-septal").find("role lv_"), std::string::npos);
  EXPECT_NE(refusal("--volume 3").find("--volume"), std::string::npos);
  refusal("--angle 3");
}

// Law: a pulse received on one line is that line of a pulse received on all, at any instant and
// after any other. Lung beside the line is that of the instant too.
TEST(Doppler, APulseOnOneLineIsThatOfAllLines) {
  for (const std::string medium : {"blood", "lung"}) {
    TempFolder folder;
    SceneText text = ballScene(10);
    text.structures.replace(text.structures.find("\"blood\""), 7, '"' + medium + '"');
    text.signal["look"] = "\"scanner\"";
    text.signal["reference_intensity"] = "1e-4";
    const Simulator simulator(dopplerScene(readScene(writeBall(folder, text)), {}));
    ASSERT_EQ(simulator.plan().effects.lung, medium == "lung");
    const int lines = simulator.scene().probe.lines;
    const auto samples = static_cast<std::size_t>(simulator.scene().probe.samples);
    for (const int frame : {0, 4, 2}) {
      const FrameTime at = simulator.cardiacClock().at(frame);
      const PulseField one = receivePulse(simulator, at, 1e-4, {14, 15}),
                       all = receivePulse(simulator, at, 1e-4, {0, lines});
      for (std::size_t i = 14 * samples; i < 15 * samples; ++i) {
        ASSERT_EQ(one.real[i], all.real[i]) << medium << " " << frame << " " << i;
        ASSERT_EQ(one.imaginary[i], all.imaginary[i]) << medium << " " << frame << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace echocine
