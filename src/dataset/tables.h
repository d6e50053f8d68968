#pragma once
// Files about a dataset as a whole: tables, splits, card.

#include <span>

#include "dataset/layout.h"

namespace echocine::dataset {

// loops.csv (one row per loop with all numbers), splits.json, impossible.csv, failed.csv,
// dataset.json and the card, README.md with figures/. Records are in the order of hearts.
void writeTables(const Spec& spec, std::span<const Json> records, std::span<const Json> failures,
                 Sink& sink);

// README.md and figures/.
void writeCard(const Spec& spec, std::span<const Json> records, const Json& counts, Sink& sink);

}  // namespace echocine::dataset
