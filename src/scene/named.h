#pragma once
// Names of enum values in scene files. An enum's list stands beside the enum if adding a value
// should change one file, else in names.h.

namespace echocine {

template <typename E>
struct Named {
  E value;
  const char* name;
};

// Specialised with `kAll`, each value once in the enum's order.
template <typename E>
struct NamesOf;

}  // namespace echocine
