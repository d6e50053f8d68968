// CAMUS's ejection fraction where a plane misses the long axis.

#include <gtest/gtest.h>

#include "dataset/layout.h"
#include "dataset/make_heart.h"
#include "dataset/record.h"
#include "support/run_files.h"
#include "support/temp_folder.h"

namespace echocine::dataset {
namespace {

TEST(DatasetCamus, APlaneWithoutALongAxisHasTheExactEjectionFraction) {
  const Spec spec = parseSpec(
      "hearts = 1\nviews = [\"a2c\", \"a4c\"]\nlayouts = [\"camus\"]\nkeyframes = 8\n"
      "picture_px = 56\n[scene.probe]\nlines = 16\nsamples = 32\n[scene.acquisition]\n"
      "frame_rate_hz = 10\n[scene.signal]\nlook = \"paper\"\n",
      "spec.toml");
  const Heart whole = makeHeart(spec, 0, {});
  const support::TempFolder folder;
  const auto written = [&](const Heart& heart) {
    Json record = recordOf(spec, heart);
    Sink sink(folder.path());
    kCamus.write(spec, heart, sink, record);
    return record["loops"];
  };
  const auto ejected = [&] {
    const std::string text =
        support::bytesOf(folder / "camus/database_nifti/patient0001/Info_4CH.cfg");
    return std::stod(text.substr(text.find("EF: ") + 4));
  };
  const Json loops = written(whole);
  EXPECT_NEAR(loops[1]["camus"]["ef_views_percent"].get<double>(), ejected(), 0.5);
  for (const bool end_systole : {false, true}) {
    Heart missed = whole;
    LoopSample& loop = missed.loops[0];
    const int at = end_systole ? loop.instants.es : loop.instants.ed;
    loop.frames[static_cast<std::size_t>(at)].disc_widths_m.clear();
    for (const Json& entry : written(missed)) {
      for (const char* name : {"edv_views_ml", "esv_views_ml", "ef_views_percent"})
        EXPECT_TRUE(entry["camus"][name].is_null()) << name;
      EXPECT_NEAR(ejected(), entry["ef_percent"].get<double>(), 0.5);
    }
  }
}

}  // namespace
}  // namespace echocine::dataset
