#pragma once
// Records are read back from a disk that others can write to: nothing in them is believed
// unchecked.

#include "dataset/layout.h"

namespace echocine::dataset {

// A record as the text of its file: JSON on one line that ends with a digest of the rest.
std::string sealedText(const Json& record);

struct CheckedRecord {
  Json record;       // without its digest; null where there is a flaw
  std::string flaw;  // "another byte than was written"; empty for a sound record
};

// Sound is the text of sealedText() of a record of this spec and heart (from 0): its keys are there
// with their types, its population and split are the spec's, it has a loop a view, names of files
// stay below the folder. Never throws.
CheckedRecord checkRecord(std::string_view text, const Spec& spec, int heart);

}  // namespace echocine::dataset
