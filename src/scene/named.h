#pragma once
// What a value of an enum is called in scene files. An enum's list stands beside the enum where
// adding a value should take one file, else in names.h.

namespace echocine {

template <typename E>
struct Named {
  E value;
  const char* name;
};

// Specialised with `kAll`, every value once in the enum's order.
template <typename E>
struct NamesOf;

}  // namespace echocine
