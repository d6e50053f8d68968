// Memory does not grow with the loop.

#include <gtest/gtest.h>

#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

long peakOf(const TempFolder& folder, int frames, const Lines& signal, bool truth) {
  SceneText text = ballScene(100);
  if (truth) {
    text.extra = "[truth]\nwrite = [\"labels\", \"contours\"]\n";
    text.output["channels"] = "[\"Y\", \"displacement.axial\", \"velocity.axial\"]";
  }
  text.signal = signal;
  text.probe["lines"] = "16";
  text.probe["samples"] = "64";
  text.acquisition["beats"] = std::to_string(frames / 100);
  folder.write("scene.toml", text.text());
  return peakMemory(folder / "scene.toml", folder / ("out_" + std::to_string(frames)));
}

void expectBounded(const Lines& signal, double limit, bool truth = false) {
#ifdef ECHOCINE_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed memory back";
#endif
  const TempFolder folder;
  writeBallMeshes(folder);
  const auto hundred = static_cast<double>(peakOf(folder, 100, signal, truth));
  const auto thousand = static_cast<double>(peakOf(folder, 1000, signal, truth));
  std::printf("peak memory of 100 frames %.1f MB, of 1000 frames %.1f MB\n", hundred / 1e6,
              thousand / 1e6);
  ASSERT_GT(hundred, 0);
  EXPECT_LT(thousand, limit * hundred);
}

// Nothing may be kept per frame: loops are long.
TEST(PeakMemory, OfAThousandFramesIsThatOfAHundred) {
  expectBounded({{"reference_intensity", "1e-7"}}, 1.1);
}

// Nor planes of their truth: what stays are its files' digests and what the page draws, some kB.
TEST(PeakMemory, OfAThousandFramesWithTruthIsNearlyThatOfAHundred) {
  expectBounded({{"reference_intensity", "1e-7"}}, 1.25, true);
}

// A measured reference keeps traced frames, up to a fixed amount of memory: here all of them, 8 kB
// each.
TEST(PeakMemory, GrowsByNoMoreThanTheFramesKeptWhenTheReferenceIsMeasured) {
  expectBounded({}, 1.2);
}

}  // namespace
}  // namespace echocine
