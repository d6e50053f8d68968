#pragma once
// A grid of hearts held against a loop, and where between them the discrepancy is least.

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
  // Of the paraboloid through the points within two steps of the best; empty where there are too
  // few of them, or it has no least value.
  std::vector<double> minimum;
  std::vector<double> curvature;                 // D per square of a step, by axis
  std::vector<std::vector<double>> confounding;  // -1..1 between axes: at 1 or -1 a change of one
                                                 // is made good by the other
};

inline constexpr std::size_t kMostAxes = 3;
// Nodes of each dial that a family needs: two dials take 16 hearts, three 27. Our choice: with four
// the surfaces lie within 0.1 mm over half of a dial's range.
int nodesFor(std::size_t axes);

// In the middle of each axis.
std::vector<double> middleOf(const std::vector<ScanAxis>& axes);

// Every heart of the grid, each with the pose of least D near the given ones. Runs in parallel.
// Throws JobError when the monitor wants to stop. Precondition: the family's dials are the axes'.
DialGrid holdGrid(const std::vector<ScanAxis>& axes, const HeartFamily& family,
                  const ModelDiscrepancy& discrepancy, const std::vector<FitPose>& starts,
                  const PlaneTilt& tilt = {}, const Monitor& monitor = {});

}  // namespace echocine::fit
