// The sums of splats on the grid against plain sums of Gaussians.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/units.h"
#include "metrics/statistics.h"
#include "scene/sampled_beam.h"
#include "speckle/coherent_ratio.h"
#include "speckle/spline_taps.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

struct Point {
  double line, sample, real, imaginary;
};

// A sector of 75 degrees, or a linear probe with 0.5 mm between lines.
SpeckleBed bedOf(ProbeKind kind, int lines, int samples, double spacing_m) {
  SpeckleBed bed(kind, lines, samples, 0.07, 0.07 + samples * spacing_m);
  if (kind == ProbeKind::phased) {
    bed.probe.first_angle_rad = -radiansFromDegrees(37.5);
    bed.probe.last_angle_rad = radiansFromDegrees(37.5);
  }
  return bed;
}

// Uniform over the picture, `per_cell` in sigma along times sigma across.
std::vector<Point> randomPoints(const Probe& probe, double per_cell, double cell) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Point> points(
      static_cast<std::size_t>(per_cell * probe.lines * probe.samples / cell));
  for (Point& p : points)
    p = {probe.lines * uniform(random), probe.samples * uniform(random), normal(random),
         normal(random)};
  return points;
}

SplatLists listsOf(const Probe& probe, const std::vector<Point>& points) {
  SplatLists lists;
  lists.start(probe.lines, {0, probe.lines});
  for (const Point& p : points) {
    BeamPlaces places{};
    places.line[0] = static_cast<float>(p.line);
    places.sample[0] = static_cast<float>(p.sample);
    places.real[0] = static_cast<float>(p.real);
    places.imaginary[0] = static_cast<float>(p.imaginary);
    lists.add(places, Ints8{-1});
  }
  lists.settle();
  return lists;
}

// I = |g|^2 / w: each sample from each point.
double plainRatio(const std::vector<Point>& points, int line, int sample, double lateral,
                  double axial) {
  double re = 0, im = 0, w = 0;
  for (const Point& p : points) {
    const double u = (p.line - 0.5 - line) / lateral, v = (p.sample - 0.5 - sample) / axial;
    if (u * u + v * v > 40) continue;
    const double h = std::exp(-0.5 * (u * u + v * v));
    re += h * p.real, im += h * p.imaginary, w += h * h;
  }
  return (re * re + im * im) / w;
}

struct SumCase {
  ProbeKind kind;
  int lines;
  double spacing_m;
  double shift_np_per_m_hz = 0;  // attenuation of the downshift
  double receive_f_number = 0;
};

PointSpread spreadOf(const Probe& probe, double shift_np_per_m_hz, double receive_f_number) {
  Scene scene = plainScene({medium("tissue", 1050, 1540)});
  scene.probe = probe;
  scene.signal.pulse_cycles = 2;
  scene.signal.beam_width = BeamWidth::profile;
  scene.signal.downshift = shift_np_per_m_hz > 0;
  scene.signal.nominal_gain_np_per_m_hz = shift_np_per_m_hz;
  scene.signal.receive_f_number = receive_f_number;
  return PointSpread(scene);
}

class SpeckleSumLaw : public testing::TestWithParam<SumCase> {};

TEST_P(SpeckleSumLaw, SumsOnTheGridAreSumsOfGaussians) {
  const SumCase& c = GetParam();
  const SpeckleBed bed = bedOf(c.kind, c.lines, static_cast<int>(0.02 / c.spacing_m), c.spacing_m);
  const PointSpread spread = spreadOf(bed.probe, c.shift_np_per_m_hz, c.receive_f_number);
  const BeamView view(bed.probe, spread);
  const auto pathOf = [&](int k) {
    return bed.probe.min_depth_m + (k + 0.5) * bed.probe.sampleSpacing();
  };
  const auto axial = [&](int k) {
    return spread.axial_m / bed.probe.sampleSpacing() /
           downshiftOf(bed.probe, 2, c.shift_np_per_m_hz, pathOf(k));
  };
  const auto lateral = [&](int k) { return view.lateralLines(pathOf(k)); };
  const std::vector<Point> points = randomPoints(bed.probe, 0.6, axial(0) * lateral(0));
  const CoherentRatio ratio(bed.probe, spread, view, 0);
  std::vector<float> seen = bed.even();
  CoherentRatio::Rows rows;
  ratio.apply(listsOf(bed.probe, points), rows, seen, {}, {0, bed.probe.lines});
  double squares = 0, n = 0;
  std::vector<double> errors_db;
  for (int i = 0; i < bed.probe.lines; i += 7)
    for (int k = 0; k < bed.probe.samples; k += 1 + bed.probe.samples / 60) {
      const double expected = plainRatio(points, i, k, lateral(k), axial(k));
      const double error =
          static_cast<double>(seen[static_cast<std::size_t>(i * bed.probe.samples + k)]) - expected;
      squares += error * error, n += 1;
      errors_db.push_back(std::abs(10 * std::log10(1 + error / expected)));
    }
  const bool grows = c.receive_f_number > 0;
  EXPECT_LT(quartilesOf(errors_db).median, grows ? 0.045 : 0.04);
  EXPECT_LT(10 * std::log10(1 + std::sqrt(squares / n)),
            grows ? 0.125 : 0.1);  // of the mean intensity, 1
}

// Two rows for three lines (phased), and taps that change along the line (the others).
TEST(SpeckleSumsLaw, SomeLinesAreThoseOfTheWhole) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear}) {
    const SpeckleBed bed(kind, 60, 200, 0.05, 0.09);
    const Speckle speckle = bed.speckle();
    const std::vector<float> whole = bed.picture(speckle);
    for (const LineRange lines :
         {LineRange{0, 1}, LineRange{5, 6}, LineRange{7, 29}, LineRange{58, 60}}) {
      std::vector<float> some = bed.even();
      speckle.apply(Affine{}, 0, some, {}, lines);
      const auto first = 200 * lines.first, end = 200 * lines.end;
      EXPECT_TRUE(std::equal(whole.begin() + first, whole.begin() + end, some.begin() + first))
          << static_cast<int>(kind) << " from line " << lines.first;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, SpeckleSumLaw,
                         testing::Values(SumCase{ProbeKind::phased, 240, 0.15625e-3},
                                         SumCase{ProbeKind::phased, 96, 0.15625e-3},
                                         SumCase{ProbeKind::phased, 256, 0.15625e-3},
                                         SumCase{ProbeKind::phased, 256, 0.3125e-3},
                                         SumCase{ProbeKind::phased, 600, 0.04e-3},
                                         SumCase{ProbeKind::phased, 256, 0.15625e-3, 12e-6},
                                         SumCase{ProbeKind::phased, 128, 0.3125e-3, 6e-6},
                                         SumCase{ProbeKind::phased, 256, 0.15625e-3, 6e-6, 20},
                                         SumCase{ProbeKind::phased, 256, 0.15625e-3, 0, 8},
                                         SumCase{ProbeKind::phased, 128, 0.3125e-3, 0, 8},
                                         SumCase{ProbeKind::linear, 96, 0.15625e-3, 0, 8},
                                         SumCase{ProbeKind::linear, 60, 0.15625e-3, 6e-6},
                                         SumCase{ProbeKind::linear, 60, 0.15625e-3},
                                         SumCase{ProbeKind::linear, 96, 0.05e-3},
                                         SumCase{ProbeKind::curvilinear, 128, 0.1e-3}));

}  // namespace
}  // namespace echocine
