#include "output/earlier_hashes.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/seal.h"

namespace echocine {

namespace {

// Null when there is none, or none as a run wrote it.
nlohmann::json manifestAt(const std::filesystem::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // a million frames are 300 MB
  std::error_code absent;
  if (!std::filesystem::is_regular_file(file, absent)) return {};
  try {
    const std::string text = readTextFile(file, kMaxBytes);
    if (!isSealed(text)) return {};
    auto json = nlohmann::json::parse(text, nullptr, false);
    return json.is_object() ? json : nlohmann::json();
  } catch (const SceneError&) {
    return {};
  }
}

}  // namespace

std::map<std::string, std::string> earlierHashes(const std::filesystem::path& manifest,
                                                 const std::string& scene_sha256) {
  std::map<std::string, std::string> hashes;
  const nlohmann::json json = manifestAt(manifest);
  if (!json.contains("scene_sha256") || json["scene_sha256"] != scene_sha256) return {};
  if (!json.contains("files") || !json["files"].is_object()) return {};
  for (const auto& [name, hash] : json["files"].items())
    if (hash.is_string()) hashes[name] = hash;
  return hashes;
}

bool isOfAnotherScene(const std::filesystem::path& manifest, const std::string& scene_sha256) {
  const nlohmann::json json = manifestAt(manifest);
  return json.contains("scene_sha256") && json["scene_sha256"] != scene_sha256;
}

}  // namespace echocine
