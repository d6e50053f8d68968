#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.h"
#include "core/hash.h"
#include "core/nearest_word.h"
#include "dataset/correlated_reader.h"
#include "dataset/draws.h"
#include "dataset/growth.h"
#include "dataset/spec.h"
#include "dataset/user_scenes.h"
#include "motion/heart/heart_poses.h"
#include "motion/heart/parameters.h"
#include "scene/toml_flat.h"

namespace echocine::dataset {

namespace {

constexpr int kMostHearts = 10'000'000;  // our choice
constexpr std::size_t kMostSpecBytes = std::size_t{1} << 20;

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

// Accepted range of a drawn number.
struct Bounds {
  const char* key;
  double low, high;
};
constexpr Bounds kOffsets[] = {{"shift_lateral_mm", -60, 60}, {"shift_elevation_mm", -60, 60},
                               {"shift_depth_mm", -60, 60},   {"tilt_deg", -60, 60},
                               {"rotate_deg", -180, 180},     {"apex_miss_mm", -40, 40}};
constexpr Bounds kSegment[] = {{"amplitude", -0.5, 1.5}, {"delay_ms", 0, 200}};

Parameter readParameter(TomlTable& table, const std::string& key, const std::string& prefix) {
  return {prefix + key, readDistribution(table, key), table.place(key)};
}

Parameter readBounded(TomlTable& table, const Bounds& bounds, const std::string& prefix) {
  Parameter p = readParameter(table, bounds.key, prefix);
  const auto range = p.distribution.range();
  const std::string accepted = fmt::format("accepted: {:g} to {:g}", bounds.low, bounds.high);
  if (!range) table.fail(bounds.key, "can be something other than a number, " + accepted);
  if (range->first < bounds.low || range->second > bounds.high)
    table.fail(bounds.key,
               fmt::format("reaches from {:g} to {:g}, {}", range->first, range->second, accepted));
  return p;
}

void readSegments(TomlTable& heart, std::vector<Parameter>& to) {
  for (auto& [word, segment] : heart.namedTables("segments")) {
    if (segmentsOf(word).empty())
      heart.fail("segments",
                 fmt::format("\"{}\" is not a segment, accepted: {}", word, segmentWords()));
    for (const Bounds& bounds : kSegment)
      if (segment.has(bounds.key))
        to.push_back(readBounded(segment, bounds, "heart.segments." + word + "."));
    segment.finish();
  }
}

std::vector<Parameter> readHeart(TomlTable heart) {
  std::vector<Parameter> parameters;
  for (const heart::Dial& dial : heart::dials())
    if (heart.has(dial.key))
      parameters.push_back(readBounded(heart, {dial.key, dial.low, dial.high}, "heart."));
  readSegments(heart, parameters);
  heart.finish();
  return parameters;
}

void readOffsets(TomlTable offset, std::vector<Parameter>& to) {
  for (const Bounds& bounds : kOffsets)
    if (offset.has(bounds.key)) to.push_back(readBounded(offset, bounds, "offset."));
  offset.finish();
}

// Those of a scene that say how a heart is imaged; its parts and files are the program's own.
void readSceneKeys(TomlTable scene, std::vector<Parameter>& to) {
  for (const char* section : {"probe", "acquisition", "motion", "effects", "trabeculae", "leaflets",
                              "speckle", "artefacts", "signal", "accuracy"}) {
    TomlTable keys = scene.table(section);
    for (const std::string& key : keys.keys())
      to.push_back(readParameter(keys, key, fmt::format("scene.{}.", section)));
  }
  scene.finish();
}

void readSubject(TomlTable subject, std::vector<Parameter>& to) {
  if (subject.has("age")) to.push_back(readBounded(subject, {"age", 0, 120}, "subject."));
  if (subject.has("sex")) {
    to.push_back(readParameter(subject, "sex", "subject."));
    for (const TomlValue& sex : to.back().distribution.items)
      if (sex != TomlValue(std::string("F")) && sex != TomlValue(std::string("M")))
        subject.fail("sex", fmt::format("may be {}, accepted: \"F\" | \"M\"", tomlText(sex)));
    if (to.back().distribution.items.empty())
      subject.fail("sex", "is a number, accepted: \"F\" | \"M\"");
  }
  subject.finish();
}

Population builtIn(const std::string& name) {
  Population population{name, 1, {}};
  for (const auto& [dial, distribution] : builtInPopulation(name))
    population.parameters.push_back({"heart." + dial, distribution, {}});
  population.group = indexGroupOf(name);
  return population;
}

// [populations] NAME = weight; [population.NAME] with dials makes new ones.
void readPopulations(TomlTable& file, Spec& spec) {
  std::vector<Population> known;
  for (const std::string& name : populationNames()) known.push_back(builtIn(name));
  for (auto& [name, table] : file.namedTables("population")) {
    std::erase_if(known, [&, n = name](const Population& p) { return p.name == n; });
    known.push_back({name, 1, readHeart(std::move(table))});
  }
  TomlTable weights = file.table("populations");
  std::vector<double> given;
  for (const std::string& name : weights.keys()) {
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const Population& p) { return p.name == name; });
    std::vector<std::string> names;
    for (const Population& p : known) names.push_back(p.name);
    if (found == known.end())
      weights.fail(name, fmt::format("is not a population, accepted: {}, or one of your own as "
                                     "[population.{}]",
                                     joined(names), name));
    given.push_back(weights.number(name, std::nullopt, {.lo = 0, .hi = 100}));
    spec.populations.push_back(*found);
  }
  if (spec.populations.empty()) {
    spec.populations.push_back({"base", 1, {}});  // the heart's defaults
    return;
  }
  normaliseWeights(file, "populations", given);
  for (std::size_t i = 0; i < given.size(); ++i) spec.populations[i].weight = given[i];
}

