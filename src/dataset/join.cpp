#include "dataset/join.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/hash.h"
#include "dataset/join_part.h"
#include "dataset/record.h"
#include "dataset/record_check.h"
#include "dataset/tables.h"
#include "dataset/work_folder.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostMarkBytes = std::size_t{1} << 20;
constexpr int kMostPatients = 9999;  // CAMUS numbers them by four digits

std::vector<std::string> commonLayouts(const std::vector<JoinPart>& parts,
                                       std::vector<std::string>& left_out) {
  std::vector<std::string> common;
  for (const std::string& layout : layoutNames()) {
    const auto has = [&](const JoinPart& part) { return part.spec.has(layout); };
    if (std::all_of(parts.begin(), parts.end(), has))
      common.push_back(layout);
    else if (std::any_of(parts.begin(), parts.end(), has))
      left_out.push_back(layout);
  }
  if (common.empty())
    throw SceneError(fmt::format("--join: {} and {} have no common layout",
                                 parts[0].folder.string(), parts[1].folder.string()));
  return common;
}

// One list cannot have two meanings.
void checkMeanings(const std::vector<JoinPart>& parts, const std::vector<std::string>& layouts) {
  const Spec& first = parts.front().spec;
  const auto fail = [&](const JoinPart& part, const char* key) {
    throw SceneError(fmt::format("--join: {} and {} differ in {}, accepted: the same value",
                                 parts.front().folder.string(), part.folder.string(), key));
  };
  for (const JoinPart& part : parts)
    for (const std::string& layout : layouts) {
      if (part.spec.hasExactEf(layout) != first.hasExactEf(layout))
        fail(part, layout == "camus" ? "ef.camus" : "ef.echonet");
      if (layout == "nnunet" && part.spec.nnunet_all != first.nnunet_all)
        fail(part, "nnunet.structures");
      if (layout == "camus" && part.before + part.spec.hearts > kMostPatients)
        throw SceneError(
            fmt::format("--join: \"camus\" numbers patients by four digits, but the "
                        "parts have more than {} hearts",
                        kMostPatients));
    }
}

