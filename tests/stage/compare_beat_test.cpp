// The beat of a loop and the instant of each frame, from planted motion: the beat has its own
// length whatever repeats in it or over two of it, and confidence means something.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compare/time_alignment.h"
#include "core/hash_random.h"
#include "echo/beat_length.h"

namespace echocine::compare {

using namespace echo;
namespace {

// What moves in a picture at a phase of the beat, in three directions, and what is added to it.
struct PlantedBeat {
  double frames_per_beat = 20;
  int frames = 70;
  double second_harmonic = 0.4;  // two bumps a beat, as filling has
  double alternans = 0;          // every other beat differs by this share
  double breathing = 0, breath_beats = 4;
  double noise = 0;
  std::uint64_t seed = 1;
  double begin = 0;  // beats
};

Features featuresOf(const PlantedBeat& b) {
  constexpr std::size_t kBlocks = 400;
  Features out;
  for (int f = 0; f < b.frames; ++f) {
    const double beats = b.begin + f / b.frames_per_beat, turn = 2 * std::numbers::pi * beats;
    std::vector<double> frame(kBlocks);
    for (std::size_t i = 0; i < kBlocks; ++i) {
      const double at = static_cast<double>(i) / kBlocks;
      frame[i] = std::cos(turn + 3 * at) + b.second_harmonic * std::cos(2 * turn + 7 * at) +
                 b.alternans * std::cos(turn / 2 + 5 * at) +
                 b.breathing * std::cos(turn / b.breath_beats + 2 * at) +
                 b.noise * normalFromHashes(hashOf(b.seed, std::uint64_t(f), i, 1),
                                            hashOf(b.seed, std::uint64_t(f), i, 2));
    }
    out.push_back(frame);
  }
  return out;
}

Features noiseLike(Features features, std::uint64_t seed) {
  for (std::size_t f = 0; f < features.size(); ++f)
    for (std::size_t i = 0; i < features[f].size(); ++i)
      features[f][i] = normalFromHashes(hashOf(seed, f, i, 1), hashOf(seed, f, i, 2));
  return features;
}

TEST(BeatLengthFound, IsOneBeatNotHalfAndNotTwo) {
  for (const double length : {14.3, 20.0, 27.6})
    for (const double second : {0.0, 0.4, 0.9})
      for (const double alternans : {0.0, 0.15, 0.3})
        for (const double breathing : {0.0, 0.15}) {
          PlantedBeat b;
          b.frames_per_beat = length;
          b.frames = static_cast<int>(4.4 * length);
          b.second_harmonic = second;
          b.alternans = alternans;
          b.breathing = breathing;
          b.noise = 0.1;
          EXPECT_NEAR(findBeatLength(featuresOf(b), 5).frames, length, 0.02 * length)
              << length << ' ' << second << ' ' << alternans << ' ' << breathing;
        }
}

TEST(BeatLengthFound, IsThatOfEveryBeatCountFromOneAndAThird) {
  for (const double beats : {1.35, 1.6, 2.0, 2.3, 3.0, 5.0}) {
    PlantedBeat b;
    b.frames = static_cast<int>(std::lround(beats * b.frames_per_beat));
    EXPECT_NEAR(findBeatLength(featuresOf(b), 5).frames, b.frames_per_beat, 0.3) << beats;
  }
}

// Frames a breath apart match best, although that is two or three beats. Frames half or a third of
// a beat apart match less than unrelated ones, whatever the second harmonic below the first.
TEST(BeatLengthFound, IsNoBreathOfTwoOrThreeBeats) {
  for (const double length : {14.3, 20.0, 27.6})
    for (const double breath : {2.0, 3.0})
      for (const double second : {0.0, 0.9}) {
        PlantedBeat b;
        b.frames_per_beat = length;
        b.frames = static_cast<int>(3.8 * length);
        b.second_harmonic = second;
        b.breathing = breath == 2 ? 0.6 : 0.7;
        b.breath_beats = breath;
        b.noise = 0.1;
        EXPECT_NEAR(findBeatLength(featuresOf(b), 5).frames, length, 0.03 * length)
            << length << ' ' << breath << ' ' << second;
      }
}

TEST(BeatLengthFound, NoiseHasNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(findBeatLength(noiseLike(featuresOf({}), seed), 5).frames, 0) << seed;
  }
}

double confidenceOf(const PlantedBeat& synthetic, const Features& real) {
  const Features model = featuresOf(synthetic);
  return alignInTime({model, real, synthetic.frames_per_beat, synthetic.frames_per_beat, 1, {}})
      .confidence;
}

// The limit at which the comparison warns is 0.1.
TEST(TimeConfidence, TellsTheSameBeatFromAnother) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PlantedBeat model, same;
    model.frames = 20;
    same.frames = 30;
    same.begin = 0.05 * static_cast<double>(seed);
    same.noise = 0.5;
    same.seed = seed;
    EXPECT_GT(confidenceOf(model, featuresOf(same)), 0.3) << seed;

    // As much motion that has nothing to do with the model's.
    EXPECT_LT(confidenceOf(model, noiseLike(featuresOf(same), seed)), 0.1) << seed;
  }
}

}  // namespace
}  // namespace echocine::compare
