#include "scene/unrolled_turn.h"

#include "scene/scan_geometry.h"

namespace echocine {

UnrolledTurn::UnrolledTurn(const Probe& probe, int beside)
    : lines_(probe.lines), beside_(std::min(beside, probe.lines)), probe_(probe) {
  const ScanGeometry turn(probe);
  probe_.kind = ProbeKind::curvilinear;
  probe_.lines = lines_ + 2 * beside_;
  probe_.first_angle_rad = turn.firstPlace() - beside_ * turn.cellWidth();
  probe_.last_angle_rad = turn.lastPlace() + beside_ * turn.cellWidth();
}

}  // namespace echocine