std::vector<JoinPart> readParts(const std::vector<std::filesystem::path>& folders) {
  if (folders.size() < 2) throw SceneError("--join: is one folder, accepted: two or more");
  std::vector<JoinPart> parts;
  for (const std::filesystem::path& folder : folders) {
    std::error_code failed;
    for (const JoinPart& other : parts)
      if (std::filesystem::equivalent(other.folder, folder, failed))
        throw SceneError(fmt::format("--join: names {} twice, accepted: once", folder.string()));
    JoinPart part = readJoinPart(folder);
    if (!parts.empty()) {
      part.number = parts.back().number + 1;
      part.before = parts.back().before + parts.back().spec.hearts;
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

// Each different word once, in the order of the parts.
template <typename Word>
std::string joinedWords(const std::vector<JoinPart>& parts, const char* between, Word word) {
  std::vector<std::string> words;
  for (const JoinPart& part : parts)
    if (std::find(words.begin(), words.end(), word(part)) == words.end())
      words.push_back(word(part));
  return fmt::format("{}", fmt::join(words, between));
}

// The card and the citation have the name on one line.
void checkName(const JoinOptions& options) {
  const auto control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (options.name &&
      (options.name->empty() || std::any_of(options.name->begin(), options.name->end(), control)))
    throw SceneError("--name: is empty or has control characters, accepted: a line of text");
}

Spec specOfAll(const std::vector<JoinPart>& parts, const std::vector<std::string>& layouts,
               const JoinOptions& options) {
  const Spec& first = parts.front().spec;
  Spec all;
  all.name = options.name.value_or(
      joinedWords(parts, " + ", [](const JoinPart& part) { return part.spec.name; }));
  all.licence = joinedWords(parts, " AND ", [](const JoinPart& part) { return part.spec.licence; });
  all.layouts = layouts;
  all.exact_ef = first.exact_ef;
  all.nnunet_all = first.nnunet_all;
  all.shard_mb = first.shard_mb;
  Sha256 digest;
  for (const JoinPart& part : parts) digest.update(part.spec.digest);
  all.digest = digest.hex();
  return all;
}

std::string specName(const JoinPart& part) {
  return fmt::format("specs/part_{}.toml", part.number);
}

Json partsJson(const std::vector<JoinPart>& parts) {
  Json all = Json::array();
  for (const JoinPart& part : parts)
    all.push_back({{"part", part.number},
                   {"name", part.spec.name},
                   {"spec", specName(part)},
                   {"spec_sha256", part.spec.digest},
                   {"seed", part.spec.seed},
                   {"hearts", part.spec.hearts},
                   {"first_heart", part.before + 1},
                   {"distributions", distributionsJson(part.spec)}});
  return all;
}

DatasetFacts factsOfAll(const std::vector<JoinPart>& parts, const Spec& all) {
  DatasetFacts facts{all.name, all.licence, all.digest, all.layouts, {{"parts", partsJson(parts)}},
                     ""};
  for (const JoinPart& part : parts)
    facts.again += fmt::format("| part {}: {} | hearts {} to {}; `{}`, SHA-256 {} |\n", part.number,
                               part.spec.name, part.before + 1, part.before + part.spec.hearts,
                               specName(part), part.spec.digest);
  facts.again += "| reproduced, byte for byte, by | the parts, then `echocine dataset --join` |\n";
  return facts;
}

bool isIn(const std::filesystem::path& folder, const std::filesystem::path& outer) {
  std::error_code failed;
  const std::filesystem::path inner = std::filesystem::weakly_canonical(folder, failed),
                              whole = std::filesystem::canonical(outer, failed);
  return std::mismatch(whole.begin(), whole.end(), inner.begin(), inner.end()).first == whole.end();
}

// A new or empty folder, or one of the same join.
void claimFolder(const std::filesystem::path& folder, const std::vector<JoinPart>& parts,
                 const Spec& all) {
  std::error_code failed;
  for (const JoinPart& part : parts)
    if (isIn(folder, part.folder))
      throw SceneError(fmt::format("--output: {} is in the part {}, accepted: another folder",
                                   folder.string(), part.folder.string()));
  const std::filesystem::path mark = folder / kJoinedMark;
  const std::string own = Json{{"digest", all.digest}, {"layouts", all.layouts}}.dump() + "\n";
  if (isOrdinaryFile(mark)) {
    if (readTextFile(mark, kMostMarkBytes) == own) return;
    throw SceneError(
        fmt::format("{}: holds other joined datasets: choose another folder", folder.string()));
  }
  if (std::filesystem::exists(folder, failed) && !std::filesystem::is_empty(folder, failed))
    throw SceneError(
        fmt::format("{}: holds unrelated files: choose a new or empty folder", folder.string()));
  makeFolder(folder / "work");
  writeFileWhole(mark, std::as_bytes(std::span(own)));
}

// Only shards need a heart's files after its copy.
void forgetFiles(const Spec& all, Json& record) {
  if (!isFailure(record) && !all.has("webdataset")) record["files"] = Json::object();
}

}  // namespace

JoinSummary joinDatasets(const std::vector<std::filesystem::path>& folders,
                         const std::filesystem::path& folder, const JoinOptions& options,
                         const Monitor& monitor) {
  JoinSummary summary;
  checkName(options);
  const std::vector<JoinPart> parts = readParts(folders);
  const std::vector<std::string> layouts = commonLayouts(parts, summary.left_out);
  checkMeanings(parts, layouts);
  checkNoHeartTwice(parts);
  const Spec all = specOfAll(parts, layouts, options);
  claimFolder(folder, parts, all);
  const FileLock lock(folder / "work/merge" / kLockName);
  const auto hearts = static_cast<std::size_t>(parts.back().before + parts.back().spec.hearts);
  std::vector<Json> finished, failures;
  for (const JoinPart& part : parts)
    for (const Json& record : part.records) {
      if (!monitor.keep_going()) throw JobError("stopped: the same command resumes");
      Sink sink(folder);
      Json joined = joinedHeart(part, record, layouts, sink);
      if (!isFailure(joined)) joined["files"] = marksJson(sink.files());
      const std::string text = sealedText(joined);
      const std::filesystem::path file = recordFile(folder, joined.at("heart").get<int>() - 1);
      makeFolder(file.parent_path());
      writeFileWhole(file, std::as_bytes(std::span(text)));
      forgetFiles(all, joined);
      (isFailure(joined) ? failures : finished).push_back(std::move(joined));
      monitor.tell({Task::rendering, finished.size() + failures.size(), hearts});
    }
  Sink sink(folder);
  for (const JoinPart& part : parts) sink.write(specName(part), part.spec.text);
  for (const Layout* layout : layoutsOf(all))
    if (layout->merge != nullptr) layout->merge(all, finished, sink);
  writeTables(factsOfAll(parts, all), finished, failures, sink);
  summary.hearts = finished.size();
  summary.failed = failures.size();
  for (const Json& record : finished) summary.loops += record.at("loops").size();
  return summary;
}

}  // namespace echocine::dataset
