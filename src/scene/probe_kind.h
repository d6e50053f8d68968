#pragma once
// The kinds of probes, one row each.

#include "scene/named.h"

namespace echocine {

enum class ProbeKind { phased, curvilinear, linear, radial };

// Arrangement of a kind's lines: a fan from the apex, or parallel. No other code asks for the kind
// of a probe. A kind of another arrangement needs new code in scan_geometry.cpp.
struct LineLayout {
  bool fan;                // lines meet in the apex; key sector_deg, otherwise width_mm
  bool curved_face;        // the apex lies behind the face; key face_radius_mm
  bool full_turn = false;  // a fan of 360 degrees: the last line is a neighbour of the first
};

template <>
struct NamesOf<ProbeKind> {
  struct Row : Named<ProbeKind> {
    LineLayout layout;
  };
  static constexpr Row kAll[] = {{{ProbeKind::phased, "phased"}, {true, false}},
                                 {{ProbeKind::curvilinear, "curvilinear"}, {true, true}},
                                 {{ProbeKind::linear, "linear"}, {false, false}},
                                 {{ProbeKind::radial, "radial"}, {true, true, true}}};
};

constexpr LineLayout layoutOf(ProbeKind kind) {
  for (const auto& row : NamesOf<ProbeKind>::kAll)
    if (row.value == kind) return row.layout;
  return {};
}

}  // namespace echocine
