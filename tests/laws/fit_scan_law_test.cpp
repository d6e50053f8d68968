// What a scan of dials asks for, as it is written.

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "fit/dial_scan.h"

namespace echocine::fit {

using namespace echo;
namespace {

TEST(CompareScan, ScansAreReadOrRefusedByName) {
  const std::vector<ScanAxis> axes = parseScan("ef=0.3:0.75:0.05,edv=120:230:20");
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_EQ(axes[0].values().size(), 10u);
  EXPECT_EQ(axes[1].values().size(), 6u);
  EXPECT_NEAR(axes[0].values().back(), 0.75, 1e-12);
  for (const char* bad :
       {"", "ef", "ef=0.3", "ef=0.3:0.5", "ef=0.3:0.2:0.05", "ef=0.3:0.5:0", "ef=0.3:0.5:-1",
        "eff=0.3:0.5:0.1", "ef=0.3:0.95:0.1", "ef=a:0.5:0.1", "ef=0.3:0.5:0.1,ef=0.3:0.5:0.1",
        "ef=0.3:0.5:nan", "ef=0.3:0.5:0.1,edv=100:120:10,hr=60:70:5,twist=5:10:5"}) {
    try {
      parseScan(bad);
      ADD_FAILURE() << bad;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("--scan"), std::string::npos) << error.what();
    }
  }
  // A step as large as the range, also below 0.
  EXPECT_EQ(parseScan("bow-lateral=-0.06:-0.02:0.04")[0].values().size(), 2u);
  EXPECT_THROW(parseScan("bow-lateral=-0.06:-0.02:0.041"), SceneError);
  EXPECT_EQ(parseDials("hr=72,wall-thickness=11").at("hr"), 72);
  EXPECT_THROW(parseDials("hr"), SceneError);
  EXPECT_THROW(parseDials("hr=900"), SceneError);
  EXPECT_THROW(parseDials("ef=0.5,ef=0.6"), SceneError);
  EXPECT_THROW(parseDials("lv-length=90,sphericity=0.6"), SceneError);
}

}  // namespace
}  // namespace echocine::fit
