#include "geometry/positions_box.h"

#include <cstring>

#include "core/lanes.h"

namespace echocine {

// Four positions at a time, which are three vectors of four.
Box boxOf(const std::vector<Vec3f>& positions_m) {
  Box box;
  const std::size_t count = positions_m.size(), in_fours = count / 4 * 4;
  for (std::size_t i = in_fours; i < count; ++i) box.add(toDouble(positions_m[i]));
  if (in_fours == 0) return box;
  Floats4 lo[3], hi[3];
  std::memcpy(lo, positions_m.data(), sizeof lo);
  std::memcpy(hi, positions_m.data(), sizeof hi);
  for (std::size_t i = 4; i < in_fours; i += 4) {
    Floats4 four[3];
    std::memcpy(four, &positions_m[i], sizeof four);
    for (int k = 0; k < 3; ++k) {
      lo[k] = four[k] < lo[k] ? four[k] : lo[k];
      hi[k] = four[k] > hi[k] ? four[k] : hi[k];
    }
  }
  Vec3f corners[8];
  std::memcpy(corners, lo, sizeof lo);
  std::memcpy(corners + 4, hi, sizeof hi);
  for (const Vec3f corner : corners) box.add(toDouble(corner));
  return box;
}

}  // namespace echocine
