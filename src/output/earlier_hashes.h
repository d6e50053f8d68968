#pragma once
// File hashes of an earlier run's manifest.json, for resuming.

#include <filesystem>
#include <map>
#include <string>

namespace echocine {

// Path relative to the folder -> SHA-256. Empty without a readable manifest of this scene.
std::map<std::string, std::string> earlierHashes(const std::filesystem::path& manifest,
                                                 const std::string& scene_sha256);

// Is the manifest readable and of another scene?
bool isOfAnotherScene(const std::filesystem::path& manifest, const std::string& scene_sha256);

}  // namespace echocine
