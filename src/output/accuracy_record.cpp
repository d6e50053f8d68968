#include "output/accuracy_record.h"

#include <nlohmann/json.hpp>

namespace echocine {

using Json = nlohmann::ordered_json;

Json accuracyJson(const AccuracyRecord& record) {
  // Neither preset nor tolerance: the scene says all.
  if (record.setting.empty()) return {{"setting", "as written"}};
  Json json{{"setting", record.setting}, {"reason", record.reason}};
  if (!record.preset.empty()) json["preset"] = record.preset;
  if (!record.tolerance_db) return json;
  json["tolerance_db"] = *record.tolerance_db;
  json["safety"] = record.safety;
  json["probe_phases"] = record.probe_phases;
  Json& candidates = json["candidates"] = Json::array();
  for (const AccuracyCandidate& c : record.candidates)
    candidates.push_back({{"setting", c.setting},
                          {"error_db", c.error_db},
                          {"cost_ms", c.cost_ms},
                          {"probe_ms", c.probe_ms},
                          {"accepted", c.accepted}});
  return json;
}

}  // namespace echocine
