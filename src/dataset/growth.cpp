#include "dataset/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "scene/toml_flat.h"

namespace echocine::dataset {

namespace {

// Each item of `earlier` is in `later`.
template <typename T>
bool holdsAll(const std::vector<T>& later, const std::vector<T>& earlier) {
  return std::all_of(earlier.begin(), earlier.end(), [&](const T& item) {
    return std::find(later.begin(), later.end(), item) != later.end();
  });
}

}  // namespace

bool canGrow(std::string_view key) {
  constexpr std::string_view kKeys[] = {"hearts", "views",   "layouts",
                                        "name",   "licence", "shard_mb"};
  return std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys);
}

std::vector<std::string> differencesOf(std::string_view earlier, std::string_view later) {
  const auto a = flatValues(earlier, "spec"), b = flatValues(later, "spec");
  std::set<std::string> keys;
  for (const auto* values : {&a, &b})
    for (const auto& [key, value] : *values) keys.insert(key);
  std::vector<std::string> differences;
  const auto valueIn = [](const auto& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("absent") : found->second;
  };
  for (const std::string& key : keys)
    if (const std::string from = valueIn(a, key), to = valueIn(b, key); from != to)
      differences.push_back(fmt::format("{}: {} -> {}", key, from, to));
  return differences;
}

std::string growthFault(const Spec& earlier, const Spec& later) {
  if (earlier.heart_digest != later.heart_digest) {
    std::vector<std::string> changed = differencesOf(earlier.text, later.text);
    std::erase_if(changed, [](const std::string& difference) {
      return canGrow(difference.substr(0, difference.find(':')));
    });
    if (changed.empty()) return "another program version, or other scenes or meshes";
    constexpr std::size_t kShown = 3;
    const std::size_t more = changed.size() - std::min(kShown, changed.size());
    changed.resize(changed.size() - more);
    return fmt::format("{}{}", fmt::join(changed, ", "),
                       more > 0 ? fmt::format(" and {} more keys", more) : "");
  }
  if (later.hearts < earlier.hearts)
    return fmt::format("hearts: {} are fewer than the folder's {}", later.hearts, earlier.hearts);
  if (!holdsAll(later.views, earlier.views)) return "views: one of the folder's is left out";
  if (!holdsAll(later.layouts, earlier.layouts)) return "layouts: one of the folder's is left out";
  if (later.wantsTracks() != earlier.wantsTracks())
    return "layouts: the new one adds tracks to the truth of finished loops";
  for (int heart = 0; heart < earlier.hearts; ++heart)
    if (later.splitOf(heart) != earlier.splitOf(heart))
      return fmt::format(
          "hearts: {} move heart {} into another split; accepted: hearts = [{}, {}], each block "
          "split by itself",
          later.hearts, heart + 1, earlier.hearts, later.hearts - earlier.hearts);
  return {};
}

}  // namespace echocine::dataset
