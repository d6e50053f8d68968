#include "dataset/record_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/digest.h"
#include "dataset/record.h"

namespace echocine::dataset {

namespace {

constexpr const char* kSeal = "record_digest";

constexpr std::size_t kSealSize = sizeof(",\"record_digest\":\"\"}\n") - 1 + Digest::kDigits;

// The end of a record's text: the digest of what stands before it.
std::string sealOf(std::string_view text) {
  return fmt::format(",\"{}\":\"{}\"}}\n", kSeal, digestOfBytes(std::as_bytes(std::span(text))));
}

// JSON nested deeper than a record would exhaust the stack where it is written again.
bool isShallow(std::string_view text) {
  constexpr int kDeepest = 16;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > kDeepest)
      return false;
    else if (!quoted && (c == ']' || c == '}'))
      --depth;
  }
  return true;
}

using Kind = bool (Json::*)() const noexcept;

struct Key {
  const char* name;
  Kind kind;
};

constexpr Key kOfHeart[] = {{"population", &Json::is_string},
                            {"split", &Json::is_string},
                            {"attempt", &Json::is_number_unsigned},
                            {"impossible", &Json::is_array},
                            {"layouts", &Json::is_array},
                            {"loops", &Json::is_array},
                            {"files", &Json::is_object}};
constexpr Key kOfLoop[] = {{"id", &Json::is_string},
                           {"view", &Json::is_string},
                           {"frames", &Json::is_number_unsigned},
                           {"frame_rate_hz", &Json::is_number},
                           {"width", &Json::is_number_unsigned},
                           {"height", &Json::is_number_unsigned},
                           {"mm_per_pixel", &Json::is_number},
                           {"ed_frame", &Json::is_number_unsigned},
                           {"es_frame", &Json::is_number_unsigned},
                           {"edv_ml", &Json::is_number},
                           {"esv_ml", &Json::is_number},
                           {"ef_percent", &Json::is_number},
                           {"drawn", &Json::is_object}};
constexpr Key kOfFile[] = {{"bytes", &Json::is_number_unsigned}, {"digest", &Json::is_string}};

// The first key that is absent or of another type; null where all are as they should be.
const char* wrongKey(const Json& json, std::span<const Key> keys) {
  for (const Key& key : keys) {
    const auto found = json.is_object() ? json.find(key.name) : json.end();
    if (found == json.end() || !((*found).*key.kind)()) return key.name;
  }
  return nullptr;
}

// A plain name: what becomes part of a path or of a table's row.
bool isPlainName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-';
  });
}

bool staysBelow(const std::filesystem::path& name) {
  return !name.empty() && name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
}

std::string flawOfLoops(const Json& record, const Spec& spec) {
  const Json& loops = record["loops"];
  if (loops.size() != spec.views.size())
    return fmt::format("{} loops where the spec has {} views", loops.size(), spec.views.size());
  for (const Json& loop : loops) {
    if (const char* key = wrongKey(loop, kOfLoop))
      return fmt::format("loops: \"{}\" is absent or of another type", key);
    if (!isPlainName(loop["id"].get_ref<const std::string&>()))
      return "loops: \"id\" is not a name";
    const auto frames = loop["frames"].get<std::int64_t>();
    for (const char* key : {"ed_frame", "es_frame"})
      if (const auto frame = loop[key].get<std::int64_t>(); frame < 0 || frame >= frames)
        return fmt::format("loops: \"{}\" is not in the loop", key);
  }
  return {};
}

std::string flawOfFiles(const Json& record) {
  for (const auto& [name, noted] : record["files"].items()) {
    if (!staysBelow(name)) return "files: a name leads out of the folder";
    if (const char* key = wrongKey(noted, kOfFile))
      return fmt::format("files: \"{}\" is absent or of another type", key);
  }
  return {};
}

std::string flawOf(const Json& record, const Spec& spec, int heart) {
  const auto has = [&](const char* key, const Json& value) {
    const auto found = record.find(key);
    return found != record.end() && *found == value;
  };
  if (!has("spec", spec.heart_digest)) return "it belongs to another spec or program version";
  if (!has("heart", heart + 1)) return "it is of another heart";
  if (isFailure(record))
    return record["failed"].is_string() && has("seed", spec.seed)
               ? ""
               : "\"failed\" or \"seed\" is absent or of another type";
  if (const char* key = wrongKey(record, kOfHeart))
    return fmt::format("\"{}\" is absent or of another type", key);
  const auto isOf = [&](const Population& p) { return record["population"] == p.name; };
  if (std::none_of(spec.populations.begin(), spec.populations.end(), isOf))
    return "\"population\" is none of the spec's";
  if (record["split"] != nameOf(spec.splitOf(heart))) return "\"split\" is not the heart's";
  if (!std::all_of(record["impossible"].begin(), record["impossible"].end(),
                   [](const Json& reason) { return reason.is_string(); }))
    return "\"impossible\" is of another type";
  const std::string loops = flawOfLoops(record, spec);
  return loops.empty() ? flawOfFiles(record) : loops;
}

// Each loop has the view of its place in the spec, as far as both go.
bool inOrder(const Json& loops, const Spec& spec) {
  for (std::size_t v = 0; v < std::min(loops.size(), spec.views.size()); ++v)
    if (const Json& loop = loops[v]; loop.is_object() && loop.contains("view") &&
                                     loop["view"].is_string() &&
                                     loop["view"] != keyOf(spec.views[v]))
      return false;
  return true;
}

// Lacks the record a view or a layout of the spec, or are its views in another order?
bool isOutgrown(const Json& record, const Spec& spec) {
  if (!record.contains("loops") || !record.contains("layouts")) return false;
  const Json &loops = record["loops"], &layouts = record["layouts"];
  if (!loops.is_array() || !layouts.is_array()) return false;
  const bool lacks =
      std::any_of(spec.layouts.begin(), spec.layouts.end(), [&](const std::string& layout) {
        return std::find(layouts.begin(), layouts.end(), layout) == layouts.end();
      });
  return (!loops.empty() && loops.size() < spec.views.size()) || lacks || !inOrder(loops, spec);
}

}  // namespace

std::string sealedText(const Json& record) {
  // A reason may name a file whose name is no UTF-8.
  std::string text = record.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();  // the closing brace
  return text + sealOf(text);
}

CheckedRecord checkRecord(std::string_view text, const Spec& spec, int heart) {
  if (text.size() < kSealSize ||
      text.substr(text.size() - kSealSize) != sealOf(text.substr(0, text.size() - kSealSize)))
    return {nullptr, false, "it is truncated or modified"};
  Json record = isShallow(text) ? Json::parse(text, nullptr, false) : Json();
  if (!record.is_object()) return {nullptr, false, "it is not JSON of this program"};
  record.erase(kSeal);
  const auto has = [&](const char* key, const Json& value) {
    const auto found = record.find(key);
    return found != record.end() && *found == value;
  };
  if (has("spec", spec.heart_digest) && has("heart", heart + 1) && isOutgrown(record, spec))
    return {nullptr, true, ""};
  std::string flaw = flawOf(record, spec, heart);
  if (!flaw.empty()) return {nullptr, false, std::move(flaw)};
  return {std::move(record), false, ""};
}

}  // namespace echocine::dataset
