#pragma once
// A full turn of lines as a sector: the lines before the seam are repeated behind it, and those
// behind it before it. Code for sectors then needs no rule for the seam.

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "scene/probe.h"

namespace echocine {

class UnrolledTurn {
 public:
  // Repeats half a turn on each side. None for a probe of another kind.
  static std::optional<UnrolledTurn> of(const Probe& probe);

  // Line i of the turn is its line i + beside().
  const Probe& probe() const { return probe_; }
  int beside() const { return beside_; }
  // The line of the turn that a line of the sector repeats.
  int lineOf(int unrolled) const { return (unrolled - beside_ + lines_) % lines_; }
  LineRange unrolled(LineRange lines) const { return {lines.first + beside_, lines.end + beside_}; }

  // Line-major planes of probe().samples samples per line.
  void unroll(std::span<const float> turn, std::vector<float>& sector) const {
    const auto samples = static_cast<std::ptrdiff_t>(probe_.samples);
    sector.resize(static_cast<std::size_t>(probe_.lines * samples));
    for (int i = 0; i < probe_.lines; ++i)
      std::copy_n(turn.begin() + lineOf(i) * samples, samples, sector.begin() + i * samples);
  }
  // Takes some lines of the turn back.
  void take(const std::vector<float>& sector, LineRange lines, float* turn) const {
    const auto samples = static_cast<std::ptrdiff_t>(probe_.samples);
    std::copy_n(sector.begin() + (lines.first + beside_) * samples, lines.count() * samples,
                turn + lines.first * samples);
  }

 private:
  explicit UnrolledTurn(const Probe& probe);

  int lines_, beside_;
  Probe probe_;
};

}  // namespace echocine
