#pragma once
// Splats sorted by line, each with its place between lines and samples: what the point spread
// function then smears.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "core/lanes.h"
#include "speckle/spline_taps.h"

namespace echocine {

// For one scatterer: the real and imaginary part of c e exp(-2j k0 r), e^2, and its place.
struct Splat {
  float real, imaginary, square;
  std::int32_t at;  // 6 bits of the place between samples, 16 of the sample, 6 between lines

  int sample() const { return at / kSplineSteps & 0xffff; }
  int sampleAt() const { return at & 0x3fffff; }  // in steps
  int lineStep() const { return at >> kLineBits; }
  static constexpr int kLineBits = 22;
};

// By a mask's bits: the numbers of its lanes, then whatever.
struct LaneOrders {
  std::array<std::array<std::uint16_t, kFloatLanes>, 256> of{};
  constexpr LaneOrders() {
    for (std::size_t bits = 0; bits < of.size(); ++bits) {
      std::size_t count = 0;
      for (std::uint16_t lane = 0; lane < kFloatLanes; ++lane)
        if (bits >> lane & 1) of[bits][count++] = lane;
    }
  }
};
inline constexpr LaneOrders kLaneOrders;

// Eight scatterers in beam space, seen or not.
struct BeamPlaces {
  Floats8 line, sample;     // by the number of the one whose share begins there
  Floats8 q;                // square of the place across, in parts of the elevation's cut
  Floats8 turns;            // of the phase
  Floats8 real, imaginary;  // c
};

// A frame's splats by line, each line's in the order in which they came. They are written and read
// one after the other, so that a frame's sums need never be in memory all at once.
class SplatLists {
 public:
  // No splats yet; from now on those of some of the lines are kept.
  void start(int lines, LineRange kept);
  // The same for a full turn, in which line n is line n + lines. Its lists are then read as an
  // unrolled turn's: list i is that of line i - beside.
  void startTurn(int lines, int beside);

  // Adds the lanes in the mask that lie in kept lines. Without a branch on visibility, which no
  // processor predicts.
  void add(const BeamPlaces& places, Ints8 seen) {
    Floats8 line = places.line;
    if (turn_ > 0) {
      line = line < 0 ? line + turn_ : line;
      line = line >= turn_ ? line - turn_ : line;
    }
    const unsigned bits = bitsOf(seen & (line >= first_) & (line < end_));
    Shorts8 lanes;
    std::memcpy(&lanes, kLaneOrders.of[bits].data(), sizeof lanes);
    const Ints8 order = __builtin_convertvector(lanes, Ints8);
    Waiting& w = waiting_;
    const std::size_t n = w.count;
    store(reordered(places.q, order), w.q + n);
    store(reordered(places.turns, order), w.turns + n);
    store(reordered(places.real, order), w.real + n);
    store(reordered(places.imaginary, order), w.imaginary + n);
    store(reordered(line, order), w.line + n);
    store(reordered(places.sample, order), w.sample + n);
    w.count = n + static_cast<std::size_t>(__builtin_popcount(bits));
    if (w.count > kMostWaiting - kFloatLanes) sortWhole();
  }
  // After the last add(): what waits becomes splats.
  void settle();

  std::span<const Splat> line(int i) const {
    const std::size_t at = static_cast<std::size_t>(i) + before_;
    const List& list = lists_[at < lists_.size() ? at : at % lists_.size()];
    return {list.memory.data(), list.next};
  }

 private:
  struct List {
    Splat *next = nullptr, *end = nullptr;
    std::vector<Splat> memory;
  };
  // Those that are seen wait side by side: of eight places half are, and most of the work comes
  // after that is known.
  static constexpr std::size_t kMostWaiting = 512;
  struct Waiting {
    std::size_t count = 0;
    alignas(32) float q[kMostWaiting], turns[kMostWaiting], real[kMostWaiting],
        imaginary[kMostWaiting], line[kMostWaiting], sample[kMostWaiting];
  };
  void sortWhole();
  void sort(std::size_t first, std::size_t count);
  static void grow(List& list);

  std::vector<List> lists_;
  float first_ = 0, end_ = 0;
  float turn_ = 0;          // lines of a full turn; 0: a sector
  std::size_t before_ = 0;  // the line of list 0
  Waiting waiting_;
};

}  // namespace echocine
