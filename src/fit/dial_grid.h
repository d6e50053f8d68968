#pragma once
// A grid of hearts compared with a loop, and the minimum of the discrepancy between its points.

#include <vector>

#include "fit/heart_family.h"

namespace echocine::fit {

// low, low + step, ... up to high.
struct ScanAxis {
  DialRange range;
  double step = 0;
  std::vector<double> values() const;
};

struct ScanPoint {
  std::vector<double> values;  // by axis
  PoseFound found;
};

struct DialGrid {
  std::vector<ScanPoint> points;  // the last axis fastest
  std::size_t best = 0;
  // Minimum of the paraboloid through the points within two steps of the best. Axes of two values
  // stay at the best point; there is no curvature and no confounding then. Empty if there are too
  // few points or the paraboloid has no minimum.
  std::vector<double> minimum;
  std::vector<double> curvature;                 // D per square of a step, by axis
  std::vector<std::vector<double>> confounding;  // -1..1 between axes; at 1 or -1 a change of one
                                                 // is compensated by the other
};

inline constexpr std::size_t kMostAxes = 3;
// Nodes that a family needs for each dial: two dials take 16 hearts, three 27. Our choice: with
// four nodes the surfaces are within 0.1 mm over half of a dial's range.
int nodesFor(std::size_t axes);

// The centre of each axis.
std::vector<double> middleOf(const std::vector<ScanAxis>& axes);

// Every heart of the grid, each with the pose of lowest D near the given poses. Runs in parallel.
// Throws JobError when the monitor requests a stop. Precondition: the family's dials are the axes'.
DialGrid holdGrid(const std::vector<ScanAxis>& axes, const HeartFamily& family,
                  const ModelDiscrepancy& discrepancy, const std::vector<FitPose>& starts,
                  const PlaneTilt& tilt = {}, const Monitor& monitor = {});

}  // namespace echocine::fit
