// Hearts that are kept on disk: read back to the bit, damaged ones computed anew, a bounded folder.

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/heart_cache.h"
#include "fit/heart_family.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine::fit {
namespace {

using namespace support;
namespace fs = std::filesystem;

using Dials = std::map<std::string, double>;
constexpr int kBeatFrames = 4;

const heart::Recording& computedOnce() {
  static const heart::Recording beat =
      heart::recordBeat(heart::ParametricHeart(heart::parametersFrom({})), heart::View::a4c,
                        kBeatFrames, heart::KeyframeSpacing::even);
  return beat;
}

void expectSame(const heart::Recording& a, const heart::Recording& b) {
  EXPECT_EQ(a.phases, b.phases);
  EXPECT_EQ(a.end_systole_phase, b.end_systole_phase);
  EXPECT_EQ(a.end_systole, b.end_systole);
  EXPECT_EQ(a.body_scale, b.body_scale);
  EXPECT_EQ(a.sac_reach_m, b.sac_reach_m);
  EXPECT_EQ(a.pose.apex, b.pose.apex);
  EXPECT_EQ(a.pose.depth_m, b.pose.depth_m);
  ASSERT_EQ(a.places.size(), b.places.size());
  for (std::size_t k = 0; k < a.places.size(); ++k) {
    EXPECT_EQ(a.places[k].mitral, b.places[k].mitral);
    EXPECT_EQ(a.places[k].wall_thickness_m, b.places[k].wall_thickness_m);
  }
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t p = 0; p < a.parts.size(); ++p) {
    EXPECT_EQ(a.parts[p].kind.name, b.parts[p].kind.name);
    EXPECT_EQ(a.parts[p].kind.medium, b.parts[p].kind.medium);
    EXPECT_EQ(a.parts[p].kind.membrane, b.parts[p].kind.membrane);
    EXPECT_EQ(a.parts[p].faces, b.parts[p].faces);
    EXPECT_EQ(a.parts[p].tags, b.parts[p].tags);
    EXPECT_EQ(a.parts[p].control_m, b.parts[p].control_m);
    EXPECT_EQ(a.parts[p].volume_m3, b.parts[p].volume_m3);
  }
}

TEST(HeartCache, AHeartIsReadAsItWasComputed) {
  TempFolder folder;
  HeartCache cache(folder / "hearts");
  const Dials dials{{"ef", 0.6}};
  EXPECT_FALSE(cache.find(dials, kBeatFrames));
  cache.keep(dials, kBeatFrames, computedOnce());
  const auto kept = cache.find(dials, kBeatFrames);
  ASSERT_TRUE(kept);
  expectSame(*kept, computedOnce());
  // Another dial, another value and another number of frames are other hearts.
  EXPECT_FALSE(cache.find({{"ef", std::nextafter(0.6, 1)}}, kBeatFrames));
  EXPECT_FALSE(cache.find({{"ef", 0.6}, {"edv", 120}}, kBeatFrames));
  EXPECT_FALSE(cache.find(dials, kBeatFrames + 1));
  EXPECT_FALSE(HeartCache().find(dials, kBeatFrames));
}

TEST(HeartCache, ADamagedFileIsNoHeart) {
  TempFolder folder;
  HeartCache cache(folder / "hearts");
  const Dials dials{{"ef", 0.6}};
  cache.keep(dials, kBeatFrames, computedOnce());
  const fs::path file = cache.fileOf(dials, kBeatFrames);
  const std::string whole = bytesOf(file);
  const auto damaged = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return !cache.find(dials, kBeatFrames);
  };
  for (const std::size_t at : {std::size_t{0}, whole.size() / 3, whole.size() - 1}) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    EXPECT_TRUE(damaged(bytes)) << at;
  }
  EXPECT_TRUE(damaged(whole.substr(0, whole.size() / 2)));
  EXPECT_TRUE(damaged(""));
  EXPECT_FALSE(damaged(whole));
  // It is replaced.
  EXPECT_TRUE(damaged("x"));
  cache.keep(dials, kBeatFrames, computedOnce());
  EXPECT_EQ(bytesOf(file), whole);
}

