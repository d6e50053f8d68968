#pragma once
// Computed beats of parametric hearts in a folder, so that a later fit reads what an earlier one
// computed. A heart takes 0.3 s of one core to compute.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "motion/heart/recording.h"

namespace echocine::fit {

// Size of a cache folder; our choice: about ten fits.
inline constexpr std::uintmax_t kMostCacheBytes = std::uintmax_t{1} << 30;

// One file heart_DIGEST.bin for each heart. The digest is that of the dials, the number of frames
// and this program's own file, so another build computes its hearts anew. Files are written under
// another name and renamed: processes may share a folder. A damaged file is computed anew.
// Functions throw nothing: a folder that cannot be written is reported to `warn` once.
class HeartCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  HeartCache() = default;  // keeps nothing
  explicit HeartCache(
      std::filesystem::path folder, std::uintmax_t most_bytes = kMostCacheBytes,
      Warn warn = [](const std::string&) {});

  // The beat that was kept for these dials, by key, in so many frames.
  std::optional<heart::Recording> find(const std::map<std::string, double>& dials,
                                       int frames) const;
  void keep(const std::map<std::string, double>& dials, int frames, const heart::Recording& beat);
  // Removes the files that were used least recently until the folder has at most its size.
  void prune() const;

  // Empty if the cache keeps nothing.
  std::filesystem::path fileOf(const std::map<std::string, double>& dials, int frames) const;

 private:
  std::filesystem::path folder_;
  std::uintmax_t most_bytes_ = 0;
  Warn warn_;
};

// $XDG_CACHE_HOME/echocine/hearts, or ~/.cache/echocine/hearts; empty if the user has neither.
std::filesystem::path userHeartCache();

// Digest of the file that this code runs from, a program or a library; empty if it is unknown.
const std::string& ownProgramDigest();

}  // namespace echocine::fit
