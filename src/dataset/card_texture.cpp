#include "dataset/card_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace echocine::dataset {

namespace {

constexpr double kLags_ms[] = {0, 20, 40, 60, 80, 100, 150, 200, 250, 300, 400, 500};  // our choice

struct LagRow {
  double lag_ms = 0;
  std::size_t loops = 0;
  double lower = 0, median = 0, upper = 0, away_mm = 0;
};

// A value between two lags of a curve, linearly; none beyond its last lag.
std::optional<double> curveAt(const Json& curve, const char* name, double lag_ms) {
  const auto lags = curve.at("lag_ms").get<std::vector<double>>(),
             values = curve.at(name).get<std::vector<double>>();
  const auto after = std::lower_bound(lags.begin(), lags.end(), lag_ms);
  if (after == lags.end() || values.size() != lags.size()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - lags.begin());
  if (i == 0) return values[0];
  const double share = (lag_ms - lags[i - 1]) / (lags[i] - lags[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

double quantileOf(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

std::vector<LagRow> lagRows(std::span<const Json> records) {
  std::vector<const Json*> curves;
  for (const Json& record : records)
    for (const Json& loop : record.at("loops"))
      if (const auto found = loop.find("decorrelation");
          found != loop.end() && !found->at("lag_ms").empty())
        curves.push_back(&*found);
  std::vector<LagRow> rows;
  for (const double lag_ms : kLags_ms) {
    std::vector<double> correlations, away_mm;
    for (const Json* curve : curves)
      if (const auto correlation = curveAt(*curve, "correlation", lag_ms)) {
        correlations.push_back(*correlation);
        away_mm.push_back(curveAt(*curve, "out_of_plane_mm", lag_ms).value_or(0));
      }
    if (correlations.empty() || 4 * correlations.size() < 3 * curves.size()) break;
    std::sort(correlations.begin(), correlations.end());
    std::sort(away_mm.begin(), away_mm.end());
    rows.push_back({lag_ms, correlations.size(), quantileOf(correlations, 0.25),
                    quantileOf(correlations, 0.5), quantileOf(correlations, 0.75),
                    quantileOf(away_mm, 0.5)});
  }
  return rows;
}

// The band between the quartiles, and the median in it; the axes end at 1 and at the last lag.
std::string plotOf(const std::vector<LagRow>& rows) {
  constexpr double kLeft = 40, kTop = 10, kWide = 320, kHigh = 160;
  const auto point = [&](double lag_ms, double correlation) {
    return fmt::format("{:.1f},{:.1f} ", kLeft + kWide * lag_ms / rows.back().lag_ms,
                       kTop + kHigh * (1 - std::clamp(correlation, 0.0, 1.0)));
  };
  std::string band, line;
  for (const LagRow& row : rows) {
    band += point(row.lag_ms, row.upper);
    line += point(row.lag_ms, row.median);
  }
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) band += point(row->lag_ms, row->lower);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"380\" height=\"210\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n"
      "<polygon points=\"{}\" fill=\"#cde\"/>\n"
      "<polyline points=\"{}\" fill=\"none\" stroke=\"#36c\" stroke-width=\"2\"/>\n"
      "<path d=\"M40 10V170H360\" fill=\"none\" stroke=\"#333\"/>\n"
      "<text x=\"34\" y=\"16\" text-anchor=\"end\">1</text>\n"
      "<text x=\"34\" y=\"172\" text-anchor=\"end\">0</text>\n"
      "<text x=\"40\" y=\"186\">0</text>\n"
      "<text x=\"360\" y=\"186\" text-anchor=\"end\">{:g} ms</text>\n"
      "<text x=\"200\" y=\"202\" text-anchor=\"middle\">correlation of a block of muscle with "
      "itself, by "
      "lag</text>\n</svg>\n",
      band, line, rows.back().lag_ms);
}

}  // namespace

std::string decorrelationText(std::span<const Json> records, Sink& sink) {
  const std::vector<LagRow> rows = lagRows(records);
  if (rows.size() < 2) return {};
  sink.write("figures/decorrelation.svg", plotOf(rows));
  std::string text =
      R"(
## Decorrelation of muscle

A block of 4 x 4 mm around a material point in the middle of the left ventricular wall, along its true track.
The correlation is that of the block with itself after a lag. The block is neither turned nor deformed.
Quartiles are over loops; `out of plane` is the median distance of the points from the imaging plane.

![](figures/decorrelation.svg)

| lag, ms | loops | lower quartile | median | upper quartile | out of plane, mm |
|---|---|---|---|---|---|
)";
  for (const LagRow& row : rows)
    text += fmt::format("| {:g} | {} | {:.3f} | {:.3f} | {:.3f} | {:.2f} |\n", row.lag_ms,
                        row.loops, row.lower, row.median, row.upper, row.away_mm);
  return text;
}

}  // namespace echocine::dataset
