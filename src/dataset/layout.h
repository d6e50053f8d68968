#pragma once
// The file layouts of loops: one interface, one file each.

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "dataset/sink.h"

namespace echocine::dataset {

using Json = nlohmann::ordered_json;

// A layout. Records of finished hearts contain heart, population, split, loops with their numbers,
// and files.
struct Layout {
  const char* name;
  // Writes a heart's own files; null: none. `record` already has one entry per loop; a layout adds
  // data for its tables.
  void (*write)(const Spec& spec, const Heart& heart, Sink& sink, Json& record);
  // Writes files of the whole dataset, from the records of all hearts in order; null: none. Files
  // of the native layout are available if the spec has webdataset.
  void (*merge)(const Spec& spec, std::span<const Json> records, Sink& sink);
};

// The layouts of a spec, ordered by name.
std::vector<const Layout*> layoutsOf(const Spec& spec);

extern const Layout kNative, kEchonet, kCamus, kDicom, kMyotracker, kNnunet, kPointodyssey,
    kWebdataset;

const char* nameOf(Split split);  // "train", "val", "test"

}  // namespace echocine::dataset
