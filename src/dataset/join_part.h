#pragma once
// One part of a join: its records, and its hearts under their new numbers.

#include <string>
#include <vector>

#include "dataset/layout.h"

namespace echocine::dataset {

struct JoinPart {
  std::filesystem::path folder;
  Spec spec;
  int number = 1;               // of the part
  int before = 0;               // hearts of the parts before it
  std::vector<Json> records{};  // of all its hearts; failures too
};

// Reads a finished dataset. Throws SceneError, naming missing or damaged hearts.
JoinPart readJoinPart(const std::filesystem::path& folder);

// Throws SceneError if the parts hold the same heart, or a scene in different splits.
void checkNoHeartTwice(const std::vector<JoinPart>& parts);

// Copies the heart's files of these layouts into the sink's folder under the new number, and
// returns its record there. Files that are already there with the same bytes stay. Throws JobError.
Json joinedHeart(const JoinPart& part, const Json& record, const std::vector<std::string>& layouts,
                 Sink& sink);

}  // namespace echocine::dataset
