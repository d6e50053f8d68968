#pragma once
// The layouts that loops are written in: one interface, one file each.

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "dataset/sink.h"

namespace echocine::dataset {

using Json = nlohmann::ordered_json;

// What a finished heart left: heart, population, split, loops with their numbers, files.
struct Layout {
  const char* name;
  // A heart's own files; none where it is null. `record` has its loops already, one entry each; a
  // layout adds what its tables need.
  void (*write)(const Spec& spec, const Heart& heart, Sink& sink, Json& record);
  // Files of the whole dataset, from the records of all hearts in their order; none where it is
  // null. Of the records' files, those of the native layout are there if the spec has webdataset.
  void (*merge)(const Spec& spec, std::span<const Json> records, Sink& sink);
};

// Those that a spec asks for, in the order of their names.
std::vector<const Layout*> layoutsOf(const Spec& spec);

extern const Layout kNative, kEchonet, kCamus, kMyotracker, kNnunet, kPointodyssey, kWebdataset;

const char* nameOf(Split split);  // "train", "val", "test"

}  // namespace echocine::dataset
