#pragma once
// Verification of records: other programs can change them on disk.

#include "dataset/layout.h"

namespace echocine::dataset {

// A record as the text of its file: JSON on one line that ends with a digest of the rest.
std::string sealedText(const Json& record);

struct CheckedRecord {
  Json record;  // without its digest; null with a flaw
  // Sound, but of an earlier spec with fewer views or layouts: its heart is to be rendered again.
  bool outgrown = false;
  std::string flaw;  // such as "another byte than was written"; empty for a valid record
};

// A valid text is sealedText() of a record of this spec and heart (from 0): its keys exist with
// their types, population and split are the spec's, it has one loop per view, and file names stay
// below the folder. Never throws.
CheckedRecord checkRecord(std::string_view text, const Spec& spec, int heart);

}  // namespace echocine::dataset
