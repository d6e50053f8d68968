#include "dataset/clean_labels.h"

#include <cstddef>

namespace echocine::dataset {

namespace {

constexpr std::uint8_t kCavity = 1;

class Pieces {
 public:
  Pieces(int width, int height)
      : width_(static_cast<std::size_t>(width)),
        height_(static_cast<std::size_t>(height)),
        seen_(width_ * height_, 0) {}

  bool seen(std::size_t pixel) const { return seen_[pixel] != 0; }

  // Pixels joined to `start` over edges for which `belongs` holds.
  template <typename Belongs>
  std::vector<std::size_t> from(std::size_t start, const Belongs& belongs) {
    std::vector<std::size_t> piece{start};
    seen_[start] = 1;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::size_t x = piece[i] % width_, y = piece[i] / width_;
      const auto visit = [&](bool inside, std::size_t next) {
        if (!inside || seen_[next] != 0 || !belongs(next)) return;
        seen_[next] = 1;
        piece.push_back(next);
      };
      visit(x > 0, piece[i] - 1);
      visit(x + 1 < width_, piece[i] + 1);
      visit(y > 0, piece[i] - width_);
      visit(y + 1 < height_, piece[i] + width_);
    }
    return piece;
  }

 private:
  std::size_t width_, height_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace

std::vector<std::uint8_t> wholeCavity(const std::vector<std::uint8_t>& labels, int width,
                                      int height) {
  std::vector<std::uint8_t> clean = labels;
  const auto is_cavity = [&](std::size_t pixel) { return labels[pixel] == kCavity; };
  Pieces cavities(width, height);
  std::vector<std::size_t> largest;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!is_cavity(i) || cavities.seen(i)) continue;
    std::vector<std::size_t> piece = cavities.from(i, is_cavity);
    if (piece.size() > largest.size()) largest.swap(piece);
    for (const std::size_t pixel : piece) clean[pixel] = 0;
  }
  if (largest.empty()) return clean;
  // The margin of the picture is never cavity, so all that is outside hangs together.
  Pieces others(width, height);
  const auto is_other = [&](std::size_t pixel) { return clean[pixel] != kCavity; };
  others.from(0, is_other);
  for (std::size_t i = 0; i < clean.size(); ++i)
    if (is_other(i) && !others.seen(i)) clean[i] = kCavity;
  return clean;
}

}  // namespace echocine::dataset
