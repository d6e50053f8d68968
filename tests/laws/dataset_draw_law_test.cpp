// Draws of a dataset follow the distributions that they are drawn from, and depend on nothing else.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dataset/draws.h"
#include "motion/heart/heart_indices.h"

namespace echocine::dataset {
namespace {

constexpr int kDraws = 10000;
// sqrt(-ln(0.01 / 2) / 2): the Kolmogorov-Smirnov bound at 1 % over sqrt(n), for large n.
const double kBound = std::sqrt(-std::log(0.005) / 2) / std::sqrt(kDraws);

double numberOf(const TomlValue& value) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value);
}

// The largest distance between the draws' distribution and the wanted one.
template <typename Cumulative>
double farthest(std::vector<double> draws, const Cumulative& cumulative) {
  std::sort(draws.begin(), draws.end());
  double most = 0;
  const auto n = static_cast<double>(draws.size());
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double wanted = cumulative(draws[i]);
    most = std::max(
        {most, wanted - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - wanted});
  }
  return most;
}

Spec specOf(const std::string& rest) {
  return parseSpec("hearts = 20\nviews = [\"a4c\"]\n" + rest, "spec.toml");
}

// Written out here, not taken from the quantile functions that draw.
double cutNormal(double x, const Distribution& d) {
  const auto below = [&](double v) {
    return 0.5 * std::erfc((d.mean - v) / (d.sd * std::sqrt(2.0)));
  };
  return (below(x) - below(d.low)) / (below(d.high) - below(d.low));
}

TEST(DatasetDraws, EveryPopulationHasItsMarginals) {
  for (const std::string& name : populationNames()) {
    const Spec spec = specOf("[populations]\n" + name + " = 1\n");
    std::map<std::string, std::vector<double>> drawn;
    for (int i = 0; i < kDraws; ++i)
      for (const auto& [dial, value] : drawOf(spec, i, 0).values)
        if (dial.starts_with("heart.") && dial != "heart.rule")
          drawn[dial].push_back(numberOf(value));
    const DialDistributions wanted = builtInPopulation(name);
    const bool jointly = indexGroupOf(name).has_value();
    ASSERT_EQ(drawn.size(), wanted.size() + (jointly ? heart::kIndexDialCount + 1 : 0)) << name;
    for (const auto& [dial, distribution] : wanted) {
      // Amplitudes follow ejection fractions, which are normal but for their truncation.
      const double bound = jointly && dial.starts_with("segments.") ? 0.04 : kBound;
      EXPECT_LT(farthest(drawn["heart." + dial],
                         [&, &d = distribution](double x) { return cutNormal(x, d); }),
                bound)
          << name << ' ' << dial;
    }
  }
}

TEST(DatasetDraws, CorrelatedOnesKeepTheirMarginalsAndAreCorrelated) {
  const Spec spec = specOf(
      "[heart]\nedv = { normal = [120, 20], within = [40, 200] }\n"
      "ef = { uniform = [0.3, 0.7] }\n"
      "[[correlated]]\nparameters = [\"heart.edv\", \"heart.ef\"]\ncorrelations = [-0.6]\n");
  std::vector<double> edv, ef;
  double products = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Draw draw = drawOf(spec, i, 0);
    edv.push_back(numberOf(draw.values.at("heart.edv")));
    ef.push_back(numberOf(draw.values.at("heart.ef")));
    products += (edv.back() - 120) / 20 * (ef.back() - 0.5) / (0.4 / std::sqrt(12.0));
  }
  EXPECT_LT(farthest(ef, [](double x) { return (x - 0.3) / 0.4; }), kBound);
  const Distribution bell = Distribution::normal(120, 20, 40, 200);
  EXPECT_LT(farthest(edv, [&](double x) { return cutNormal(x, bell); }), kBound);
  // A normal z and a uniform U = Phi(z') of correlation r: cov(z, U) = r / (2 sqrt(pi)), over U's
  // standard deviation 1 / sqrt(12).
  const double wanted = -0.6 * std::sqrt(3 / 3.14159265358979323846);
  EXPECT_NEAR(products / kDraws, wanted, 4 / std::sqrt(kDraws));
}

TEST(DatasetDraws, ChoicesComeAsOftenAsTheirWeightsSay) {
  const Spec spec = specOf(
      "[scene.signal]\nlook = \"scanner\"\nquality = { choice = [\"good\", \"medium\", \"poor\"], "
      "weights = [57.6, 33.0, 9.4] }\n");
  std::map<std::string, int> counts;
  for (int i = 0; i < kDraws; ++i)
    ++counts[std::get<std::string>(drawOf(spec, i, 0).view_values[0].at("scene.signal.quality"))];
  for (const auto& [word, share] :
       {std::pair("good", 0.576), std::pair("medium", 0.330), std::pair("poor", 0.094)})
    EXPECT_NEAR(counts[word] / double(kDraws), share, 3 * std::sqrt(share * (1 - share) / kDraws));
}

TEST(DatasetDraws, AnotherParameterOrMoreHeartsChangeNoDraw) {
  const Spec few = specOf("[heart]\nedv = { uniform = [80, 160] }\n");
  Spec more = specOf("[heart]\nedv = { uniform = [80, 160] }\nhr = { uniform = [50, 90] }\n");
  more.hearts = 1000;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(drawOf(few, i, 0).values.at("heart.edv"), drawOf(more, i, 0).values.at("heart.edv"));
    EXPECT_NE(drawOf(few, i, 0).values.at("heart.edv"), drawOf(few, i, 1).values.at("heart.edv"));
  }
}

TEST(DatasetDraws, ViewsOfAHeartShareItAndDifferInTheProbe) {
  const Spec spec = parseSpec(
      "hearts = 2\nviews = [\"a2c\", \"a4c\"]\n[heart]\nedv = { uniform = [80, 160] }\n"
      "[offset]\ntilt_deg = { uniform = [-5, 5] }\n",
      "spec.toml");
  const Draw draw = drawOf(spec, 0, 0);
  ASSERT_EQ(draw.view_values.size(), 2u);
  EXPECT_EQ(draw.values.count("heart.edv"), 1u);
  EXPECT_NE(draw.view_values[0].at("offset.tilt_deg"), draw.view_values[1].at("offset.tilt_deg"));
}

TEST(DatasetDraws, ViewsOfAHeartShareItsValvesAndTrabeculae) {
  const Spec spec = parseSpec(
      "hearts = 2\nviews = [\"a2c\", \"a4c\"]\n"
      "[scene.trabeculae]\nheight_mm = { uniform = [0.5, 2] }\n"
      "[scene.leaflets]\nthickness_mm = { uniform = [1, 3] }\n"
      "[scene.speckle]\nheterogeneity_db = { uniform = [1, 5] }\n",
      "spec.toml");
  const Draw draw = drawOf(spec, 0, 0);
  for (const char* key : {"scene.trabeculae.height_mm", "scene.leaflets.thickness_mm"})
    EXPECT_EQ(draw.valuesOf(0).at(key), draw.valuesOf(1).at(key)) << key;
  EXPECT_NE(draw.valuesOf(0).at("scene.speckle.heterogeneity_db"),
            draw.valuesOf(1).at("scene.speckle.heterogeneity_db"));
}

TEST(DatasetDraws, TheQuantileUndoesTheDistributionFunction) {
  for (const double p : {1e-12, 1e-3, 0.25, 0.5, 0.9, 1 - 1e-9})
    EXPECT_NEAR(normalCumulative(normalQuantile(p)), p, 1e-14);
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
}

}  // namespace
}  // namespace echocine::dataset
