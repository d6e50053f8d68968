#include "motion/subdivision/stencil_rows.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"

namespace echocine {

namespace {

std::vector<std::size_t> firstEntries(std::span<const int> sizes) {
  std::vector<std::size_t> first(sizes.size() + 1, 0);
  for (std::size_t v = 0; v < sizes.size(); ++v)
    first[v + 1] = first[v] + static_cast<std::size_t>(sizes[v]);
  return first;
}

}  // namespace

const PaddedPoint* padded(std::span<const Vec3f> points) {
  thread_local std::vector<PaddedPoint> lanes;
  lanes.resize(points.size());
  PaddedPoint* lane = lanes.data();
  for (const Vec3f& p : points) *lane++ = PaddedPoint{p.x, p.y, p.z, 0};
  return lanes.data();
}

StencilRows::StencilRows(std::span<const int> sizes, std::span<const int> sources) {
  const std::vector<std::size_t> first = firstEntries(sizes);
  CHECK_LE(first.back(), sources.size());
  rows_.resize(sizes.size());
  std::iota(rows_.begin(), rows_.end(), 0u);
  std::stable_sort(rows_.begin(), rows_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sizes[a] < sizes[b]; });
  sources_.reserve(first.back());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::uint32_t v = rows_[r];
    const auto length = static_cast<std::uint32_t>(sizes[v]);
    if (groups_.empty() || groups_.back().length != length) groups_.push_back({length, r, r});
    groups_.back().last_row = r + 1;
    for (std::size_t i = first[v]; i < first[v + 1]; ++i)
      sources_.push_back(static_cast<std::uint32_t>(sources[i]));
  }
}

std::vector<float> StencilRows::arranged(std::span<const int> sizes,
                                         std::span<const float> values) const {
  const std::vector<std::size_t> first = firstEntries(sizes);
  CHECK_LE(first.back(), values.size());  // the library's tables may hold more than they use
  std::vector<float> in_order;
  in_order.reserve(first.back());
  for (const std::uint32_t v : rows_)
    in_order.insert(in_order.end(), values.begin() + static_cast<std::ptrdiff_t>(first[v]),
                    values.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
  return in_order;
}

}  // namespace echocine
