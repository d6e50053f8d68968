#include <nlohmann/json.hpp>

#include "dataset/layout.h"
#include "dataset/record_check.h"
#include "dataset/spec.h"
#include "promises.h"
#include "targets.h"

namespace echocine::fuzz {

namespace {

using dataset::Json;
using dataset::Spec;

const Spec& recordSpec() {
  static const Spec spec = dataset::parseSpec(
      "name = \"fuzz\"\nhearts = 2\nviews = [\"a4c\"]\n"
      "layouts = [\"native\", \"echonet\", \"nnunet\", \"webdataset\"]\n",
      "spec.toml");
  return spec;
}

// The tables are made of what passed. A layout's own entries are read there; a wrong one is an
// exception of JSON, which mergeParts() turns into words.
void mergeOne(const Json& record) {
  dataset::Sink sink(scratchFolder() / "merged");
  for (const dataset::Layout* layout : dataset::layoutsOf(recordSpec())) {
    if (layout->merge == nullptr) continue;
    try {
      accepts([&] { layout->merge(recordSpec(), std::span(&record, 1), sink); });
    } catch (const Json::exception&) {
    }
  }
}

void checkOne(std::string_view text) {
  const dataset::CheckedRecord checked = dataset::checkRecord(text, recordSpec(), 0);
  promise(checked.flaw.empty() != checked.record.is_null(), "a flaw and a record at once");
  if (!checked.flaw.empty()) return;
  if (checked.record.contains("loops")) mergeOne(checked.record);
}

}  // namespace

// As it stands, and with a digest that is right: whoever forges a record can make one.
void record(std::string_view bytes) {
  checkOne(bytes);
  const Json json = Json::parse(bytes, nullptr, false);
  if (!json.is_object()) return;
  Json unsealed = json;
  unsealed.erase("record_digest");
  unsealed["spec"] = recordSpec().heart_digest;
  if (unsealed.empty()) return;
  try {
    checkOne(dataset::sealedText(unsealed));
  } catch (const Json::exception&) {  // text that is not UTF-8 cannot be sealed
  }
}

void spec(std::string_view bytes) {
  accepts([&] {
    const Spec read = dataset::parseSpec(bytes, scratchFolder() / "spec.toml");
    promise(read.hearts > 0 && !read.views.empty() && !read.layouts.empty(), "a spec of nothing");
    dataset::checkSpec(read);
  });
}

}  // namespace echocine::fuzz
