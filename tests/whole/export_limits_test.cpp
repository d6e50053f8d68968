// Memory of an export, and bytes that do not depend on the heap.

#include <gtest/gtest.h>
#include <malloc.h>

#include <fmt/format.h>

#include <cmath>

#include "core/hash_random.h"
#include "export/export_loops.h"
#include "support/echo_video.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "video/animation.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

#ifndef ECHOCINE_SANITIZED  // freed memory stays held
// The peak of a run with eight loops is that of one loop and a few pictures. With a fixed threshold
// for mmap, freed frames go back to the system and are not held by the arenas of busy threads.
TEST(ExportLimits, OneLoopIsInMemoryAtATime) {
  constexpr int kFrames = 60, kSide = 640;  // 25 MB
  TempFolder folder;
  std::vector<PixelPlane> planes;
  for (int i = 0; i < kFrames; ++i)
    planes.push_back(PixelPlane(kSide * kSide, static_cast<std::uint8_t>(2 * i)));
  fs::create_directories(folder / "0");
  writeLossless(folder / "0/cine.avi", planes, kSide, kSide, 40);
  writeManifestOfCine(folder / "0");
  std::string all;
  for (int n = 0; n < 8; ++n) {
    if (n > 0) {
      fs::create_directories(folder / std::to_string(n));
      for (const char* file : {"cine.avi", "manifest.json"})
        fs::copy(folder / "0" / file, folder / std::to_string(n) / file);
    }
    all += " '" + (folder / std::to_string(n)).string() + "'";
  }
  const auto peak = [&](const std::string& loops) {
    const Outcome o = runShell(
        "MALLOC_MMAP_THRESHOLD_=131072 /usr/bin/env python3 -c 'import resource, subprocess, sys; "
        "code = subprocess.call(sys.argv[1:]); "
        "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(code)' "
        "%B export" +
        loops + " --width 640 --speed 10 --quiet -o '" + (folder / "out.gif").string() + "'");
    EXPECT_EQ(o.code, 0) << o.err;
    return 1024 * std::stod(o.out);
  };
  const double one = peak(" '" + (folder / "0").string() + "'"), eight = peak(all);
  RecordProperty("one_loop_MB", fmt::format("{:.0f}", one / 1e6));
  RecordProperty("eight_loops_MB", fmt::format("{:.0f}", eight / 1e6));
  EXPECT_LT(eight - one, 1.2 * kFrames * kSide * kSide);
}
#endif

#if defined(__GLIBC__) && !defined(ECHOCINE_SANITIZED)
// Colours over greys, with edges, motion and noise: blocks of every kind for the encoder.
GreyImage colouredPicture(int width, int height, int frame) {
  GreyImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double wave = std::sin(0.11 * x + 0.5 * frame) * std::cos(0.07 * y - 0.3 * frame);
      const double noise = uniformFromHash(hashOf(x, y, frame / 2)) - 0.5;
      const bool coloured =
          std::hypot(x - 0.5 * width - 3 * frame, y - 0.5 * height) < 0.3 * height;
      const double grey = std::clamp(60 + 50 * wave + 30 * noise, 0.0, 127.0);
      image.pixels.push_back(static_cast<std::uint8_t>(
          std::lround(coloured ? 191 + 63 * std::clamp(wave, -1.0, 1.0) : grey)));
    }
  return image;
}

// Greys below 128, red to yellow and blue to cyan above.
GreyColours twoScales() {
  GreyColours colours{};
  for (int i = 0; i < 256; ++i) {
    const auto level = static_cast<std::uint8_t>(i < 128 ? 2 * i : 2 * std::abs(i - 191));
    PaletteColour& c = colours[static_cast<std::size_t>(i)];
    if (i < 128)
      c = {level, level, level};
    else if (i < 192)
      c = {0, level, 255};
    else
      c = {255, level, 0};
  }
  return colours;
}

std::vector<std::byte> colouredLoop(AnimationFormat format) {
  constexpr int kWidth = 240, kHeight = 160, kFrames = 48;
  AnimationEncoder encoder({format, kWidth, kHeight, 25, twoScales()});
  for (int f = 0; f < kFrames; ++f) encoder.add(colouredPicture(kWidth, kHeight, f));
  return encoder.finish();
}

// The allocator fills fresh memory with a byte of our choice.
TEST(ExportLimits, EqualLoopsHaveEqualBytesWhateverTheHeapHolds) {
  for (const AnimationFormat format :
       {AnimationFormat::mp4, AnimationFormat::gif, AnimationFormat::webp}) {
    const std::vector<std::byte> first = colouredLoop(format);
    int different = 0;
    for (const int perturb : {0x55, 0xff, 0x01, 0x80, 0xa7, 0x3c, 0xfe, 0x7f}) {
      ASSERT_EQ(::mallopt(M_PERTURB, perturb), 1);
      different += colouredLoop(format) == first ? 0 : 1;
    }
    ::mallopt(M_PERTURB, 0);
    EXPECT_EQ(different, 0) << static_cast<int>(format);
  }
}
#endif

}  // namespace
}  // namespace echocine
