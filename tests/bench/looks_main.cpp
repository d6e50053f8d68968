// echo_looks: texture of simulated apical stills beside that of clinical ones.
//   echo_looks [--hearts N] [--quality good|medium|poor] [--with TOML] [--save FOLDER]
//     --first N: number of the first heart, from 0, here and below
//   echo_looks --measure FILE MILLIMETRES_PER_PIXEL     frame 0 of a real loop
//   echo_looks --real FILE=MILLIMETRES_PER_PIXEL [--real ...] [--hearts N] [--view a4c|a2c]
//     --look all: the looks of all scanners, in turn
//   echo_looks --greys 1 [--hearts N] [--look NAME] [--view NAME] [--with TOML] [--save FOLDER]
//   echo_looks --regions CSV --loop SCENE_OR_VIDEO [--pixel MILLIMETRES] [--save PGM]

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "core/parallel.h"
#include "frame/simulator.h"
#include "looks_classifier.h"
#include "looks_greys.h"
#include "looks_regions.h"
#include "looks_scene.h"
#include "metrics/statistics.h"
#include "motion/heart/heart_scene.h"
#include "scene/looks.h"
#include "scene/names.h"
#include "scene/role.h"
#include "signal/signal_chain.h"
#include "texture_table.h"
#include "video/read_video.h"

