#pragma once
// How the accuracy of a run was chosen, for its manifest.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace echocine {

// A setting that was tried.
struct AccuracyCandidate {
  std::string setting;    // scene keys and values
  double error_db = 0;    // of the worst probe frame
  double cost_ms = 0;     // by the model of counted work
  double probe_ms = 0;    // a probe frame took this long; the choice does not look at it
  bool accepted = false;  // its error is small enough
};

struct AccuracyRecord {
  std::string preset;                  // that was asked for; empty: none
  std::optional<double> tolerance_db;  // that was asked for
  double safety = 1;                   // error times this had to stay within the tolerance
  std::vector<double> probe_phases;
  std::string setting;  // the choice; empty when the scene is rendered as written
  std::string reason;
  std::vector<AccuracyCandidate> candidates;  // in the order in which they were tried
};

nlohmann::ordered_json accuracyJson(const AccuracyRecord& record);

}  // namespace echocine
