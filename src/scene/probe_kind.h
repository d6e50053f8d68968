#pragma once
// The kinds of probes: one row each.

#include "scene/named.h"

namespace echocine {

enum class ProbeKind { phased, curvilinear, linear };

// How a kind lays its lines: as a fan from the apex, or side by side. Nobody else asks what kind a
// probe is; a kind that does neither needs new code in scan_geometry.cpp.
struct LineLayout {
  bool fan;          // lines meet in the apex; key sector_deg, else width_mm
  bool curved_face;  // the apex lies behind the face; key face_radius_mm
};

template <>
struct NamesOf<ProbeKind> {
  struct Row : Named<ProbeKind> {
    LineLayout layout;
  };
  static constexpr Row kAll[] = {{{ProbeKind::phased, "phased"}, {true, false}},
                                 {{ProbeKind::curvilinear, "curvilinear"}, {true, true}},
                                 {{ProbeKind::linear, "linear"}, {false, false}}};
};

constexpr LineLayout layoutOf(ProbeKind kind) {
  for (const auto& row : NamesOf<ProbeKind>::kAll)
    if (row.value == kind) return row.layout;
  return {};
}

}  // namespace echocine
