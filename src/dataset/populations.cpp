#include "dataset/populations.h"

#include <algorithm>
#include <charconv>

#include "core/check.h"

namespace echocine::dataset {

namespace {

// Mean, SD and where the bell is cut off. Cut-offs are our choice: within about 2.5 SD, and on the
// population's side of what defines it.
struct Row {
  const char *population, *dial;
  double mean, sd, low, high;
  const char* source;
};

constexpr const char* kOurs = "our choice";
constexpr const char* kLang = "Lang et al., J. Am. Soc. Echocardiogr. 28, 1-39, 2015";
constexpr const char* kPinto = "Pinto et al., Eur. Heart J. 37, 1850-1858, 2016: EF under 45 %";
constexpr const char* kElliott = "Elliott et al., Eur. Heart J. 35, 2733-2779, 2014: 15 mm or more";
constexpr const char* kMcDonagh =
    "McDonagh et al., Eur. Heart J. 42, 3599-3726, 2021: EF of 40 % or less";
constexpr const char* kBax = "Bax et al., J. Am. Coll. Cardiol. 44, 1834-1840, 2004: 65 ms or more";

// Where only a definition is cited, mean and SD are our choice on its side. The dials of
// heart::kIndexDials and the body scale of healthy hearts and infarcts are drawn jointly
// (index_draws.h). Rows of amplitudes are then of the copula in draws.cpp.
constexpr Row kRows[] = {
    {"healthy", "hr", 65, 9, 48, 90, kOurs},
    {"healthy", "la-volume", 45, 10, 28, 64, kLang},
    {"dilated", "hr", 76, 11, 55, 108, kOurs},
    {"dilated", "edv", 205, 40, 140, 310, kPinto},
    {"dilated", "ef", 0.30, 0.08, 0.14, 0.449, kPinto},
    {"dilated", "wall-thickness", 8.5, 1, 6.5, 11, kOurs},
    {"dilated", "la-volume", 78, 18, 45, 125, kOurs},
    {"dilated", "sphericity", 0.69, 0.05, 0.60, 0.80, kOurs},
    {"dilated", "body-scale", 1.05, 0.04, 0.96, 1.14, kOurs},
    {"hypertrophic", "hr", 66, 9, 48, 90, kOurs},
    {"hypertrophic", "edv", 88, 17, 55, 130, kOurs},
    {"hypertrophic", "ef", 0.67, 0.05, 0.55, 0.77, kOurs},
    {"hypertrophic", "wall-thickness", 16.5, 1.4, 15, 20, kElliott},
    {"hypertrophic", "la-volume", 66, 15, 38, 105, kOurs},
    {"hypertrophic", "sphericity", 0.57, 0.04, 0.49, 0.66, kOurs},
    {"infarct_lad", "hr", 70, 10, 50, 96, kOurs},
    {"infarct_lad", "segments.lad.amplitude", 0.1, 0.25, -0.3, 0.8, kOurs},
    {"infarct_rca", "hr", 68, 10, 48, 94, kOurs},
    {"infarct_rca", "segments.rca.amplitude", 0.1, 0.25, -0.3, 0.8, kOurs},
    {"infarct_lcx", "hr", 69, 10, 49, 95, kOurs},
    {"infarct_lcx", "segments.lcx.amplitude", 0.1, 0.25, -0.3, 0.8, kOurs},
    {"low_ef", "hr", 75, 11, 54, 106, kOurs},
    {"low_ef", "edv", 150, 32, 92, 235, kOurs},
    {"low_ef", "ef", 0.30, 0.06, 0.16, 0.40, kMcDonagh},
    {"low_ef", "la-volume", 68, 16, 38, 110, kOurs},
    {"low_ef", "sphericity", 0.63, 0.04, 0.55, 0.73, kOurs},
    {"dyssynchrony", "hr", 72, 10, 52, 98, kOurs},
    {"dyssynchrony", "edv", 165, 33, 105, 250, kOurs},
    {"dyssynchrony", "ef", 0.31, 0.05, 0.19, 0.40, kMcDonagh},
    {"dyssynchrony", "sphericity", 0.65, 0.04, 0.57, 0.75, kOurs},
    {"dyssynchrony", "segments.lateral.delay_ms", 95, 20, 65, 140, kBax},
};

struct Territory {
  const char* word;
  std::vector<int> segments;
};

// Arteries and walls: Cerqueira et al., Circulation 105, 539-542, 2002.
const std::vector<Territory>& territories() {
  static const std::vector<Territory> kTerritories{
      {"lad", {1, 2, 7, 8, 13, 14, 17}},
      {"rca", {3, 4, 9, 10, 15}},
      {"lcx", {5, 6, 11, 12, 16}},
      {"anterior", {1, 7, 13}},
      {"septal", {2, 3, 8, 9, 14}},
      {"inferior", {4, 10, 15}},
      {"lateral", {5, 6, 11, 12, 16}},
      {"apical", {13, 14, 15, 16, 17}},
      {"all", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}}};
  return kTerritories;
}

}  // namespace

std::vector<std::string> populationNames() {
  std::vector<std::string> names;
  for (const Row& row : kRows)
    if (names.empty() || names.back() != row.population) names.emplace_back(row.population);
  return names;
}

DialDistributions builtInPopulation(std::string_view name) {
  DialDistributions dials;
  for (const Row& row : kRows) {
    if (name != row.population) continue;
    Distribution d = Distribution::normal(row.mean, row.sd, row.low, row.high);
    d.source = row.source;
    dials.emplace(row.dial, d);
  }
  CHECK_EQ(dials.empty(), false);
  return dials;
}

std::optional<std::size_t> indexGroupOf(std::string_view name) {
  if (name == "healthy") return 0;
  if (name.starts_with("infarct_")) return 1;
  return std::nullopt;
}

std::vector<int> segmentsOf(std::string_view word) {
  for (const Territory& territory : territories())
    if (word == territory.word) return territory.segments;
  int number = 0;
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (wrong == std::errc() && end == word.data() + word.size() && number >= 1 && number <= 17)
    return {number};
  return {};
}

std::string segmentWords() {
  std::string words = "1 to 17";
  for (const Territory& territory : territories()) words += std::string(", ") + territory.word;
  return words;
}

}  // namespace echocine::dataset
