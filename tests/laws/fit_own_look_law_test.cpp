// Edges and grey levels measured in rendered loops of a model are expected in a real loop.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "fit/boundary_sides.h"
#include "fit/expected_edges.h"
#include "fit/expected_greys.h"
#include "fit/tissue_greys.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

// A map in which every piece of the model has an offset, and every cell a residual.
template <typename Offset, typename Left>
FitMap mapOf(const ModelLoop& model, const Offset& offset_mm, const Left& left) {
  FitMap map;
  map.deviation = 20;
  for (const ModelFrame& frame : model.frames) {
    map.boundary.emplace_back();
    map.region.emplace_back();
    for (const BoundaryPoint& p : frame.boundary) {
      BoundaryOffset offset;
      offset.surface = p.surface;
      offset.piece = static_cast<std::uint32_t>(&p - frame.boundary.data());
      offset.offset_mm = static_cast<float>(offset_mm(p));
      offset.certainty = 1;
      offset.of_blood = p.of_blood;
      map.boundary.back().push_back(offset);
    }
    for (std::size_t c = 0; c < frame.cells.size(); ++c) {
      const TissueCell& cell = frame.cells[c];
      if (!(cell.area > 0)) continue;
      RegionLeft r;
      r.cell = static_cast<std::uint32_t>(c);
      r.first = cell.first, r.second = cell.second, r.share = cell.share;
      r.left = static_cast<float>(left(cell));
      map.region.back().push_back(r);
    }
  }
  return map;
}

double none(const TissueCell&) {
  return 0;
}

// Known parts of the grey levels are subtracted from the residual, but remain in the total.
TEST(FitOwnLook, KnownGreysCountAsExplained) {
  TissueGreys whole({false, true}), rest({false, true}), known({false, true});
  for (int i = 0; i < 400; ++i) {
    const int tissue = i % 2;
    const double share = i % 5 == 0 ? 0.3 : 1, depth = (i * 37 % 100) / 100.0,
                 e = 15 * std::sin(0.1 * i),
                 g = (tissue == 1 ? 30 : 90) + 20 * depth + e + 3 * std::cos(1.7 * i);
    whole.add(tissue, 1 - tissue, share, depth, g, 1);
    rest.add(tissue, 1 - tissue, share, depth, g - e, 1);
    known.add(tissue, 1 - tissue, share, depth, g, 1, e);
  }
  const TissueGreys::Fit of_whole = whole.fit(), of_rest = rest.fit(), of_known = known.fit();
  EXPECT_NEAR(of_known.residual, of_rest.residual, 1e-9 * of_rest.residual);
  EXPECT_NEAR(of_known.total, of_whole.total, 1e-9 * of_whole.total);
  EXPECT_LT(of_known.ratio(), 0.8 * of_whole.ratio());
}

// Offsets that vary with the direction are expected there, with the loss of a smoothing over three
// directions of 15 degrees: (1 + cos 15)/2, and as much by the shares of two directions.
TEST(FitOwnLook, OffsetsAreExpectedInTheirDirections) {
  const ModelLoop model = Phantom{}.model();
  const auto offset_mm = [&](const ModelFrame& frame, const BoundaryPoint& p) {
    const BoundaryMiddle middle = middlesOf(frame, 2)[p.surface];
    return 1 + std::cos(std::atan2(p.x_m - middle.x_m, p.z_m - middle.z_m));
  };
  ExpectedEdges edges(model.frames.size(), model.structures.size());
  const ModelFrame& first = model.frames.front();
  ModelLoop still = model;
  for (ModelFrame& frame : still.frames) frame = first;
  edges.add(still, {mapOf(
                       still, [&](const BoundaryPoint& p) { return offset_mm(first, p); }, none)});
  ModelLoop seen = still;
  edges.applyTo(seen);
  for (std::size_t i = 0; i < first.boundary.size(); ++i)
    EXPECT_NEAR(-1e3 * seen.frames[3].boundary[i].inside_m, offset_mm(first, first.boundary[i]),
                0.12);
  // Without more offsets nothing is added, and no distance is beyond 4 mm.
  edges.add(still, {mapOf(
                       still, [](const BoundaryPoint&) { return 0.0; }, none)});
  ModelLoop again = still;
  edges.applyTo(again);
  EXPECT_EQ(again.frames[3].boundary[7].inside_m, seen.frames[3].boundary[7].inside_m);
  for (int round = 0; round < 4; ++round)
    edges.add(still, {mapOf(
                         still, [](const BoundaryPoint&) { return 3.0; }, none)});
  again = still;
  edges.applyTo(again);
  for (const BoundaryPoint& p : again.frames[3].boundary) EXPECT_NEAR(p.inside_m, -4e-3, 1e-9);
  // Nothing is expected without a measurement.
  again = still;
  ExpectedEdges{}.applyTo(again);
  for (const BoundaryPoint& p : again.frames[3].boundary) EXPECT_EQ(p.inside_m, 0);
}

// The share of the expected edges is the slope of the real offsets over them. Their mean over a
// structure does not count, because a fit moves it.
TEST(FitOwnLook, EdgesAreExpectedAsFarAsTheLoopShowsThem) {
  const ModelLoop model = Phantom{}.model();
  const auto wave = [](double factor, double more) {
    return [factor, more](const BoundaryPoint& p) {
      return more + factor * std::sin(std::atan2(p.x_m - Phantom::kX, p.z_m - Phantom::kZ));
    };
  };
  ExpectedEdges edges(model.frames.size(), model.structures.size());
  edges.add(model, {mapOf(model, wave(2, 0), none)});
  for (const double share : {0.0, 0.4, 1.0})
    for (const double more : {-2.0, 0.0, 3.0}) {
      edges.scaleTo(model, mapOf(model, wave(2 * share, more), none));
      EXPECT_NEAR(edges.shown(), share, 0.08) << share << ' ' << more;
    }
  edges.scaleTo(model, mapOf(model, wave(-2, 1), none));
  EXPECT_EQ(edges.shown(), 0);
  ModelLoop seen = model;
  edges.applyTo(seen);
  EXPECT_EQ(seen.frames[5].boundary[9].inside_m, 0);
}

