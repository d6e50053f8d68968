#pragma once
// Files about a dataset as a whole: tables, splits, card.

#include <span>

#include "dataset/layout.h"
#include "dataset/real_loops.h"

namespace echocine::dataset {

// Facts about a dataset that tables and card need beside its records.
struct DatasetFacts {
  std::string name, licence;
  std::string digest;  // of its spec, or of those of its parts
  std::vector<std::string> layouts;
  Json origin;        // further keys of dataset.json: seed and distributions
  std::string again;  // rows of the card's first table: how the dataset is made again
  std::string real_loops = realLoopsText({});  // the card's section about real loops
};

DatasetFacts factsOf(const Spec& spec);

// By population: weight, and each parameter's distribution with its source.
Json distributionsJson(const Spec& spec);

// loops.csv (one row per loop with all numbers), splits.json, impossible.csv, failed.csv,
// dataset.json and the card, README.md with figures/. Records are in the order of hearts.
void writeTables(const DatasetFacts& facts, std::span<const Json> records,
                 std::span<const Json> failures, Sink& sink);

// README.md and figures/.
void writeCard(const DatasetFacts& facts, std::span<const Json> records, const Json& counts,
               Sink& sink);

}  // namespace echocine::dataset
