#include "dataset/real_loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "echo/sector.h"
#include "metrics/linear_discriminant.h"
#include "metrics/sector_texture.h"
#include "video/read_video.h"

namespace echocine::dataset {

namespace {

constexpr int kFrameStep = 3;                // neighbouring frames are nearly equal
constexpr std::size_t kMeasuredHearts = 60;  // our choice: a minute of measurement
constexpr std::size_t kShownWeights = 2;

using FeatureRows = std::vector<FeatureRow>;

// Frames of one loop as they are measured.
EchoPicture pictureOf(const Video& video, int frame, const echo::Sector& sector,
                      double mm_per_pixel) {
  EchoPicture picture;
  picture.width = video.width;
  picture.height = video.height;
  picture.pixel_x_m = picture.pixel_y_m = 1e-3 * mm_per_pixel;
  const PixelPlane& greys = video.frames[static_cast<std::size_t>(frame)];
  picture.grey.assign(greys.begin(), greys.end());
  std::size_t i = 0;
  for (int y = 0; y < video.height; ++y)
    for (int x = 0; x < video.width; ++x, ++i)
      if (!sector.contains(x + 0.5, y + 0.5)) picture.grey[i] = 0;
  return picture;
}

FeatureRows featuresOf(const RealLoop& loop) {
  const Video video = readVideo(loop.file);
  const echo::Sector sector = echo::findSector(video).sector;
  FeatureRows rows;
  for (int frame = 0; frame < video.frameCount(); frame += kFrameStep) {
    const SectorTexture texture = sectorTexture(pictureOf(video, frame, sector, loop.mm_per_pixel));
    FeatureRow row;
    for (const SectorStatistic& statistic : sectorStatistics())
      row.push_back(statistic.of(texture));
    if (std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); }))
      rows.push_back(std::move(row));
  }
  if (rows.empty())
    throw SceneError(fmt::format(
        "{}: its sector is too small to measure the texture at {:g} mm per pixel, accepted: "
        "another size of its pixels, or another loop",
        loop.file.string(), loop.mm_per_pixel));
  return rows;
}

// The native loops of hearts that are spread evenly, and the heart of each.
struct Chosen {
  std::vector<RealLoop> loops;
  std::vector<std::size_t> heart;
  std::size_t hearts = 0;
};

Chosen chosenLoops(const std::filesystem::path& folder, std::span<const Json> records) {
  Chosen chosen;
  chosen.hearts = std::min(records.size(), kMeasuredHearts);
  for (std::size_t heart = 0; heart < chosen.hearts; ++heart)
    for (const Json& loop : records[heart * records.size() / chosen.hearts].at("loops")) {
      chosen.loops.push_back({folder / "native" / loop.at("id").get<std::string>() / "cine.avi",
                              loop.at("mm_per_pixel").get<double>()});
      chosen.heart.push_back(heart);
    }
  return chosen;
}

// One element per loop, in parallel.
std::vector<FeatureRows> measuredLoops(std::span<const RealLoop> loops, const Monitor& monitor) {
  std::vector<FeatureRows> all(loops.size());
  const auto measure = [&](std::size_t i) -> std::shared_ptr<void> {
    return std::make_shared<FeatureRows>(featuresOf(loops[i]));
  };
  const auto collect = [&](std::size_t i, std::shared_ptr<void> rows) {
    all[i] = std::move(*static_cast<FeatureRows*>(rows.get()));
  };
  const auto in_flight = 2 * static_cast<std::size_t>(threadCount());
  if (parallelOrdered(0, loops.size(), in_flight, monitor.keep_going, measure, collect) <
      loops.size())
    throw JobError("stopped: nothing was merged, repeat the command");
  return all;
}

double curveArea(const LinearDiscriminant& classifier, const FeatureRows& simulated,
                 const FeatureRows& real) {
  std::vector<double> a, b;
  for (const FeatureRow& row : simulated) a.push_back(classifier.of(row));
  for (const FeatureRow& row : real) b.push_back(classifier.of(row));
  return areaUnderCurve(a, b);
}

void appendRows(const FeatureRows& more, FeatureRows& rows) {
  rows.insert(rows.end(), more.begin(), more.end());
}

std::vector<RealComparison::Weight> strongestOf(const FeatureRows& simulated,
                                                const FeatureRows& real) {
  const LinearDiscriminant whole(simulated, real);
  const FeatureRow mean_s = meanOf(simulated), mean_r = meanOf(real);
  std::vector<RealComparison::Weight> weights;
  for (std::size_t i = 0; i < mean_s.size(); ++i)
    weights.push_back({sectorStatistics()[i].name, whole.weights()[i], mean_s[i], mean_r[i]});
  std::stable_sort(weights.begin(), weights.end(), [](const auto& u, const auto& v) {
    return std::abs(u.weight) > std::abs(v.weight);
  });
  weights.resize(kShownWeights);
  return weights;
}

