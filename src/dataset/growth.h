#pragma once
// Growth of a dataset in its folder: changes of a spec that leave finished loops as they are.

#include <string>
#include <vector>

#include "dataset/spec.h"

namespace echocine::dataset {

// Keys that can change in a folder: they select or describe loops, or belong to the merge only.
bool canGrow(std::string_view key);

// "key: A -> B" for each key whose values differ, in ascending order; "absent" for a missing one.
// Comments and order do not count. Throws SceneError if one is not TOML.
std::vector<std::string> differencesOf(std::string_view earlier, std::string_view later);

// Why a folder with the earlier spec's loops cannot continue with the later one; empty if it can.
// The fault names the key.
std::string growthFault(const Spec& earlier, const Spec& later);

}  // namespace echocine::dataset
