// The dataset's card: README.md, and plots of what was drawn.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dataset/card_texture.h"
#include "dataset/tables.h"

namespace echocine::dataset {

namespace {

using Numbers = std::map<std::string, std::vector<double>>;

// Every number of a loop that varies, by its name.
Numbers numbersOf(std::span<const Json> records) {
  Numbers numbers;
  const auto take = [&](const std::string& name, const Json& value) {
    if (value.is_number()) numbers[name].push_back(value.get<double>());
  };
  for (const Json& record : records)
    for (const Json& loop : record.at("loops")) {
      for (const char* name : {"ef_percent", "edv_ml", "esv_ml", "frames", "mm_per_pixel"})
        take(name, loop.at(name));
      for (const char* name : {"border_visible_ed", "border_visible_es", "tracks_visible"})
        take(name, loop.value(name, Json()));
      if (loop.at("view_offset").is_object())
        for (const auto& [name, value] : loop.at("view_offset").items())
          take("view_offset." + name, value);
      for (const auto& [name, value] : loop.at("drawn").items()) take(name, value);
    }
  std::erase_if(numbers, [](const auto& entry) {
    const auto [low, high] = std::minmax_element(entry.second.begin(), entry.second.end());
    return entry.second.size() < 2 || *low == *high;
  });
  return numbers;
}

// A histogram as SVG, 20 bars between the smallest and the largest value.
std::string histogram(const std::string& name, const std::vector<double>& values) {
  constexpr int kBars = 20, kWide = 12, kHigh = 80, kLeft = 10, kTop = 22;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::array<int, kBars> counts{};
  for (const double v : values)
    ++counts[static_cast<std::size_t>(
        std::min(kBars - 1, static_cast<int>(kBars * (v - *low) / (*high - *low))))];
  const int most = *std::max_element(counts.begin(), counts.end());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" "
      "font-family=\"sans-serif\" "
      "font-size=\"11\">\n<text x=\"{}\" y=\"14\">{} (n = {})</text>\n",
      kBars * kWide + 2 * kLeft, kHigh + kTop + 20, kLeft, name, values.size());
  for (int i = 0; i < kBars; ++i) {
    const double height = 1.0 * kHigh * counts[static_cast<std::size_t>(i)] / most;
    svg +=
        fmt::format("<rect x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"#36c\"/>\n",
                    kLeft + i * kWide, kTop + kHigh - height, kWide - 1, height);
  }
  const int foot = kTop + kHigh + 14;
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{}\">{:.4g}</text>\n<text x=\"{}\" y=\"{}\" "
                   "text-anchor=\"end\">{:.4g}</text>\n</svg>\n",
                   kLeft, foot, *low, kLeft + kBars * kWide, foot, *high);
}

std::string fileName(std::string name) {
  std::replace(name.begin(), name.end(), '.', '_');
  return "figures/" + name + ".svg";
}

std::string row(const std::string& name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return fmt::format("| {} | {:.4g} | {:.4g} | {:.4g} | ![]({}) |\n", name, at(0), at(0.5), at(1),
                     fileName(name));
}

std::string countsText(const Json& counts, const char* what) {
  std::string text;
  for (const auto& [name, count] : counts[what].items())
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.get<int>());
  return text;
}

constexpr const char* kClosing = R"(
## Limits

- Pictures are simulated. Results on them do not replace a test on clinical loops.
- Echoes are those of rays with a point spread. Second-harmonic imaging changes pulse, beam and haze; nonlinear propagation is not computed.
- Aberration by the chest wall is modelled as haze and as patches that weaken parts of the aperture.
- All hearts of the parametric model share one topology. Congenital defects, pacing leads and prostheses are absent.
- Splits keep hearts apart, but all hearts come from one simulator. Test scores are optimistic for other domains.

## Citation

{0}. EchoCine {1}, spec SHA-256 {2}. Licence: {3}.

Cite the sources of the distributions in `dataset.json` too.
)";

}  // namespace

void writeCard(const DatasetFacts& facts, std::span<const Json> records, const Json& counts,
               Sink& sink) {
  const Numbers numbers = numbersOf(records);
  std::string text = fmt::format(
      R"(# {0}

Simulated cardiac ultrasound: {1} loops of {2} hearts, {3} frames, made by EchoCine {4}.
No picture is of a person. `loops.csv` has a row of numbers per loop.

| | |
|---|---|
| layouts | {5} |
| hearts by split | {6} |
| hearts by population | {7} |
| impossible draws, drawn again | {8} (`impossible.csv`) |
| hearts that failed | {9} (`failed.csv`) |
| licence | {10} |
{11}
Splits are by heart: all views of a heart are in the same one.

## Distributions

`dataset.json` has the distributions that were drawn from, with their sources. This table has the values of the loops.
`border_visible_ed` and `_es` are the shares of the left ventricle's outline that the picture shows.
`tracks_visible` is the share of tracked points within the thickness of the imaging plane.

| quantity | least | median | most | |
|---|---|---|---|---|
)",
      facts.name, counts.at("loops").get<int>(), counts.at("hearts").get<int>(),
      counts.at("frames").get<int>(), ECHOCINE_VERSION,
      fmt::format("{}", fmt::join(facts.layouts, ", ")), countsText(counts, "hearts_by_split"),
      countsText(counts, "hearts_by_population"), counts.at("impossible_draws").get<int>(),
      counts.at("failed_hearts").get<int>(), facts.licence, facts.again);
  for (const auto& [name, values] : numbers) {
    text += row(name, values);
    sink.write(fileName(name), histogram(name, values));
  }
  text += decorrelationText(records, sink);
  text += facts.real_loops;
  text += fmt::format(kClosing, facts.name, ECHOCINE_VERSION, facts.digest, facts.licence);
  sink.write("README.md", text);
}

}  // namespace echocine::dataset
