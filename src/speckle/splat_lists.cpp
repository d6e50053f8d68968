#include "speckle/splat_lists.h"

#include <algorithm>

#include "core/normal_lanes.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// To the nearest whole number, of magnitudes below 2^22.
inline Floats8 nearest(Floats8 a) {
  constexpr float kMagic = 12582912.0f;  // 1.5 2^23
  return (a + kMagic) - kMagic;
}

// exp(-u) for 0 <= u <= 2.3, to 2e-5: the eighth power of a short series.
inline Floats8 fallingExp(Floats8 u) {
  const Floats8 v = u * -0.125f;
  Floats8 e = 1 + v * (1 + v * (0.5f + v * (1.0f / 6 + v * (1.0f / 24))));
  e *= e;
  e *= e;
  return e * e;
}

// Places in steps between samples or lines.
inline Ints8 stepsOf(const float* places) {
  return __builtin_convertvector(kSplineSteps * lanesAt(places), Ints8);
}

// By lane: its four numbers side by side.
struct LaneSplats {
  Splat lane[kFloatLanes];
  LaneSplats(Floats8 real, Floats8 imaginary, Floats8 squares, Ints8 places) {
    const Floats8 at = reinterpret_cast<Floats8>(places);
    const Floats8 a = __builtin_shufflevector(real, imaginary, 0, 8, 1, 9, 4, 12, 5, 13),
                  b = __builtin_shufflevector(real, imaginary, 2, 10, 3, 11, 6, 14, 7, 15),
                  c = __builtin_shufflevector(squares, at, 0, 8, 1, 9, 4, 12, 5, 13),
                  d = __builtin_shufflevector(squares, at, 2, 10, 3, 11, 6, 14, 7, 15);
    // Lanes 0 and 4, 1 and 5, 2 and 6, 3 and 7.
    const Floats8 pairs[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                              __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                              __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                              __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
    for (int i = 0; i < 4; ++i) {
      const Floats4 low = __builtin_shufflevector(pairs[i], pairs[i], 0, 1, 2, 3),
                    high = __builtin_shufflevector(pairs[i], pairs[i], 4, 5, 6, 7);
      std::memcpy(&lane[i], &low, sizeof low);
      std::memcpy(&lane[i + 4], &high, sizeof high);
    }
  }
};

}  // namespace

void SplatLists::start(int lines, LineRange kept) {
  lists_.resize(static_cast<std::size_t>(lines));
  for (List& list : lists_) list.next = list.memory.data();
  first_ = static_cast<float>(kept.first);
  end_ = static_cast<float>(kept.end);
  turn_ = 0;
  before_ = 0;
  waiting_.count = 0;
}

void SplatLists::startTurn(int lines, int beside) {
  start(lines, {0, lines});
  turn_ = static_cast<float>(lines);
  before_ = static_cast<std::size_t>((lines - beside % lines) % lines);
}

void SplatLists::sortWhole() {
  Waiting& w = waiting_;
  const std::size_t whole = w.count / kFloatLanes * kFloatLanes;
  for (std::size_t k = 0; k < whole; k += kFloatLanes) sort(k, kFloatLanes);
  for (float* list : {w.q, w.turns, w.real, w.imaginary, w.line, w.sample})
    std::copy(list + whole, list + w.count, list);
  w.count -= whole;
}

void SplatLists::settle() {
  for (std::size_t k = 0; k < waiting_.count; k += kFloatLanes)
    sort(k, std::min(kFloatLanes, waiting_.count - k));
  waiting_.count = 0;
}

// Elevation: with s the place across in parts of the cut the bell is exp(-4 ln2 cut^2 s^2).
// Memory is asked for some splats ahead. Our choice, by time.
inline void SplatLists::sort(std::size_t first, std::size_t count) {
  constexpr float kBell = static_cast<float>(2.7725887222397811 * kElevationCut * kElevationCut);
  constexpr std::ptrdiff_t kAhead = 12;
  const Waiting& w = waiting_;
  const Floats8 e = fallingExp(kBell * lanesAt(w.q + first));
  const Floats8 turns = lanesAt(w.turns + first);
  const auto [cosine, sine] = phasor(turns - nearest(turns));
  const Floats8 cr = lanesAt(w.real + first), ci = lanesAt(w.imaginary + first);
  const Ints8 line = stepsOf(w.line + first), sample = stepsOf(w.sample + first);
  const LaneSplats splats(e * (cr * cosine + ci * sine), e * (ci * cosine - cr * sine), e * e,
                          (line & (kSplineSteps - 1)) << Splat::kLineBits | sample);
  std::uint32_t lines[kFloatLanes];
  std::memcpy(lines, &line, sizeof lines);
  for (std::size_t i = 0; i < count; ++i) {
    List& list = lists_[lines[i] / kSplineSteps];
    if (list.next == list.end) grow(list);
    *list.next++ = splats.lane[i];
    __builtin_prefetch(list.next + kAhead, 1);
  }
}

void SplatLists::grow(List& list) {
  const std::size_t count = list.memory.size();
  list.memory.resize(std::max<std::size_t>(2 * count, 64));
  list.next = list.memory.data() + count;
  list.end = list.memory.data() + list.memory.size();
}

}  // namespace echocine
