#include "dataset/join_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "dataset/folder_spec.h"
#include "dataset/record.h"
#include "dataset/work_folder.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 32;

std::string idStart(int number) {
  return fmt::format("ec{:06}_", number);
}

std::string patientName(int number) {
  return fmt::format("patient{:04}", number);
}

// Every occurrence of `from`.
std::string withReplaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// New names of a heart's loops and files.
class Renumbered {
 public:
  Renumbered(int from, int to) : from_(from), to_(to) {}
  std::string id(const std::string& name) const {
    return withReplaced(name, idStart(from_), idStart(to_));
  }
  std::string file(const std::string& name) const {
    return withReplaced(id(name), patientName(from_), patientName(to_));
  }

 private:
  int from_, to_;
};

std::string wholeFile(const JoinPart& part, const std::string& name, const Json& noted) {
  const std::filesystem::path file = part.folder / name;
  std::string bytes;
  try {
    bytes = readTextFile(file, kMostFileBytes);
  } catch (const SceneError& error) {
    throw JobError(error.what());
  }
  if (bytes.size() != noted.at("bytes").get<std::size_t>() ||
      digestOfBytes(std::as_bytes(std::span(bytes))) != noted.at("digest").get<std::string>())
    throw JobError(fmt::format("{}: was modified: run the part's command again", file.string()));
  return bytes;
}

Json originOf(const JoinPart& part, const std::string& id) {
  return {{"part", part.number}, {"dataset", part.spec.name}, {"id", id}};
}

// loop.json has the loop's name and its heart's number.
std::string renumberedLoop(const JoinPart& part, const std::string& text, const Renumbered& names,
                           int number) {
  Json loop = Json::parse(text);
  const std::string id = loop.at("id").get<std::string>();
  loop["id"] = names.id(id);
  loop["heart"] = number;
  loop["joined"] = originOf(part, id);
  return loop.dump(1) + "\n";
}

void writeIfChanged(Sink& sink, const std::string& name, const std::string& bytes) {
  const std::span<const std::byte> content = std::as_bytes(std::span(bytes));
  Digest digest;
  digest.update(content);
  const FileMark wanted{bytes.size(), digest.hex()};
  const std::optional<FileMark> there = markOf(sink.folder() / name);
  if (there && there->bytes == wanted.bytes && there->digest == wanted.digest)
    sink.note(name, wanted);
  else
    sink.write(name, content);
}

// The values that define the parametric heart; empty if none was drawn.
std::string heartKey(const Json& record) {
  Json values = Json::object();
  if (record.contains("loops") && !record["loops"].empty())
    for (const auto& [name, value] : record["loops"][0].at("drawn").items())
      if (name.starts_with("heart.")) values[name] = value;
  return values.empty() ? "" : values.dump();
}

struct HeartPlace {
  const JoinPart* part;
  int heart;
};

[[noreturn]] void failOfTwins(const HeartPlace& a, const HeartPlace& b) {
  throw SceneError(fmt::format(
      "--join: heart {} of {} and heart {} of {} are the same heart, accepted: other seeds",
      a.heart, a.part->folder.string(), b.heart, b.part->folder.string()));
}

// A key that occurs once in each of two parts is a heart that is in both. Constant dials occur
// often in their own part: its hearts differ in other ways.
void checkKeys(const std::vector<JoinPart>& parts,
               std::string (*key_of)(const JoinPart&, const Json&)) {
  std::map<std::string, std::vector<HeartPlace>> places;
  for (const JoinPart& part : parts)
    for (const Json& record : part.records)
      if (const std::string key = key_of(part, record); !key.empty())
        places[key].push_back({&part, record.at("heart").get<int>()});
  for (const auto& [key, all] : places) {
    std::map<const JoinPart*, int> counts;
    for (const HeartPlace& place : all) ++counts[place.part];
    const auto once = [&](const HeartPlace& place) { return counts[place.part] == 1; };
    const auto first = std::find_if(all.begin(), all.end(), once);
    if (first == all.end()) continue;
    const auto second = std::find_if(first + 1, all.end(), once);
    if (second != all.end()) failOfTwins(*first, *second);
  }
}

void checkScenes(const std::vector<JoinPart>& parts) {
  std::map<std::string, std::pair<std::string, const JoinPart*>> split_of;
  for (const JoinPart& part : parts)
    for (const Json& record : part.records) {
      if (!record.contains("scene")) continue;
      const auto scene = record["scene"].get<std::string>(),
                 split = record.at("split").get<std::string>();
      const auto& [other, owner] = split_of.emplace(scene, std::pair(split, &part)).first->second;
      if (other != split)
        throw SceneError(
            fmt::format("--join: {} is in {} of {} and in {} of {}, accepted: one split", scene,
                        other, owner->folder.string(), split, part.folder.string()));
    }
}

}  // namespace

JoinPart readJoinPart(const std::filesystem::path& folder) {
  if (isJoined(folder))
    throw SceneError(fmt::format("--join: {} is itself joined, accepted: its parts, in one command",
                                 folder.string()));
  std::error_code failed;
  if (!std::filesystem::exists(folder / "work/spec.json", failed))
    throw SceneError(fmt::format("--join: {} holds no dataset", folder.string()));
  JoinPart part{folder, readFolderSpec(folder)};
  const WorkFolder work(folder, part.spec);
  int missing = 0;
  std::string first_flaw;
  for (int heart = 0; heart < part.spec.hearts; ++heart) {
    WorkFolder::Finished one = work.finished(heart, WorkFolder::Look::sizes);
    if (first_flaw.empty()) first_flaw = one.flaw;
    if (one.record)
      part.records.push_back(std::move(*one.record));
    else
      ++missing;
  }
  if (missing > 0)
    throw SceneError(fmt::format("--join: {} of {} hearts of {} are missing or damaged{}{}",
                                 missing, part.spec.hearts, folder.string(),
                                 first_flaw.empty() ? "" : ", first ", first_flaw));
  return part;
}

void checkNoHeartTwice(const std::vector<JoinPart>& parts) {
  checkKeys(parts, [](const JoinPart&, const Json& record) { return heartKey(record); });
  checkKeys(parts, [](const JoinPart& part, const Json& record) {
    return fmt::format("{} {}", part.spec.heart_digest, record.at("heart").get<int>());
  });
  checkScenes(parts);
}

Json joinedHeart(const JoinPart& part, const Json& record, const std::vector<std::string>& layouts,
                 Sink& sink) {
  const int from = record.at("heart").get<int>(), to = part.before + from;
  const Renumbered names(from, to);
  Json joined = record;
  joined["heart"] = to;
  if (isFailure(record)) return joined;
  joined["layouts"] = layouts;
  for (Json& loop : joined["loops"]) {
    const std::string id = loop.at("id").get<std::string>();
    loop["id"] = names.id(id);
    if (loop.contains("nnunet"))
      for (Json& name : loop["nnunet"]) name = names.id(name.get<std::string>());
    loop["joined"] = originOf(part, id);
  }
  for (const auto& [name, noted] : record.at("files").items()) {
    const std::string layout = name.substr(0, name.find('/'));
    if (std::find(layouts.begin(), layouts.end(), layout) == layouts.end()) continue;
    std::string bytes = wholeFile(part, name, noted);
    if (name.ends_with("/loop.json")) bytes = renumberedLoop(part, bytes, names, to);
    writeIfChanged(sink, names.file(name), bytes);
  }
  return joined;
}

}  // namespace echocine::dataset
