#pragma once
// Selection of the accuracy settings of a run, for its manifest.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace echocine {

// A setting that was tried.
struct AccuracyCandidate {
  std::string setting;    // scene keys and values
  double error_db = 0;    // of the worst test frame
  double cost_ms = 0;     // by the model of counted work
  double probe_ms = 0;    // measured time of a test frame; not used by the selection
  bool accepted = false;  // its error is within the limit
};

struct AccuracyRecord {
  std::string preset;                  // requested; empty: none
  std::optional<double> tolerance_db;  // requested
  double safety = 1;                   // factor of the error that must stay within the tolerance
  std::vector<double> probe_phases;
  std::string setting;  // the selected one; empty if the scene is rendered as written
  std::string reason;
  std::vector<AccuracyCandidate> candidates;  // in the order of the trials
};

nlohmann::ordered_json accuracyJson(const AccuracyRecord& record);

}  // namespace echocine