void refuseFew(std::span<const RealLoop> real) {
  if (real.size() < 2) throw SceneError("--real: is one loop, accepted: two or more");
}

}  // namespace

void checkRealLoops(const Spec& spec, std::span<const RealLoop> real) {
  if (!spec.has("native"))
    throw SceneError("--real: the dataset has no layout \"native\", accepted: a dataset with it");
  refuseFew(real);
  std::error_code failed;
  for (const RealLoop& loop : real)
    if (!std::filesystem::exists(loop.file, failed))
      throw SceneError(fmt::format("--real: {}: no such file", loop.file.string()));
}

RealComparison compareWithReal(const std::filesystem::path& folder, std::span<const Json> records,
                               std::span<const RealLoop> real, const Monitor& monitor) {
  refuseFew(real);
  if (records.size() < 2)
    throw SceneError("--real: the dataset has fewer than two hearts, accepted: two or more");
  const std::vector<FeatureRows> of_real = measuredLoops(real, monitor);
  const Chosen chosen = chosenLoops(folder, records);
  const std::vector<FeatureRows> of_loops = measuredLoops(chosen.loops, monitor);
  FeatureRows even, odd, all_real;
  for (std::size_t i = 0; i < of_loops.size(); ++i)
    appendRows(of_loops[i], chosen.heart[i] % 2 == 0 ? even : odd);
  RealComparison comparison;
  comparison.hearts = chosen.hearts;
  comparison.frames = even.size() + odd.size();
  for (std::size_t held = 0; held < of_real.size(); ++held) {
    FeatureRows others;
    for (std::size_t i = 0; i < of_real.size(); ++i)
      if (i != held) appendRows(of_real[i], others);
    comparison.loops.push_back(
        {of_real[held].size(), curveArea(LinearDiscriminant(even, others), odd, of_real[held])});
    appendRows(of_real[held], all_real);
  }
  appendRows(odd, even);
  comparison.strongest = strongestOf(even, all_real);
  return comparison;
}

std::string realLoopsText(const std::optional<RealComparison>& comparison) {
  std::string text = "\n## Comparison with real loops\n\n";
  if (!comparison)
    return text +
           "Not measured: no real loops were given. `--merge --real` measures how well a linear "
           "classifier distinguishes\nthese pictures from real ones.\n";
  text += fmt::format(
      R"(A linear classifier of {} statistics of grey levels and texture distinguishes simulated from real frames.
It was fitted to every other heart and to all real loops but one. The area under the ROC curve (AUC) is that of the loop left out
and of the remaining hearts: 1 if every real frame is recognised, 0.5 if none is distinguishable. An AUC below 0.5 means that the
real loops differ more from each other than from simulated ones. The AUC characterises these {} real loops, not real loops in general.

| real loop left out | frames | AUC |
|---|---|---|
)",
      sectorStatistics().size(), comparison->loops.size());
  double sum = 0;
  for (std::size_t i = 0; i < comparison->loops.size(); ++i) {
    const auto& [frames, area] = comparison->loops[i];
    text += fmt::format("| {} | {} | {:.3f} |\n", i + 1, frames, area);
    sum += area;
  }
  const auto count = static_cast<double>(comparison->loops.size());
  text +=
      fmt::format("| mean of {} loops | | {:.3f} |\n\nSimulated: {} frames of {} hearts.",
                  comparison->loops.size(), sum / count, comparison->frames, comparison->hearts);
  text += " Largest weights:";
  const char* between = " ";
  for (const RealComparison::Weight& one : comparison->strongest) {
    text += fmt::format("{}`{}` (simulated {:.3g}, real {:.3g})", between, one.statistic,
                        one.simulated, one.real);
    between = ", ";
  }
  return text + ".\n";
}

Json realLoopsJson(const RealComparison& comparison) {
  Json loops = Json::array(), strongest = Json::array();
  for (const auto& [frames, area] : comparison.loops)
    loops.push_back({{"frames", frames}, {"auc", area}});
  for (const RealComparison::Weight& one : comparison.strongest)
    strongest.push_back({{"statistic", one.statistic},
                         {"weight", one.weight},
                         {"simulated", one.simulated},
                         {"real", one.real}});
  return {{"hearts", comparison.hearts},
          {"frames", comparison.frames},
          {"loops", loops},
          {"largest_weights", strongest}};
}

}  // namespace echocine::dataset
