#include "core/normal_field.h"

#include <cmath>

#include "core/hash_random.h"

namespace echocine {

NormalField::NormalField(double scale_m, std::uint64_t seed)
    : scale_m_(scale_m), seed_(seed), nodes_(16 * 16 * 16) {}

NormalField::Key NormalField::keyOf(const std::array<std::int64_t, 3>& node) {
  constexpr std::int64_t kHalf = 1 << 20;
  Key key = 0;
  for (const std::int64_t axis : node) {
    if (axis < -kHalf || axis >= kHalf) return kNone;
    key = key << 21 | static_cast<Key>(axis + kHalf);
  }
  return key;
}

double NormalField::drawn(const std::array<std::int64_t, 3>& node) const {
  std::uint64_t hash = seed_;
  for (const std::int64_t axis : node) hash = hashOf(hash, axis);
  return normalFromHashes(hashOf(hash, 0), hashOf(hash, 1));
}

double NormalField::normalOf(const std::array<std::int64_t, 3>& node) {
  const Key key = keyOf(node);
  if (key == kNone) return drawn(node);
  Node& kept =
      nodes_[static_cast<std::size_t>((node[0] & 15) | (node[1] & 15) << 4 | (node[2] & 15) << 8)];
  if (kept.key != key) kept = {key, drawn(node)};
  return kept.normal;
}

const NormalField::Cell& NormalField::cellOf(const std::array<std::int64_t, 3>& node) {
  const Key key = keyOf(node);
  Cell& cell =
      cells_[static_cast<std::size_t>((node[0] & 3) | (node[1] & 3) << 2 | (node[2] & 3) << 4)];
  if (key != kNone && cell.key == key) return cell;
  cell.key = key;
  for (int corner = 0; corner < 8; ++corner)
    cell.normals[static_cast<std::size_t>(corner)] = normalOf(
        {node[0] + (corner & 1), node[1] + (corner >> 1 & 1), node[2] + (corner >> 2 & 1)});
  return cell;
}

double NormalField::at(Vec3f place_m) {
  const double at[3] = {static_cast<double>(place_m.x) / scale_m_,
                        static_cast<double>(place_m.y) / scale_m_,
                        static_cast<double>(place_m.z) / scale_m_};
  std::array<std::int64_t, 3> node;
  double high[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(at[axis]), f = at[axis] - floor;
    node[axis] = static_cast<std::int64_t>(floor);
    high[axis] = f * f * (3 - 2 * f);
  }
  const Cell& cell = cellOf(node);
  double sum = 0, squares = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      weight *= corner >> axis & 1 ? high[axis] : 1 - high[axis];
    sum += weight * cell.normals[corner];
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

}  // namespace echocine