// hearts = 100, or [100, 400]: a first block, and one by which the dataset has grown.
void readHearts(TomlTable& file, bool blocks, Spec& spec) {
  const auto scenes = static_cast<int>(spec.scenes.size());
  if (!blocks) {
    spec.hearts = file.integer("hearts", scenes > 0 ? std::optional(scenes) : std::nullopt,
                               std::max(1, scenes), kMostHearts);
    spec.blocks = {spec.hearts};
    return;
  }
  for (const double block : file.numbers("hearts")) {
    if (!(block >= 1 && block <= kMostHearts - spec.hearts && block == std::floor(block)))
      file.fail("hearts",
                fmt::format("has the block {:g}, accepted: whole numbers from 1, {} in all", block,
                            kMostHearts));
    spec.blocks.push_back(static_cast<int>(block));
    spec.hearts += spec.blocks.back();
  }
  if (spec.blocks.empty() || spec.hearts < scenes)
    file.fail("hearts",
              fmt::format("are {}, accepted: {} or more", spec.hearts, std::max(1, scenes)));
}

void readViews(TomlTable& file, Spec& spec) {
  std::vector<std::string> known;
  for (const heart::ViewName& name : heart::viewNames()) known.emplace_back(name.key);
  for (const std::string& word : file.texts("views")) {
    const auto view = heart::viewOf(word);
    if (!view)
      file.fail("views", fmt::format("\"{}\" is not a view, accepted: {}", word, joined(known)));
    if (std::find(spec.views.begin(), spec.views.end(), *view) != spec.views.end())
      file.fail("views", fmt::format("names \"{}\" twice, accepted: once", word));
    spec.views.push_back(*view);
  }
  if (spec.views.empty()) file.fail("views", "is missing, accepted: some of " + joined(known));
}

