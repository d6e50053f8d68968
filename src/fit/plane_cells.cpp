#include "fit/plane_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "core/lanes.h"
#include "core/vec3.h"

namespace echocine::fit {

namespace {

bool allEqual(const std::uint32_t* ids) {
  static_assert(kSamplesPerCell == sizeof(Uints8) / sizeof(std::uint32_t));
  Uints8 lanes;
  std::memcpy(&lanes, ids, sizeof lanes);
  return bitsOf(lanes == Uints8{} + ids[0]) == 0xff;
}

// 1 near cells with a share of 1, 0 far from them. The share, smoothed by kNearBlood_m, is a half
// above an even wall, 0.16 at one standard deviation from it, where the weight has just reached 1,
// and 0.02 at two.
cv::Mat nearnessOf(const ModelLoop& loop, const ModelFrame& frame, cv::Mat share) {
  const auto at = [&](int i, int k) {
    const TissueCell& cell = frame.cells[static_cast<std::size_t>(i * loop.cells_along + k)];
    return Vec3d{cell.x_m, 0, cell.z_m};
  };
  // Across the beams at half the depth; it widens with depth as beams do.
  const int i = loop.cells_across / 2, k = loop.cells_along / 2;
  const double along = kNearBlood_m / length(at(i, k + 1) - at(i, k)),
               across = kNearBlood_m / length(at(i + 1, k) - at(i, k));
  cv::GaussianBlur(share, share, {0, 0}, along, across, cv::BORDER_CONSTANT);
  constexpr float kFull = 0.16f, kNone = 0.02f;
  for (std::size_t c = 0; c < frame.cells.size(); ++c) {
    float& value = share.ptr<float>()[c];
    value = std::clamp((value - kNone) / (kFull - kNone), 0.0f, 1.0f);
  }
  return share;
}

}  // namespace

std::vector<TissueCell> planeCells(const Probe& p) {
  std::vector<TissueCell> cells;
  cells.reserve(static_cast<std::size_t>(kCellLines) * kCellsAlong);
  const double near = p.face_radius_m + p.min_depth_m, step = p.sampleSpacing() * kSamplesPerCell;
  for (int i = 0; i < kCellLines; ++i) {
    const double angle =
        p.first_angle_rad + (p.last_angle_rad - p.first_angle_rad) * i / (kCellLines - 1);
    const double across = std::sin(angle), down = std::cos(angle);
    for (int k = 0; k < kCellsAlong; ++k) {
      const double r = near + (k + 0.5) * step;
      TissueCell cell;
      cell.x_m = static_cast<float>(r * across);
      cell.z_m = static_cast<float>(r * down);
      cell.area = static_cast<float>(r / (p.face_radius_m + p.max_depth_m));
      cells.push_back(cell);
    }
  }
  return cells;
}

void setTissues(TissueCell& cell, const std::uint32_t* ids,
                const std::vector<std::uint8_t>& tissue_of) {
  if (allEqual(ids)) {
    cell.first = cell.second = tissue_of[ids[0]];
    return;
  }
  std::uint8_t tissues[kSamplesPerCell], counts[kSamplesPerCell];
  int kinds = 0;
  for (int s = 0; s < kSamplesPerCell; ++s) {
    const std::uint8_t tissue = tissue_of[ids[s]];
    int at = 0;
    while (at < kinds && tissues[at] != tissue) ++at;
    if (at == kinds) tissues[kinds] = tissue, counts[kinds++] = 0;
    ++counts[at];
  }
  int first = 0, second = -1;
  for (int i = 1; i < kinds; ++i)
    if (counts[i] > counts[first]) first = i;
  for (int i = 0; i < kinds; ++i)
    if (i != first && (second < 0 || counts[i] > counts[second])) second = i;
  cell.first = cell.second = tissues[first];
  if (second < 0) return;
  cell.second = tissues[second];
  cell.share =
      static_cast<float>(counts[first]) / static_cast<float>(counts[first] + counts[second]);
}

void weighByBlood(const ModelLoop& loop, ModelFrame& frame) {
  cv::Mat blood(loop.cells_across, loop.cells_along, CV_32F);
  for (std::size_t c = 0; c < frame.cells.size(); ++c) {
    const TissueCell& cell = frame.cells[c];
    blood.ptr<float>()[c] =
        (loop.blood[cell.first] ? cell.share : 0) + (loop.blood[cell.second] ? 1 - cell.share : 0);
  }
  blood = nearnessOf(loop, frame, blood);
  for (std::size_t c = 0; c < frame.cells.size(); ++c) frame.cells[c].area *= blood.ptr<float>()[c];
}

void weighByLeftVentricle(const ModelLoop& loop, const std::vector<float>& left,
                          ModelFrame& frame) {
  cv::Mat share(loop.cells_across, loop.cells_along, CV_32F);
  std::copy(left.begin(), left.end(), share.ptr<float>());
  share = nearnessOf(loop, frame, share);
  constexpr auto kFar = static_cast<float>(kOtherChambers);
  for (std::size_t c = 0; c < frame.cells.size(); ++c)
    frame.cells[c].area *= kFar + (1 - kFar) * share.ptr<float>()[c];
}

}  // namespace echocine::fit
