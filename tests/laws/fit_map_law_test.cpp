// Curves of where a model disagrees: by structure, and by segment of a wall.

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "fit/model_discrepancy.h"
#include "support/drawn_heart.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

// The curve of a structure has the mean of its points by their certainty, and says nothing where
// none is seen.
TEST(CompareMap, OffsetsOfAStructureAreAveragedByCertainty) {
  FitMap map;
  map.boundary = {{{0, 0, 2, 0.75F, 1, 3}, {0, 0, -2, 0.25F, -1, 3}}, {{0, 0, 5, 1, 2, 1}}};
  const std::vector<OffsetCurve> curves = offsetCurves(map, 5);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[1].part, 3u);
  EXPECT_NEAR(curves[1].offset_mm[0], 1, 1e-6);
  EXPECT_NEAR(curves[1].distance_mm[0], 2, 1e-6);
  EXPECT_NEAR(curves[1].motion_mm[0], 1, 1e-6);  // of the one that was tracked
  EXPECT_TRUE(std::isnan(curves[1].offset_mm[1]));
  EXPECT_NEAR(curves[0].offset_mm[1], 5, 1e-6);
}

// A loop 3 mm to the right of its model: edges of the right wall lie out of the model's chamber by
// that much times the normal's lateral part, those of the left wall inside it.
TEST(CompareMap, CurvesOfSegmentsTellWhichWallDisagrees) {
  withThreads(2, [] {
    ModelLoop model = Phantom{}.model();
    double lateral[2] = {}, pieces[2] = {};
    for (ModelFrame& frame : model.frames)
      for (BoundaryPoint& p : frame.boundary) {
        if (std::abs(p.nx) < 0.8F) continue;
        p.segment = p.nx > 0 ? 9 : 12;
        lateral[p.segment == 9 ? 0 : 1] += static_cast<double>(p.nx);
        ++pieces[p.segment == 9 ? 0 : 1];
      }
    const ModelDiscrepancy d(draw(Phantom{}, {0.003, 0, 0, 1}, 20, 17), fromTheStart(), model);
    const std::vector<OffsetCurve> curves = segmentCurves(d.map(model, {}));
    ASSERT_EQ(curves.size(), 2u);
    EXPECT_EQ(curves[0].part, 9u);
    EXPECT_EQ(curves[1].part, 12u);
    for (int i = 0; i < 2; ++i)
      for (const double mm : curves[static_cast<std::size_t>(i)].offset_mm)
        EXPECT_NEAR(mm, 3 * lateral[i] / pieces[i], 1) << i;
  });
}

}  // namespace
}  // namespace echocine::fit
