#include "fit/own_look.h"

#include "core/check.h"
#include "core/parallel.h"

namespace echocine::fit {

namespace {

// The mean of Eq. 4's p(s) shows a part of a displacement: its edge has neighbours. Our choice.
constexpr int kEdgeRounds = 3;

// One own loop, and the look that the others show.
struct LeftOut {
  const ModelDiscrepancy* loop;
  ExpectedLook look;
};

std::vector<LeftOut> leaveOneOut(const OwnDiscrepancies& own, const ModelLoop& plain) {
  std::vector<LeftOut> out;
  for (std::size_t i = 0; i < own.size(); ++i) {
    OwnDiscrepancies others = own;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    out.push_back({own[i], lookIn(others, plain, *own[i], FitPose{})});
  }
  return out;
}

double meanDiscrepancy(const std::vector<LeftOut>& loops, const ModelLoop& plain) {
  double sum = 0;
  for (const LeftOut& one : loops) {
    ModelLoop model = plain;
    one.look.applyTo(model);
    sum += one.loop->refine(model, {FitPose{}}).discrepancy;
  }
  return sum / static_cast<double>(loops.size());
}

}  // namespace

ExpectedLook lookIn(const OwnDiscrepancies& own, const ModelLoop& plain,
                    const ModelDiscrepancy& loop, const FitPose& pose) {
  ModelLoop model = plain;
  const auto mapsOf = [&] {
    std::vector<FitMap> maps;
    for (const ModelDiscrepancy* one : own) maps.push_back(one->map(model, FitPose{}));
    return maps;
  };
  ExpectedLook look{{model.frames.size(), model.structures.size()}, {}, {}};
  for (int round = 0; round < kEdgeRounds; ++round) {
    look.edges.add(model, mapsOf());
    model = plain;
    look.edges.applyTo(model);
  }
  // Edges that are expected elsewhere move the pose.
  const FitPose seen = loop.refine(model, {pose}).pose;
  look.edges.scaleTo(plain, loop.map(plain, seen), seen.scale);
  model = plain;
  look.edges.applyTo(model);
  look.greys = ExpectedGreys(model, mapsOf());
  look.greys.scaleTo(model, loop.map(model, seen));
  return look;
}

ExpectedSlope slopeIn(const OwnDiscrepancies& own, const std::vector<std::array<double, 3>>& places,
                      const PlainModel& modelAt) {
  CHECK_LE(2u, own.size());
  std::vector<double> middle, slopes(places.size());
  for (const auto& place : places) middle.push_back(place[1]);
  const std::vector<LeftOut> loops = leaveOneOut(own, modelAt(middle));
  parallelBlocks(places.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<double> at = middle;
      const auto discrepancyAt = [&](double value) {
        at[i] = value;
        return meanDiscrepancy(loops, modelAt(at));
      };
      const double low = places[i][0], high = places[i][2];
      if (high > low) slopes[i] = (discrepancyAt(high) - discrepancyAt(low)) / (high - low);
    }
  });
  return {middle, std::move(slopes)};
}

}  // namespace echocine::fit
