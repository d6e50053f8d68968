#pragma once
// Echoes that a scanner shows beyond the surface of air-filled lung. Almost all sound is reflected
// there, so they are reverberations: sound meets the tissue in front of the surface a second
// time. The tissue appears mirrored and fades, and a face near the surface repeats it (A-lines).
//
//   I'(m) = I(m) + h exp(-m / L) mean of I(s) over |s - d(m)| <= w(m)                         (L1)
//   d(m) = |m - 2 D round(m / (2 D))|,  w(m) = 0.2 m                                          (L2)
//
// Symbols: m distance beyond the surface along the line; s distance in front of it; D distance of
// the surface from the first sample; h level; L length of the fade; w blur by the curved surface
// and by multiple scattering, our choice, cut at the surface and at the first sample. Constant
// tissue I in front gives h I exp(-m / L), without a step for h = 1. A-lines: Lichtenstein and
// Meziere, Chest 134(1), 117-125, 2008.
//
// Limits: the mirror is normal to each line; the reflections at the face and at the surface count
// as complete, and all loss is in the fade. A line has its first surface only. The mirrored
// intensities are those after the time gain, so the fade is relative to tissue at the same depth.

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

class LungEcho {
 public:
  explicit LungEcho(const Scene& scene);

  // Adds (L1) to a line-major plane. media: the id of each sample's medium, as in
  // PolarFrame::medium. Runs in parallel; the result does not depend on the threads.
  // Precondition: both have the same size, whole lines.
  void add(std::span<const std::uint32_t> media, std::span<float> plane) const;

 private:
  void addLine(std::span<const std::uint32_t> media, std::span<float> line,
               std::vector<double>& sums) const;

  std::size_t samples_;
  std::vector<char> air_;      // by MediumId
  std::vector<float> levels_;  // h exp(-m / L) by samples beyond the surface
};

}  // namespace echocine
