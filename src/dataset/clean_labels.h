#pragma once
// Label pictures in the form of manual annotations.

#include <cstdint>
#include <vector>

namespace echocine::dataset {

// The left ventricle's cavity (label 1) as one piece without holes: its largest 4-connected piece
// stays, other pieces become background, and enclosed pixels become cavity.
std::vector<std::uint8_t> wholeCavity(const std::vector<std::uint8_t>& labels, int width,
                                      int height);

}  // namespace echocine::dataset
