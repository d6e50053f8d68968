#pragma once
// The description of a mesh's fault, with a place for the repair that removes it.

#include <string>

#include "core/error.h"

namespace echocine {

// The `repair` word that removes this fault if it is the only one, and the text around it: before +
// prefix + words + suffix + after. Without words only `before` and `after` remain.
struct RepairOffer {
  std::string words;  // "repair = ["weld"]"; empty: none
  std::string prefix = ", or set ";
  std::string suffix = {};
};

class MeshFault : public SceneError {
 public:
  MeshFault(std::string before, RepairOffer offer, std::string after = {})
      : SceneError(joined(before, offer, after)),
        before_(std::move(before)),
        after_(std::move(after)),
        offer_(std::move(offer)) {}

  // With other repair words in the same place; without them if empty.
  std::string withRepair(const std::string& words) const {
    return joined(before_, {words, offer_.prefix, offer_.suffix}, after_);
  }

  // The same fault, preceded by `place`.
  MeshFault at(const std::string& place) const { return {place + before_, offer_, after_}; }

 private:
  static std::string joined(const std::string& before, const RepairOffer& offer,
                            const std::string& after) {
    if (offer.words.empty()) return before + after;
    return before + offer.prefix + offer.words + offer.suffix + after;
  }

  std::string before_, after_;
  RepairOffer offer_;
};

}  // namespace echocine
