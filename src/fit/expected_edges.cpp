#include "fit/expected_edges.h"

#include <algorithm>

#include "core/check.h"
#include "fit/boundary_sides.h"

namespace echocine::fit {

namespace {

// w_0 of Eq. 20: offsets of fewer certain pieces than this are hardly believed. Our choice.
constexpr double kFewPieces = 1;
// Largest distance: half of the reach of Eq. 4. Our choice.
constexpr double kMost_m = 4e-3;

}  // namespace

ExpectedEdges::ExpectedEdges(std::size_t frames, std::size_t structures)
    : frames_(frames),
      structures_(structures),
      shown_(1),
      outside_m_(frames * structures * kSides) {}

void ExpectedEdges::add(const ModelLoop& model, const std::vector<FitMap>& maps) {
  CHECK_EQ(model.frames.size(), frames_);
  CHECK_EQ(model.structures.size(), structures_);
  std::vector<double> sum(outside_m_.size()), weight(outside_m_.size());
  for (std::size_t n = 0; n < frames_; ++n) {
    const std::vector<BoundaryMiddle> middles = middlesOf(model.frames[n], structures_);
    for (const FitMap& map : maps) {
      if (map.boundary.empty()) continue;  // nothing is seen
      for (const BoundaryOffset& offset : map.boundary[n]) {
        if (!offset.of_blood) continue;
        const SideShares sides =
            sidesOf(model.frames[n].boundary[offset.piece], middles[offset.surface]);
        const std::size_t row = (n * structures_ + offset.surface) * kSides;
        const auto addTo = [&](std::size_t side, double share) {
          const double w = share * static_cast<double>(offset.certainty);
          sum[row + side] += w * 1e-3 * static_cast<double>(offset.offset_mm);
          weight[row + side] += w;
        };
        addTo(sides.first, 1 - sides.share);
        addTo(sides.second, sides.share);
      }
    }
  }
  // Smooth over successive frames and adjacent directions.
  const auto smooth = [&](const std::vector<double>& of, std::size_t n, std::size_t s,
                          std::size_t side) {
    double out = 0;
    for (const std::size_t dn : {frames_ - 1, std::size_t{0}, std::size_t{1}})
      for (const std::size_t d : {std::size_t{kSides - 1}, std::size_t{0}, std::size_t{1}})
        out += (dn == 0 ? 2 : 1) * (d == 0 ? 2 : 1) / 4.0 *
               of[((n + dn) % frames_ * structures_ + s) * kSides + (side + d) % kSides];
    return out;
  };
  for (std::size_t n = 0; n < frames_; ++n)
    for (std::size_t s = 0; s < structures_; ++s)
      for (std::size_t side = 0; side < kSides; ++side) {
        double& at = outside_m_[(n * structures_ + s) * kSides + side];
        at += smooth(sum, n, s, side) / (smooth(weight, n, s, side) + kFewPieces);
        at = std::clamp(at, -kMost_m, kMost_m);
      }
  if (first_m_.empty()) first_m_ = outside_m_;
}

double ExpectedEdges::at(const Distances& distances, const BoundaryPoint& piece,
                         const BoundaryMiddle& middle, std::size_t frame) const {
  const SideShares sides = sidesOf(piece, middle);
  const double* const row = &distances[(frame * structures_ + piece.surface) * kSides];
  return (1 - sides.share) * row[sides.first] + sides.share * row[sides.second];
}

void ExpectedEdges::scaleTo(const ModelLoop& model, const FitMap& real, double scale) {
  struct Sums {
    double w = 0, e = 0, r = 0, ee = 0, er = 0;
  };
  if (outside_m_.empty()) return;
  CHECK_EQ(model.frames.size(), frames_);
  std::vector<Sums> sums(structures_);
  for (std::size_t n = 0; n < real.boundary.size(); ++n) {
    const std::vector<BoundaryMiddle> middles = middlesOf(model.frames[n], structures_);
    for (const BoundaryOffset& offset : real.boundary[n]) {
      if (!offset.of_blood) continue;
      const BoundaryPoint& piece = model.frames[n].boundary[offset.piece];
      const double w = offset.certainty, r = 1e-3 * static_cast<double>(offset.offset_mm) / scale,
                   e = at(first_m_, piece, middles[piece.surface], n);
      Sums& s = sums[piece.surface];
      s.w += w, s.e += w * e, s.r += w * r, s.ee += w * e * e, s.er += w * e * r;
    }
  }
  double both = 0, square = 0;
  for (const Sums& s : sums)
    if (s.w > 0) {
      both += s.er - s.e * s.r / s.w;
      square += s.ee - s.e * s.e / s.w;
    }
  shown_ = square > 0 ? std::clamp(both / square, 0.0, 1.0) : 0;
}

void ExpectedEdges::applyTo(ModelLoop& model) const {
  if (outside_m_.empty() || !(shown_ > 0)) return;
  CHECK_EQ(model.frames.size(), frames_);
  for (std::size_t n = 0; n < frames_; ++n) {
    const std::vector<BoundaryMiddle> middles = middlesOf(model.frames[n], structures_);
    for (BoundaryPoint& p : model.frames[n].boundary)
      if (p.of_blood)
        p.inside_m -= static_cast<float>(shown_ * at(outside_m_, p, middles[p.surface], n));
  }
}

}  // namespace echocine::fit
