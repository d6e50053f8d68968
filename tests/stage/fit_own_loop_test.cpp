// Own loops that share motion have the bytes of loops that do not.

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/own_loop.h"
#include "scene/looks.h"
#include "scene/names.h"
#include "support/all_cases.h"

namespace echocine::fit {
namespace {

using support::allCases;

constexpr int kFrames = 4;

void expectSame(const echo::EchoLoop& a, const echo::EchoLoop& b) {
  EXPECT_EQ(a.video.frames, b.video.frames);
  EXPECT_EQ(a.metres_per_pixel, b.metres_per_pixel);
}

OwnHeart ownHeart(double tilt_rad = 0) {
  return {{{"ef", 0.5}, {"edv", 110}, {"hr", 72}}, heart::View::a4c, {tilt_rad, 0}, kFrames};
}

TEST(FitOwnLoop, SeedsShareMotionInAnyOrder) {
  withThreads(2, [] {
    RenderedBeats shared = ownHeart().beats();
    for (const int seed : {7, 8, 7}) {
      SCOPED_TRACE(seed);
      expectSame(shared.loop(seed), ownHeart().beats().loop(seed));
    }
    EXPECT_NE(shared.loop(8).video.frames, shared.loop(7).video.frames);
  });
}

// Another look has scatterers, anatomy of the effects and processing of its own; in a tilted plane,
// and with a persistence that is not the look's.
TEST(FitOwnLoop, LooksShareMotion) {
  withThreads(2, [] {
    const OwnHeart heart = ownHeart(0.1);
    RenderedBeats first = heart.beats(Look::scanner);
    const echo::EchoLoop scanner = first.loop(7);
    for (const Look look : scannerLooks()) {
      if (look == Look::scanner || (look != Look::sharp && look != Look::faint && !allCases()))
        continue;
      SCOPED_TRACE(nameOf(look));
      RenderedBeats shared = heart.beats(look, 0.5, &first);
      const echo::EchoLoop loop = shared.loop(7);
      expectSame(loop, heart.beats(look, 0.5).loop(7));
      EXPECT_NE(loop.video.frames, scanner.video.frames);
      EXPECT_NE(loop.video.frames, heart.beats(look, 0.0, &first).loop(7).video.frames);
    }
  });
}

TEST(FitOwnLoop, ImpossibleDialsAreRefused) {
  EXPECT_THROW(OwnHeart({{"ef", 0.9}, {"edv", 20}}, heart::View::a4c, {}, kFrames), SceneError);
}

}  // namespace
}  // namespace echocine::fit
