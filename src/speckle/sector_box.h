#pragma once
// Region of space to search for blocks of scatterers.

#include "scene/probe.h"

namespace echocine {

// In the imaging plane, probe frame, m.
struct SectorBox {
  struct Range {
    double low_m, high_m;
  };
  Range x, z;
};

// All places of discs of radius disc_m, whose tissue moves by up to moves_m in the plane, that
// BeamView::sees() accepts at some instant.
SectorBox sectorBox(const Probe& probe, double disc_m, double moves_m, double edge_m);

}  // namespace echocine
