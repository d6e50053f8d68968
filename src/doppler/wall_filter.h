#pragma once
// Wall filter of a packet of pulses: removes slow echoes.
//
// Polynomial regression (Bjaerum, Torp and Kristoffersen, IEEE Trans. Ultrason. Ferroelectr. Freq.
// Control 49, 204-216, 2002): each sample's packet loses its least-squares polynomial in time,
//   z' = z - Q Q^T z                                                                           (D4)
// with the columns of Q orthonormal polynomials up to the order. An echo that stands still
// vanishes; at order 1 or 2 so does one whose complex amplitude is linear or quadratic in time.

#include <vector>

#include "scene/named.h"

namespace echocine {

enum class WallFilterKind { none, mean, line, parabola };

template <>
struct NamesOf<WallFilterKind> {
  static constexpr Named<WallFilterKind> kAll[] = {{WallFilterKind::none, "none"},
                                                   {WallFilterKind::mean, "mean"},
                                                   {WallFilterKind::line, "line"},
                                                   {WallFilterKind::parabola, "parabola"}};
};

// Pulses that remain after the filter must number two at least: those that it needs.
constexpr int leastPulses(WallFilterKind kind) {
  return 2 + static_cast<int>(kind);
}

class WallFilter {
 public:
  // Precondition: pulses >= leastPulses(kind).
  WallFilter(WallFilterKind kind, int pulses);

  bool passesAll() const { return polynomials_.empty(); }
  // In place: one value per pulse of the real or the imaginary part.
  void apply(std::vector<double>& packet) const;

 private:
  std::vector<std::vector<double>> polynomials_;  // orthonormal over the pulses
};

}  // namespace echocine
