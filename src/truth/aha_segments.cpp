#include "truth/aha_segments.h"

#include <cmath>
#include <utility>

#include "core/units.h"

namespace echocine {

int ahaSegment(const HeartAxes& axes, Vec3d place_m) {
  const Vec3d d = place_m - axes.base_m;
  const double zeta = axes.zeta(place_m);
  if (zeta > 0.9) return 17;
  const double degrees = degreesFromRadians(std::atan2(dot(d, axes.anterior), dot(d, axes.septal)));
  if (zeta > 2.0 / 3) {  // 13 anterior, 14 septal, 15 inferior, 16 lateral
    if (degrees > 45 && degrees <= 135) return 13;
    if (degrees > -45 && degrees <= 45) return 14;
    return degrees > -135 && degrees <= -45 ? 15 : 16;
  }
  // Anterior, anteroseptal, inferoseptal, inferior, inferolateral, anterolateral.
  const int ring = zeta > 1.0 / 3 ? 6 : 0;
  if (degrees > 60 && degrees <= 120) return ring + 1;
  if (degrees > 0 && degrees <= 60) return ring + 2;
  if (degrees > -60 && degrees <= 0) return ring + 3;
  if (degrees > -120 && degrees <= -60) return ring + 4;
  return ring + (degrees <= -120 ? 5 : 6);
}

bool areAdjacent(std::size_t a, std::size_t b) {
  if (a == b) return false;
  if (a > b) std::swap(a, b);
  const auto inRing = [&](std::size_t first, std::size_t last) {
    return a >= first && b <= last && (b - a == 1 || (a == first && b == last));
  };
  if (inRing(1, 6) || inRing(7, 12) || inRing(13, 16)) return true;
  if (b == kAhaSegments) return a >= 13;
  if (b <= 12) return a <= 6 && b == a + 6;
  constexpr std::size_t kApical[] = {13, 14, 14, 15, 16, 16};  // of the mid segments
  return a >= 7 && a <= 12 && kApical[a - 7] == b;
}

}  // namespace echocine
