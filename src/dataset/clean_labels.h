#pragma once
// Label pictures as annotators leave them.

#include <cstdint>
#include <vector>

namespace echocine::dataset {

// The left ventricle's cavity (label 1) as one piece without holes: its largest piece, joined over
// edges, stays; other pieces become background, and what it encloses becomes cavity.
std::vector<std::uint8_t> wholeCavity(const std::vector<std::uint8_t>& labels, int width,
                                      int height);

}  // namespace echocine::dataset
