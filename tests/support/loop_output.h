#pragma once
// What a run leaves in its folder, ready to be compared with what another left.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "support/cine_frames.h"
#include "support/run_program.h"

namespace echocine::support {

namespace fs = std::filesystem;

// The manifest without what is measured in time.
inline std::string timelessManifest(const fs::path& file) {
  nlohmann::json json = nlohmann::json::parse(bytesOf(file), nullptr, false);
  if (json.is_discarded()) return "no JSON";
  json.erase("timings_ms_per_frame");
  json.erase("manifest_sha256");
  for (nlohmann::json& effect : json["effects"]) effect.erase("time_share");
  json["files"].erase("report.html");
  return json.dump();
}

// Every file by its name below the folder; of the report, which shows times, that it is there.
inline std::map<std::string, std::string> leftIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code absent;
  for (fs::recursive_directory_iterator it(folder, absent), end; it != end; it.increment(absent))
    if (it->is_regular_file()) {
      const bool manifest = it->path().filename() == "manifest.json";
      files[it->path().lexically_relative(folder).string()] =
          manifest                                 ? timelessManifest(it->path())
          : it->path().filename() == "report.html" ? "a report"
                                                   : bytesOf(it->path());
    }
  return files;
}

inline bool isPart(const std::string& name) {
  return name.ends_with(".part");
}

// Every frame that bears its name is the undisturbed run's, and a cine plays.
inline void expectOnlyWholeFiles(const fs::path& folder,
                                 const std::map<std::string, std::string>& undisturbed) {
  for (const auto& [name, bytes] : leftIn(folder)) {
    if (isPart(name)) continue;
    const auto whole = undisturbed.find(name);
    ASSERT_NE(whole, undisturbed.end()) << name;
    if (name == "cine.avi")
      EXPECT_GT(cineFrames(folder / name), 0);
    else
      EXPECT_TRUE(bytes == whole->second) << name << " differs";
  }
}

// The same files with the same bytes, and nothing else.
inline void expectSame(const std::map<std::string, std::string>& found,
                       const std::map<std::string, std::string>& wanted) {
  for (const auto& [name, bytes] : wanted) {
    const auto it = found.find(name);
    if (it == found.end())
      ADD_FAILURE() << name << " is missing";
    else
      EXPECT_TRUE(it->second == bytes) << name << " differs";
  }
  for (const auto& [name, bytes] : found)
    EXPECT_TRUE(wanted.count(name)) << name << " is one too many";
}

inline void expectOneLine(const Outcome& outcome, int code) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("echocine: ")) << outcome.err;
}

}  // namespace echocine::support
