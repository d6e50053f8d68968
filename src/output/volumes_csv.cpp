#include "output/volumes_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "truth/aha_segments.h"

namespace echocine {

namespace {

bool isChamber(const Scene& scene, const Structure& structure) {
  return !structure.membrane && scene.medium(structure.medium).blood;
}

// RFC 4180: a field with a comma, a quote or a line break is quoted.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format(",{}", value) : ",";
}

// The column of a curve of longitudinal strain; empty for other curves, and for those without
// values of a run whose truth has no function.
std::string strainColumn(const std::string& curve, const std::vector<double>& values) {
  if (values.empty()) return {};
  constexpr std::string_view kStrain = "longitudinal_strain";
  if (curve.ends_with(kStrain)) return curve;
  if (std::find(std::begin(kAhaNames), std::end(kAhaNames), curve) == std::end(kAhaNames))
    return {};
  std::string name = fmt::format("{} {}", curve, kStrain);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace

bool hasChambers(const Scene& scene) {
  return std::any_of(scene.structures.begin(), scene.structures.end(),
                     [&](const Structure& s) { return isChamber(scene, s); });
}

std::string volumesCsv(const Scene& scene, const Manifest& manifest) {
  std::string text = "frame,time_s,phase,beat";
  for (const Structure& s : scene.structures)
    if (isChamber(scene, s)) text += ',' + quoted(s.name + "_ml");
  for (const auto& [name, values] : manifest.curves)
    if (const std::string column = strainColumn(name, values); !column.empty())
      text += ',' + column;
  for (std::size_t i = 0; i < manifest.frames.size(); ++i) {
    const FrameEntry& frame = manifest.frames[i];
    const FrameRecord& r = frame.record;
    text += fmt::format("\n{},{},{},{}", r.frame, r.time_s, r.phase, r.beat);
    for (const Structure& s : scene.structures) {
      if (!isChamber(scene, s)) continue;
      const auto volume = std::find_if(frame.volumes_ml.begin(), frame.volumes_ml.end(),
                                       [&](const auto& v) { return v.first == s.name; });
      text += cell(volume == frame.volumes_ml.end() ? NAN : volume->second);
    }
    for (const auto& [name, values] : manifest.curves)
      if (!strainColumn(name, values).empty()) text += cell(values[i]);
  }
  return text + "\n";
}

}  // namespace echocine