std::vector<std::string> readWords(TomlTable& file, const char* key,
                                   const std::vector<std::string>& known,
                                   std::vector<std::string> fallback) {
  if (!file.has(key)) return fallback;
  std::vector<std::string> words = file.texts(key);
  for (const std::string& word : words)
    if (std::find(known.begin(), known.end(), word) == known.end())
      file.fail(key, fmt::format("\"{}\" is not known, accepted: {}", word, joined(known)));
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

// [ef] LAYOUT = "tracing" | "exact", for layouts that have an ejection fraction of their own.
void readEf(TomlTable table, Spec& spec) {
  for (const char* layout : {"camus", "echonet"}) {
    if (!table.has(layout)) continue;
    if (!spec.has(layout))
      table.fail(layout,
                 fmt::format("is not among the layouts, accepted: layouts = [\"{}\"]", layout));
    const std::string word = table.text(layout);
    if (word != "tracing" && word != "exact")
      table.fail(layout, fmt::format("is \"{}\", accepted: \"tracing\" | \"exact\"", word));
    if (word == "exact") spec.exact_ef.emplace_back(layout);
  }
  table.finish();
}

// [nnunet] structures = "camus" | "all".
void readNnunet(TomlTable table, Spec& spec) {
  if (table.has("structures")) {
    if (!spec.has("nnunet"))
      table.fail("structures", "is not used, accepted with layouts = [\"nnunet\"]");
    spec.nnunet_all = table.word("structures", "camus", {"camus", "all"}) == "all";
  }
  table.finish();
}

void readSplit(TomlTable split, Spec& spec) {
  if (split.keys().empty()) return;
  std::vector<double> shares;
  for (const char* name : {"train", "val", "test"})
    shares.push_back(split.number(name, 0, {.lo = 0, .hi = 100}));
  normaliseWeights(split, "train", shares);
  std::copy(shares.begin(), shares.end(), spec.split.begin());
  split.finish();
}

}  // namespace

std::vector<std::string> layoutNames() {
  return {"camus",  "dicom",  "echonet",      "myotracker",
          "native", "nnunet", "pointodyssey", "webdataset"};
}

Spec parseSpec(std::string_view text, const std::filesystem::path& path) {
  TomlTable file = TomlTable::parse(text, path.string());
  Spec spec;
  spec.file = path;
  spec.text = text;
  Sha256 digest;
  digest.update(ECHOCINE_VERSION);
  digest.update(withValues(text, path.string(), {}));  // whatever its comments are
  const auto keys = flatValues(text, path.string());
  Sha256 heart_digest;
  heart_digest.update(ECHOCINE_VERSION);
  for (const auto& [key, value] : keys)
    if (!canGrow(key)) heart_digest.update(key + "=" + value + "\n");
  spec.name = file.text("name", path.stem().string());
  spec.licence = file.text("licence", "CC0-1.0");
  spec.seed = static_cast<std::uint64_t>(file.integer("seed", 1, 0, 2147483647));
  readViews(file, spec);
  spec.layouts = readWords(file, "layouts", layoutNames(), {"native"});
  spec.truth = readWords(file, "truth", {"contours", "function", "labels", "tracks"},
                         {"contours", "labels"});
  spec.track_count = file.integer("track_count", spec.track_count, 3, 100000);
  if (spec.has("webdataset"))
    spec.shard_mb = file.integer("shard_mb", spec.shard_mb, 1, 100000);
  else
    file.unused("shard_mb", "layouts = [\"native\", \"webdataset\"]");
  Sha256 scenes_digest;
  readUserScenes(file, spec, scenes_digest);
  const std::string of_scenes = scenes_digest.hex();
  digest.update(of_scenes);
  heart_digest.update(of_scenes);
  spec.digest = digest.hex();
  spec.heart_digest = heart_digest.hex();
  readHearts(file, keys.count("hearts") > 0 && keys.at("hearts").starts_with('['), spec);
  spec.keyframes = file.integer("keyframes", spec.keyframes, 8, 100);
  spec.picture_px = file.integer("picture_px", spec.picture_px, 56, 4032);
  spec.resolution_mm = file.number("resolution_mm", 0.0, {.lo = 0, .hi = 10});
  readEf(file.table("ef"), spec);
  readNnunet(file.table("nnunet"), spec);
  readSplit(file.table("split"), spec);
  spec.parameters = readHeart(file.table("heart"));
  readOffsets(file.table("offset"), spec.parameters);
  readSceneKeys(file.table("scene"), spec.parameters);
  readSubject(file.table("subject"), spec.parameters);
  if (spec.scenes.empty()) readPopulations(file, spec);
  readCorrelated(file, spec);
  file.finish();
  checkSpec(spec);
  return spec;
}

Spec readSpec(const std::filesystem::path& file) {
  return parseSpec(readTextFile(file, kMostSpecBytes), file);
}

}  // namespace echocine::dataset
