#include "compare/compare_page.h"

#include <nlohmann/json.hpp>

#include "compare/results.h"
#include "core/shown_path.h"
#include "fit/fit_report.h"

namespace echocine::compare {

namespace {

using Json = nlohmann::ordered_json;

// Appends each metric to its own array; null where nothing was measured.
void addMetrics(Json& group, const FrameMetrics* metrics) {
  const Json named = metricsJson(metrics ? *metrics : FrameMetrics{});
  for (const auto& [key, value] : named.items()) group[key].push_back(metrics ? value : Json());
}

Json framesJson(const Comparison& c, const ComparePage& page) {
  Json frames = Json::object();
  for (const FrameResult& f : c.frames) {
    if (!page.shows(f.real_frame)) continue;
    const bool measured = f.synthetic_place >= 0;
    frames["real_frame"].push_back(f.real_frame);
    frames["real_time_s"].push_back(f.real_time_s);
    frames["synthetic_frame"].push_back(measured ? Json(f.synthetic_place) : Json());
    frames["synthetic_phase"].push_back(f.synthetic_phase >= 0 ? Json(f.synthetic_phase) : Json());
    frames["repeat"].push_back(f.repeat);
    frames["counted"].push_back(f.counted());
    frames["discrepancy"].push_back(measured ? Json(f.discrepancy) : Json());
    addMetrics(frames["before"], measured ? &f.before : nullptr);
    addMetrics(frames["after"], measured ? &f.after : nullptr);
    for (std::size_t b = 0; b < c.mean_bands.size(); ++b) {
      const bool has = measured && b < f.bands.size() && f.bands[b].metrics.weight > 0;
      addMetrics(frames["bands"][c.mean_bands[b].structure], has ? &f.bands[b].metrics : nullptr);
    }
  }
  return frames;
}

PageLook lookOf(const Comparison& c) {
  return fit::fitPageLook(
      "EchoCine: " + shownName(c.synthetic.video.name) + " against " + shownName(c.real.video.name),
      "compare");
}

}  // namespace

ComparePage::ComparePage(const std::filesystem::path& path, const Comparison& comparison)
    : c_(comparison),
      stride_(pageStride(static_cast<int>(comparison.frames.size()))),
      writer_(path, lookOf(comparison)) {
  if (c_.scene_fit) fit::addFitPictures(c_.scene_fit->where, writer_);
}

void ComparePage::addFrame(Panel panel, std::span<const std::byte> image) {
  constexpr const char* kNames[] = {"real", "synthetic", "difference"};
  writer_.addFrame(kNames[static_cast<std::size_t>(panel)], image);
}

void ComparePage::finish(const Json& summary, std::span<const std::byte> sector_real,
                         std::span<const std::byte> sector_synthetic) {
  Json metrics = Json::array();
  for (const Metric& metric : kMetrics) metrics.push_back({metric.key, metric.title});
  writer_.finish({{"summary", summary},
                  {"metrics", metrics},
                  {"stride", stride_},
                  {"frames", framesJson(c_, *this)},
                  {"fit", c_.scene_fit ? fit::fitJson(c_.scene_fit->where) : Json()},
                  {"sector_real", dataUri(sector_real)},
                  {"sector_synthetic", dataUri(sector_synthetic)}});
}

}  // namespace echocine::compare
