#include "fit/searched_dials.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace echocine::fit {

const std::vector<SearchedDial>& searchedDials() {
  static const std::vector<SearchedDial> kDials{{{"ef", 0.15, 0.75}, 0.05},
                                                {{"edv", 50, 280}, 10},
                                                {{"wall-thickness", 5, 15}, 1.5},
                                                {{"sphericity", 0.46, 0.78}, 0.04},
                                                {{"mapse", 3, 20}, 2.5},
                                                {{"conicity", 0.55, 0.95}, 0.05},
                                                {{"la-volume", 20, 130}, 8},
                                                {{"apical-motion", 0.65, 1.5}, 0.12},
                                                {{kRightRatio, 0.8, 1.35}, 0.06},
                                                {{"bow-lateral", -0.06, 0.06}, 0.01},
                                                {{"bow-anterior", -0.06, 0.06}, 0.01},
                                                {{"ellipticity", -0.3, 0.3}, 0.05},
                                                {{"ellipticity-45", -0.3, 0.3}, 0.05},
                                                {{"apical-thickness", 0.7, 1.3}, 0.12},
                                                {{"lateral-thickness", 0.7, 1.3}, 0.12},
                                                {{"anterior-thickness", 0.7, 1.3}, 0.12}};
  return kDials;
}

std::vector<std::string> dialsSearchedIn(std::size_t views, bool own_look) {
  std::vector<std::string> keys{"ef", "edv", "wall-thickness", "sphericity", "mapse"};
  if (views > 1) keys.emplace_back("conicity");
  if (views > 2) keys.insert(keys.end(), {"apical-motion", kRightRatio});
  for (const SearchedDial& dial : searchedDials())
    if (views > 2 && own_look && heart::isSectionDial(dial.range.key))
      keys.push_back(dial.range.key);
  return keys;
}

std::string searchedKeys() {
  std::string keys;
  for (const SearchedDial& dial : searchedDials())
    keys += (keys.empty() ? "" : ", ") + dial.range.key;
  return keys;
}

void checkSearched(const std::vector<std::string>& keys) {
  for (const std::string& key : keys)
    if (std::none_of(searchedDials().begin(), searchedDials().end(),
                     [&](const SearchedDial& dial) { return dial.range.key == key; }))
      throw SceneError(fmt::format("searched: is \"{}\", accepted: {}", key, searchedKeys()));
}

bool isFixed(const std::string& key, const std::map<std::string, double>& dials) {
  return dials.contains(key) || (key == kRightRatio && dials.contains("rv-edv")) ||
         (key == "sphericity" && dials.contains("lv-length"));
}

void addFollowers(std::map<std::string, double>& dials) {
  if (const auto given = dials.find(kRightRatio); given != dials.end()) {
    const double ratio = given->second;
    dials.erase(given);
    const heart::Parameters p = heart::parametersFrom(dials);
    constexpr double kAboveLimit = 1 + 1e-6;  // of a rounded quotient
    dials["rv-edv"] =
        p.edv_ml * std::max(ratio, kAboveLimit * p.ejection_fraction / heart::kMostRightEjected);
  }
  const auto left = dials.find("la-volume");
  if (left == dials.end() || dials.contains("ra-volume")) return;
  const heart::Parameters healthy;
  dials["ra-volume"] = healthy.ra_volume_ml / healthy.la_volume_ml * left->second;
}

double stepOf(const DialRange& range) {
  const double whole = range.high - range.low;
  const auto& dials = searchedDials();
  const auto known = std::find_if(dials.begin(), dials.end(), [&](const SearchedDial& dial) {
    return dial.range.key == range.key;
  });
  return known == dials.end() ? whole / 10 : std::min(known->step, whole / 4);
}

}  // namespace echocine::fit
