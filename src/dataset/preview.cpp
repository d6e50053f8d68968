#include "dataset/preview.h"

#include <algorithm>
#include <cmath>

#include "core/file.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "dataset/heart_cost.h"
#include "dataset/preview_frames.h"
#include "dataset/record.h"
#include "dataset/shrink.h"
#include "page/assets.h"
#include "page/page.h"
#include "scene/view_names.h"
#include "video/cine_writer.h"

namespace echocine::dataset {

namespace {

constexpr int kPicture_px = 224;  // on the sheet, of each instant
constexpr int kMostDrawn = 1000;  // hearts whose draws the histograms count

// Both instants side by side, the sector's square of each.
GreyImage pairOf(const PreviewFrames& preview) {
  GreyImage pair{2 * kPicture_px, kPicture_px, {}};
  pair.pixels.resize(std::size_t{2} * kPicture_px * kPicture_px);
  int left = 0;
  for (const GreyImage* instant : {&preview.ed, &preview.es}) {
    const GreyImage small = shrunk(*instant, sectorSquare(*instant), kPicture_px);
    for (int y = 0; y < kPicture_px; ++y)
      std::copy_n(small.pixels.begin() + std::ptrdiff_t{y} * kPicture_px, kPicture_px,
                  pair.pixels.begin() + std::ptrdiff_t{y} * 2 * kPicture_px + left);
    left += kPicture_px;
  }
  return pair;
}

// Rows of pairs, as square as they go.
GreyImage sheetOf(const std::vector<GreyImage>& pairs) {
  const int count = static_cast<int>(pairs.size());
  const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(0.5 * count)))),
            rows = (count + columns - 1) / columns;
  GreyImage sheet{columns * 2 * kPicture_px, rows * kPicture_px, {}};
  sheet.pixels.resize(static_cast<std::size_t>(sheet.width) *
                      static_cast<std::size_t>(sheet.height));
  for (int i = 0; i < count; ++i) {
    const GreyImage& pair = pairs[static_cast<std::size_t>(i)];
    const int left = i % columns * pair.width, top = i / columns * pair.height;
    for (int y = 0; y < pair.height; ++y)
      std::copy_n(pair.pixels.begin() + std::ptrdiff_t{y} * pair.width, pair.width,
                  sheet.pixels.begin() + std::ptrdiff_t{top + y} * sheet.width + left);
  }
  return sheet;
}

Json previewJson(const PreviewFrames& g, const GreyImage& pair) {
  return {{"id", g.id},
          {"population", g.population},
          {"view", keyOf(g.view)},
          {"edv_ml", g.edv_ml},
          {"ef_percent", 100 * (1 - g.esv_ml / g.edv_ml)},
          {"impossible", g.impossible},
          {"drawn", jsonOf(g.values)},
          {"picture", dataUri(encodePng(pair))}};
}

// Each drawn number or word of the hearts' first draws, by its name.
Json drawnJson(const Spec& spec) {
  Json drawn = Json::object();
  const auto add = [&](const Values& values) {
    const Json json = jsonOf(values);
    for (const auto& [name, value] : json.items())
      if (value.is_number() || value.is_string()) drawn[name].push_back(value);
  };
  for (int heart = 0; heart < std::min(spec.hearts, kMostDrawn); ++heart) {
    const Draw draw = drawOf(spec, heart, 0);
    drawn["population"].push_back(draw.population->name);
    add(draw.values);
    for (const Values& view : draw.view_values) add(view);
  }
  return drawn;
}

}  // namespace

PreviewSummary writePreview(const Spec& spec, const std::filesystem::path& page, int hearts,
                            int threads, const Monitor& monitor) {
  checkOutputFile(page);
  hearts = std::min(hearts, spec.hearts);
  const auto count = static_cast<std::size_t>(hearts);
  PreviewSummary summary;
  std::vector<GreyImage> pairs;
  Json previews = Json::array();
  const HeartCost cost = costOfAHeart(spec, page, monitor);
  withThreads(threads, [&] {
    const int used = threadCount();
    summary.seconds = cost.seconds * spec.hearts / used;
    summary.bytes = cost.bytes * spec.hearts;
    const auto make = [&](std::size_t i) -> std::shared_ptr<void> {
      return std::make_shared<PreviewFrames>(
          previewFramesOf(spec, static_cast<int>(i), i % spec.views.size(), monitor));
    };
    const auto collect = [&](std::size_t i, std::shared_ptr<void> made) {
      const auto& preview = *static_cast<PreviewFrames*>(made.get());
      pairs.push_back(pairOf(preview));
      previews.push_back(previewJson(preview, pairs.back()));
      summary.impossible += preview.impossible;
      monitor.tell({Task::rendering, i + 1, count});
    };
    const auto in_flight = static_cast<std::size_t>(used) + 1;
    if (parallelOrdered(0, count, in_flight, monitor.keep_going, make, collect) < count)
      throw Stopped();
  });
  summary.pictures = hearts;
  const Json data{{"version", ECHOCINE_VERSION},
                  {"name", spec.name},
                  {"hearts", spec.hearts},
                  {"loops", spec.loops()},
                  {"layouts", spec.layouts},
                  {"expected_s", summary.seconds},
                  {"expected_bytes", summary.bytes},
                  {"previews", previews},
                  {"counted", std::min(spec.hearts, kMostDrawn)},
                  {"drawn", drawnJson(spec)}};
  std::filesystem::path sheet = page;
  writeFileWhole(sheet.replace_extension(".png"), encodePng(sheetOf(pairs)));
  writePage(page,
            pageLook("EchoCine: preview of " + spec.name, pageAsset("preview.html"),
                     pageAsset("preview.js")),
            data);
  return summary;
}

}  // namespace echocine::dataset