namespace echocine::bench {
namespace {

struct Options : LookHearts {
  bool all_looks = false;
  bool greys = false;
  std::string measure;
  std::string regions, loop;
  std::vector<std::pair<std::string, double>> real;  // loops, and how large their pixels are
  double mm_per_pixel = 0;
  double coarse_mm = 0;  // simulated and real pictures are compared with pixels of this size
};

// Papillary muscles count as cavity, as those who trace ventricles have them.
std::vector<std::uint8_t> labelsOf(const Simulator& simulator, double phase) {
  const Scene& scene = simulator.scene();
  std::vector<std::uint8_t> labels;
  for (const std::uint16_t id : idsOf(simulator, phase)) {
    const Role role = id == 0 ? Role::none : roleOf(scene.structures[id - 1u]);
    labels.push_back(role == Role::lv_cavity || role == Role::papillary_muscle ? 1
                     : role == Role::lv_wall                                   ? 2
                     : role == Role::la                                        ? 3
                                                                               : 0);
  }
  return labels;
}

struct Measured {
  SectorTexture sector;
  RegionTexture region;
};

Measured measure(const Simulator& simulator, double time_s, const std::string& save,
                 double coarse_mm) {
  Frame frame = simulator.frame(time_s);
  if (!save.empty()) savePgm(save, frame.image);
  EchoPicture picture;
  picture.width = frame.image.width;
  picture.height = frame.image.height;
  picture.pixel_x_m = picture.pixel_y_m = simulator.chain().geometry().metres_per_pixel;
  picture.grey.assign(frame.image.pixels.begin(), frame.image.pixels.end());
  picture.labels = labelsOf(simulator, frame.time.phase);
  return {sectorTexture(coarser(picture, coarse_mm)), regionTexture(picture)};
}

using Column = std::vector<Measured>;

void addHeart(int number, const Options& options, std::map<int, Column>& columns) {
  for (const heart::View view : {heart::View::a4c, heart::View::a2c}) {
    if (!options.view.empty() && options.view != (view == heart::View::a4c ? "a4c" : "a2c"))
      continue;
    Scene scene = heart::heartScene(parametersOf(number), view, 12);
    takeTables(options, scene);
    seedScene(number, scene);
    const double es_s =
        scene.motion.end_systole_phase.value_or(0.35) / scene.acquisition.heart_rate_hz;
    const Simulator simulator(std::move(scene));
    for (const int instant : {0, 1}) {
      const int column = (view == heart::View::a2c ? 2 : 0) + instant;
      const std::string file =
          options.save.empty() ? "" : fmt::format("{}/{}_{}.pgm", options.save, number, column);
      columns[column].push_back(
          measure(simulator, instant == 0 ? 0 : es_s, file, options.coarse_mm));
    }
  }
}

void printTable(const std::map<int, Column>& columns) {
  const char* kNames[] = {"4CH-ED", "4CH-ES", "2CH-ED", "2CH-ES"};
  int wide_all = 0, narrow_all = 0, wide[4] = {}, narrow[4] = {};
  std::vector<std::pair<double, const char*>> off;  // deviations of the clinical stills
  fmt::print(
      "| statistic | 4CH-ED | 4CH-ES | 2CH-ED | 2CH-ES | all | p10-p90 | quartiles |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const Statistic& statistic : textureStatistics()) {
    std::vector<double> every;
    Population mean{};
    fmt::print("| {} ", statistic.name);
    for (const auto& [c, column] : columns) {
      std::vector<double> values;
      for (const Measured& m : column) values.push_back(statistic.of(m.sector, m.region));
      every.insert(every.end(), values.begin(), values.end());
      const double median = quartilesOf(values).median;
      const Population& p = statistic.columns[c];
      wide[c] += median >= p.p10 && median <= p.p90;
      narrow[c] += median >= p.p25 && median <= p.p75;
      mean.p10 += p.p10 / 4, mean.p25 += p.p25 / 4, mean.p75 += p.p75 / 4, mean.p90 += p.p90 / 4;
      mean.p50 += p.p50 / 4;
      fmt::print("| {:.3g} ", median);
    }
    const double median = quartilesOf(every).median;
    constexpr double kDeviations = 2.563;  // of a normal distribution, from p10 to p90
    off.emplace_back(std::abs(median - mean.p50) * kDeviations / (mean.p90 - mean.p10),
                     statistic.name);
    const bool in_wide = median >= mean.p10 && median <= mean.p90,
               in_narrow = median >= mean.p25 && median <= mean.p75;
    wide_all += in_wide;
    narrow_all += in_narrow;
    fmt::print("| {:.3g} | {}{:.3g}..{:.3g} | {}{:.3g}..{:.3g} |\n", median, in_wide ? "" : "NOT ",
               mean.p10, mean.p90, in_narrow ? "" : "not ", mean.p25, mean.p75);
  }
  fmt::print("\ninside p10-p90: {} of 15, inside quartiles: {} of 15\n", wide_all, narrow_all);
  std::sort(off.rbegin(), off.rend());
  fmt::print("farthest off: {} by {:.1f} and {} by {:.1f} standard deviations\n", off[0].second,
             off[0].first, off[1].second, off[1].first);
  for (const auto& [c, column] : columns)
    fmt::print("{}: {} and {} of 15, {} hearts\n", kNames[c], wide[c], narrow[c], column.size());
  // Medians over hearts, of one column or of all.
  const auto medianOf = [&](auto&& of, int of_column = -1) {
    std::vector<double> values;
    for (const auto& [c, column] : columns)
      for (const Measured& m : column)
        if (of_column < 0 || c == of_column) values.push_back(of(m));
    return quartilesOf(values).median;
  };
  fmt::print(
      "greys: cavity {:.0f}, myocardium {:.0f}, near field {:.0f}, sector p5 {:.0f} p50 {:.0f} p95 "
      "{:.0f}, dark {:.3f}\n",
      medianOf([](const Measured& m) { return m.region.cavity_grey; }),
      medianOf([](const Measured& m) { return m.region.myocardium_grey; }),
      medianOf([](const Measured& m) { return m.sector.near_field_grey; }),
      medianOf([](const Measured& m) { return m.sector.grey_p5; }),
      medianOf([](const Measured& m) { return m.sector.grey_p50; }),
      medianOf([](const Measured& m) { return m.sector.grey_p95; }),
      medianOf([](const Measured& m) { return m.sector.dark_fraction; }));
  fmt::print("left less right wall:");
  for (const auto& [c, column] : columns)
    fmt::print(
        " {} {:.0f}", kNames[c],
        medianOf(
            [](const Measured& m) { return m.region.left_wall_grey - m.region.right_wall_grey; },
            c));
  fmt::print("\n");
}

// Hearts of all grades of quality, in turn; of all looks, too, if asked for.
void classify(Options options) {
  const std::vector<Look> looks =
      options.all_looks ? scannerLooks() : std::vector<Look>{options.look};
  std::vector<PictureGroup> simulated, real;
  for (const auto& [file, mm_per_pixel] : options.real)
    options.coarse_mm = std::max(options.coarse_mm, mm_per_pixel);
  for (int h = options.first; h < options.first + options.hearts; ++h) {
    options.quality = std::array{Quality::good, Quality::medium, Quality::poor}[h % 3];
    options.look = looks[static_cast<std::size_t>(h / 3) % looks.size()];
    std::map<int, Column> columns;
    addHeart(h, options, columns);
    PictureGroup& group = simulated.emplace_back();
    for (const auto& [c, column] : columns)
      for (const Measured& m : column) group.pictures.push_back(m.sector);
  }
  for (const auto& [file, mm_per_pixel] : options.real)
    real.push_back(framesOf(file, mm_per_pixel, options.coarse_mm));
  printClassifier(simulated, real);
}

void measureFile(const Options& options) {
  const Video video = readVideo(options.measure);
  EchoPicture picture;
  picture.width = video.width;
  picture.height = video.height;
  picture.pixel_x_m = picture.pixel_y_m = 1e-3 * options.mm_per_pixel;
  picture.grey.assign(video.frames[0].begin(), video.frames[0].end());
  const SectorTexture s = sectorTexture(picture);
  for (const Statistic& statistic : textureStatistics())
    fmt::print("{} {:.3g}\n", statistic.name, statistic.of(s, regionTexture(picture)));
  fmt::print("dark {:.3f}, p5 {:.0f} p50 {:.0f} p95 {:.0f}\n", s.dark_fraction, s.grey_p5,
             s.grey_p50, s.grey_p95);
}

int run(int count, char** words) {
  Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string key = words[i];
    if (key == "--hearts") options.hearts = std::atoi(words[i + 1]);
    if (key == "--first") options.first = std::atoi(words[i + 1]);
    if (key == "--quality")
      options.quality = valueOf<Quality>(words[i + 1]).value_or(options.quality);
    if (key == "--look") options.all_looks = std::string(words[i + 1]) == "all";
    if (key == "--look") options.look = valueOf<Look>(words[i + 1]).value_or(options.look);
    if (key == "--greys") options.greys = true;
    if (key == "--view") options.view = words[i + 1];
    if (key == "--with") options.with = words[i + 1];
    if (key == "--save") options.save = words[i + 1];
    if (const std::string word = words[i + 1]; key == "--real")
      options.real.emplace_back(word.substr(0, word.rfind('=')),
                                std::atof(word.substr(word.rfind('=') + 1).c_str()));
    if (key == "--regions") options.regions = words[i + 1];
    if (key == "--loop") options.loop = words[i + 1];
    if (key == "--pixel") options.mm_per_pixel = std::atof(words[i + 1]);
    if (key == "--measure") {
      options.measure = words[i + 1];
      options.mm_per_pixel = i + 2 < count ? std::atof(words[i + 2]) : 0;
    }
  }
  if (!options.measure.empty()) {
    measureFile(options);
    return 0;
  }
  if (!options.regions.empty()) {
    printRegions(options.regions, options.loop, options.mm_per_pixel, options.save);
    return 0;
  }
  if (!options.real.empty()) {
    classify(options);
    return 0;
  }
  if (options.greys) {
    printGreys(options);
    return 0;
  }
  std::map<int, Column> columns;
  for (int h = options.first; h < options.first + options.hearts; ++h)
    addHeart(h, options, columns);
  printTable(columns);
  return 0;
}

}  // namespace
}  // namespace echocine::bench

int main(int count, char** words) {
  return echocine::bench::run(count, words);
}
