#include "doppler/spectrum_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/plane_exr.h"

namespace echocine {

namespace {

constexpr int kRowsPerBin = 2;
constexpr double kRange_db = 40;        // our choice
constexpr std::uint8_t kZeroGrey = 90;  // of the line at 0

float powerAt(const Spectrum& s, int column, int bin) {
  return s.power[static_cast<std::size_t>(column * s.bins + bin)];
}

}  // namespace

GreyImage spectrumPicture(const Spectrum& s) {
  GreyImage image{s.columns, kRowsPerBin * s.bins, {}};
  image.pixels.resize(static_cast<std::size_t>(image.width * image.height));
  const float most = s.power.empty() ? 0 : *std::max_element(s.power.begin(), s.power.end());
  for (int y = 0; y < image.height; ++y)
    for (int t = 0; t < s.columns; ++t) {
      const float power = powerAt(s, t, s.bins - 1 - y / kRowsPerBin);
      const double level = power > 0 ? 1 + 10 * std::log10(power / most) / kRange_db : 0;
      auto grey = static_cast<std::uint8_t>(std::lround(255 * std::clamp(level, 0.0, 1.0)));
      if (y == image.height / 2) grey = std::max(grey, kZeroGrey);
      image.pixels[static_cast<std::size_t>(y * image.width + t)] = grey;
    }
  return image;
}

std::vector<std::byte> spectrumExr(const Spectrum& s, double prf_hz, double step_s) {
  std::vector<float> rows;
  for (int row = 0; row < s.bins; ++row)
    for (int t = 0; t < s.columns; ++t) rows.push_back(powerAt(s, t, s.bins - 1 - row));
  PlaneExr exr;
  exr.width = s.columns;
  exr.height = s.bins;
  exr.channels = {{"power", rows}};
  exr.numbers = {{"echocine:nyquist_m_s", s.nyquist_m_s},
                 {"echocine:prf_hz", prf_hz},
                 {"echocine:column_s", step_s},
                 {"echocine:depth_m", s.depth_m}};
  exr.texts = {{"echocine:version", ECHOCINE_VERSION}};
  return encodePlaneExr(exr);
}

std::string spectrumCsv(const Spectrum& s) {
  const auto shown = [](double v) { return std::isnan(v) ? "" : fmt::format("{:.6f}", v); };
  std::string text = "time_s,phase,velocity_m_s,exact_m_s\n";
  for (std::size_t t = 0; t < s.times.size(); ++t)
    text += fmt::format("{},{},{},{}\n", s.times[t].time_s, s.times[t].phase, shown(s.mean_m_s[t]),
                        shown(s.exact_m_s[t]));
  return text;
}

}  // namespace echocine
