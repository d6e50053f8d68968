#pragma once
// Labels of all structures of a heart, by role, so that they are the same in every view and scene.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace echocine::dataset {

// nnU-Net's names of the labels 0, 1, ...: background, then one per role. Labels 1 to 3 are
// CAMUS's.
std::vector<const char*> structureLabelNames();

// Role and number, as truth.labels of a scene takes them.
std::vector<std::pair<std::string, int>> structureNumbers();

// CAMUS's label of a pixel with one of these labels: papillary muscles count as cavity.
std::uint8_t camusLabel(std::uint8_t structure_label);

}  // namespace echocine::dataset
