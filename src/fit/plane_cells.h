#pragma once
// Cells of a model's plane: their places, tissues, and weights by the distance from blood.

#include <vector>

#include "fit/model_plane.h"

namespace echocine::fit {

// The cells of a sector without their tissues, by line and then depth.
std::vector<TissueCell> planeCells(const Probe& probe);
// Sets the two tissues of most of a cell's samples. ids: structures by number from 1, 0 for the
// background; tissue_of: by these numbers.
void setTissues(TissueCell& cell, const std::uint32_t* ids,
                const std::vector<std::uint8_t>& tissue_of);

// Cells have full weight up to this distance from blood, and none beyond twice the distance: the
// model does not describe the surroundings of a heart. Our choice: the thickness of a wall.
inline constexpr double kNearBlood_m = 10e-3;
void weighByBlood(const ModelLoop& loop, ModelFrame& frame);

// Reduces cells far from the left ventricle to kOtherChambers; the distances are the same. `left`:
// its blood's share of each cell.
void weighByLeftVentricle(const ModelLoop& loop, const std::vector<float>& left, ModelFrame& frame);

}  // namespace echocine::fit