// The folder keeps those that were used last, and nothing of others is touched.
TEST(HeartCache, TheFolderIsBounded) {
  TempFolder folder;
  const fs::path hearts = folder / "hearts";
  const auto dialsOf = [](int i) { return Dials{{"edv", 100.0 + i}}; };
  HeartCache all(hearts);
  for (int i = 0; i < 4; ++i) {
    all.keep(dialsOf(i), kBeatFrames, computedOnce());
    const fs::path file = all.fileOf(dialsOf(i), kBeatFrames);
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(10 - i));
  }
  std::ofstream(hearts / "notes.txt") << "mine";
  std::ofstream(hearts / "heart_0.bin.0a1b2c3d.part") << "killed";
  fs::last_write_time(hearts / "heart_0.bin.0a1b2c3d.part",
                      fs::file_time_type::clock::now() - std::chrono::hours(5));
  EXPECT_TRUE(all.find(dialsOf(0), kBeatFrames));  // used now
  const std::uintmax_t one = fs::file_size(all.fileOf(dialsOf(0), kBeatFrames));
  HeartCache(hearts, 2 * one).prune();
  EXPECT_TRUE(all.find(dialsOf(0), kBeatFrames));
  EXPECT_FALSE(all.find(dialsOf(1), kBeatFrames));
  EXPECT_FALSE(all.find(dialsOf(2), kBeatFrames));
  EXPECT_TRUE(all.find(dialsOf(3), kBeatFrames));
  EXPECT_TRUE(fs::exists(hearts / "notes.txt"));
  EXPECT_FALSE(fs::exists(hearts / "heart_0.bin.0a1b2c3d.part"));
}

// Two writers and a reader of one heart: every reading is whole or none.
TEST(HeartCache, WritersShareAFolder) {
  TempFolder folder;
  const Dials dials{{"ef", 0.6}};
  std::atomic<bool> going{true};
  const auto write = [&] {
    HeartCache cache(folder / "hearts");
    for (int i = 0; i < 5; ++i) {
      cache.keep(dials, kBeatFrames, computedOnce());
      cache.prune();
    }
  };
  computedOnce();
  std::thread first(write), second(write);
  std::thread reader([&] {
    const HeartCache cache(folder / "hearts");
    while (going) {
      const bool there = fs::exists(cache.fileOf(dials, kBeatFrames));
      EXPECT_EQ(there && !cache.find(dials, kBeatFrames), false);
    }
  });
  first.join();
  second.join();
  going = false;
  reader.join();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "hearts"), fs::directory_iterator{}), 1);
}

TEST(HeartCache, AFolderThatCannotBeWrittenIsOneWarning) {
  TempFolder folder;
  std::ofstream(folder / "file") << "no folder";
  std::vector<std::string> warnings;
  HeartCache cache(folder / "file/hearts", kMostCacheBytes,
                   [&](const std::string& text) { warnings.push_back(text); });
  for (int i = 0; i < 2; ++i) cache.keep({{"ef", 0.6}}, kBeatFrames, computedOnce());
  cache.prune();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("hearts are not kept: "), 0u) << warnings[0];
  EXPECT_EQ(warnings[0].find('\n'), std::string::npos);
}

// A family of kept hearts is that of computed ones.
TEST(HeartCache, AFamilyOfKeptHeartsIsTheSame) {
  TempFolder folder;
  withThreads(2, [&] {
    const auto made = [&] {
      const HeartNodes hearts({{"hr", 72}}, HeartDesign::polynomial({{"ef", 0.45, 0.55}}),
                              kBeatFrames, {}, HeartCache(folder / "hearts"));
      return HeartFamily(hearts, heart::View::a4c).surfacesAt({0.52});
    };
    const std::vector<SurfaceFrame> computed = made(), kept = made();
    ASSERT_EQ(computed.size(), kept.size());
    for (std::size_t f = 0; f < kept.size(); ++f)
      EXPECT_TRUE(computed[f].positions_m == kept[f].positions_m) << f;
  });
}

}  // namespace
}  // namespace echocine::fit
