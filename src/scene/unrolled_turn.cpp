#include "scene/unrolled_turn.h"

#include "scene/scan_geometry.h"

namespace echocine {

std::optional<UnrolledTurn> UnrolledTurn::of(const Probe& probe) {
  return probe.isFullTurn() ? std::optional(UnrolledTurn(probe)) : std::nullopt;
}

UnrolledTurn::UnrolledTurn(const Probe& probe)
    : lines_(probe.lines), beside_((probe.lines + 1) / 2), probe_(probe) {
  const ScanGeometry turn(probe);
  probe_.kind = ProbeKind::curvilinear;
  probe_.lines = lines_ + 2 * beside_;
  probe_.first_angle_rad = turn.firstPlace() - beside_ * turn.cellWidth();
  probe_.last_angle_rad = turn.lastPlace() + beside_ * turn.cellWidth();
}

}  // namespace echocine
