#pragma once
// What an earlier run's manifest.json says of its files, for resuming.

#include <filesystem>
#include <map>
#include <string>

namespace echocine {

// Path relative to the folder -> SHA-256. Empty when there is no manifest, it cannot be read, or it
// is of another scene.
std::map<std::string, std::string> earlierHashes(const std::filesystem::path& manifest,
                                                 const std::string& scene_sha256);

// Whether the manifest can be read and is of another scene.
bool isOfAnotherScene(const std::filesystem::path& manifest, const std::string& scene_sha256);

}  // namespace echocine
