#pragma once
// DCMTK's dictionary of elements, which it loads with its first element.

namespace echocine {

// Loads the dictionary. Throws std::bad_alloc if memory may not suffice: DCMTK does not check its
// allocations while it loads, so one that fails there would end the program. Thread-safe.
void loadDicomDictionary();

}  // namespace echocine