// A residual of each tissue is expected as far as the real loop shows it, and not if it shows the
// contrary. Cells without a residual do not count.
TEST(FitOwnLook, ResidualsAreExpectedByTissueAndAsFarAsTheLoopShowsThem) {
  const ModelLoop model = Phantom{}.model();
  const auto no_offset = [](const BoundaryPoint&) { return 0.0; };
  const auto residual = [](double factor) {
    return [factor](const TissueCell& cell) {
      const auto of = [](int tissue) { return tissue == 1 ? 0.8 : tissue == 2 ? -0.5 : 0.1; };
      return factor * (cell.share * of(cell.first) + (1 - cell.share) * of(cell.second));
    };
  };
  FitMap own = mapOf(model, no_offset, residual(1));
  own.region[2][5].left = std::numeric_limits<float>::quiet_NaN();
  ExpectedGreys greys(model, {own, own, own});
  greys.scaleTo(model, mapOf(model, no_offset, residual(0.6)));
  EXPECT_NEAR(greys.shown(), 0.6, 0.05);
  ModelLoop seen = model;
  greys.applyTo(seen);
  double most = 0;
  for (std::size_t c = 0; c < model.frames[4].cells.size(); ++c) {
    const TissueCell& cell = model.frames[4].cells[c];
    if (!(cell.area > 0)) continue;
    EXPECT_NEAR(seen.frames[4].cells[c].expected, 20 * residual(0.6)(cell), 2.5) << c;
    most = std::max(most, static_cast<double>(seen.frames[4].cells[c].expected));
  }
  EXPECT_GT(most, 8);
  greys.scaleTo(model, mapOf(model, no_offset, residual(-1)));
  EXPECT_EQ(greys.shown(), 0);
  seen = model;
  greys.applyTo(seen);
  for (const TissueCell& cell : seen.frames[4].cells) EXPECT_EQ(cell.expected, 0);
}

// Edges of a model, measured in drawn loops of another phantom or pose.
ExpectedEdges edgesIn(const Phantom& drawn, const FitPose& pose, const ModelLoop& model) {
  std::vector<ModelDiscrepancy> own;
  for (const std::uint64_t seed : {1, 2, 3})
    own.emplace_back(draw(drawn, pose, 20, seed), fromTheStart(), model);
  ExpectedEdges edges(model.frames.size(), model.structures.size());
  ModelLoop seen = model;
  for (int round = 0; round < 3; ++round) {
    std::vector<FitMap> maps;
    for (const ModelDiscrepancy& one : own) maps.push_back(one.map(seen, FitPose{}));
    edges.add(seen, maps);
    seen = model;
    edges.applyTo(seen);
  }
  return edges;
}

// Own loops whose chamber looks 2 mm larger or smaller than the model's boundary says: in another
// loop of the same look, the model with its expected edges has the boundary term of a model of that
// size. Blood that looks like wall is wall in the region term; the contrary is not modelled.
TEST(FitOwnLook, AModelFitsALoopOfItsOwnLook) {
  withThreads(2, [] {
    const ModelLoop model = Phantom{}.model();
    for (const double grow_m : {2e-3, -2e-3}) {
      const Phantom drawn{.grow_m = grow_m};
      ModelLoop seen = model;
      edgesIn(drawn, {}, model).applyTo(seen);
      const ModelDiscrepancy other(draw(drawn, {}, 20, 9), fromTheStart(), model);
      const FitTerms plain = other.at(model, FitPose{}).terms,
                     expected = other.at(seen, FitPose{}).terms,
                     right = other.at(drawn.model(), FitPose{}).terms;
      EXPECT_NEAR(expected.boundary, right.boundary, 0.1 * right.boundary) << grow_m;
      EXPECT_LT(expected.boundary, 0.9 * plain.boundary) << grow_m;
      EXPECT_LE(expected.region, plain.region + 1e-3) << grow_m;
      if (grow_m < 0) {
        EXPECT_LT(expected.region - right.region, 0.5 * (plain.region - right.region));
      }
    }
  });
}

// The share that is shown is near 1 in another loop of the same look, and small in one whose edges
// lie on the boundaries. Here the look is a shift, so offsets differ between directions.
TEST(FitOwnLook, TheShareShownIsOneForTheSameLookOnly) {
  withThreads(2, [] {
    const ModelLoop model = Phantom{}.model();
    const FitPose shifted{2e-3, 0, 0, 1};
    ExpectedEdges edges = edgesIn(Phantom{}, shifted, model);
    const auto shownIn = [&](const FitPose& pose) {
      const ModelDiscrepancy loop(draw(Phantom{}, pose, 20, 9), fromTheStart(), model);
      edges.scaleTo(model, loop.map(model, FitPose{}));
      return edges.shown();
    };
    const double same = shownIn(shifted), none = shownIn({}), contrary = shownIn({-2e-3, 0, 0, 1});
    EXPECT_GT(same, 0.85);
    EXPECT_LT(none, 0.2);
    EXPECT_EQ(contrary, 0);
  });
}

}  // namespace
}  // namespace echocine::fit
