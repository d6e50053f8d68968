#include "motion/interior/top_surfaces_at.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/check.h"

namespace echocine {

namespace {

// Places that are not divided further, and divisions at most, for places that coincide. Our
// choices.
constexpr std::size_t kFew = 16;
constexpr int kMostDivisions = 8;

class Divider {
 public:
  Divider(std::span<const Vec3f> places_m, std::span<std::optional<SurfaceId>> tops)
      : places_m_(places_m), tops_(tops) {}

  // `near`: of a box that holds the places with these numbers, which it reorders.
  void find(const TopSurfaces::Within& near, std::span<std::uint32_t> numbers, int divisions) {
    if (near.isOne() || numbers.size() <= kFew || divisions == 0) {
      for (const std::uint32_t i : numbers) tops_[i] = near.at(toDouble(places_m_[i]));
      return;
    }
    std::array<std::uint32_t, 9> starts = divide(numbers);
    for (std::size_t octant = 0; octant < 8; ++octant) {
      const auto some = numbers.subspan(starts[octant], starts[octant + 1] - starts[octant]);
      if (!some.empty()) find(near.within(boxAbout(some)), some, divisions - 1);
    }
  }

  Box boxAbout(std::span<const std::uint32_t> numbers) const {
    Box box;
    for (const std::uint32_t i : numbers) box.add(toDouble(places_m_[i]));
    return box;
  }

 private:
  // Puts the numbers in the order of the octants of the box about their places. Returns where each
  // octant starts, and the end.
  std::array<std::uint32_t, 9> divide(std::span<std::uint32_t> numbers) {
    const Box box = boxAbout(numbers);
    const Vec3f middle_m = toFloat(0.5 * (box.lo + box.hi));
    const auto octantOf = [&](std::uint32_t i) {
      const Vec3f p = places_m_[i];
      return static_cast<std::size_t>((p.x > middle_m.x) + 2 * (p.y > middle_m.y) +
                                      4 * (p.z > middle_m.z));
    };
    std::array<std::uint32_t, 9> starts{};
    for (const std::uint32_t i : numbers) ++starts[octantOf(i) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::array<std::uint32_t, 9> next = starts;
    ordered_.resize(numbers.size());
    for (const std::uint32_t i : numbers) ordered_[next[octantOf(i)]++] = i;
    std::copy(ordered_.begin(), ordered_.end(), numbers.begin());
    return starts;
  }

  std::span<const Vec3f> places_m_;
  std::span<std::optional<SurfaceId>> tops_;
  std::vector<std::uint32_t> ordered_;
};

}  // namespace

void topSurfacesAt(const TopSurfaces& surfaces, std::span<const Vec3f> places_m,
                   std::span<std::optional<SurfaceId>> tops) {
  CHECK_EQ(places_m.size(), tops.size());
  if (places_m.empty()) return;
  std::vector<std::uint32_t> numbers(places_m.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  Divider divider(places_m, tops);
  divider.find(surfaces.within(divider.boxAbout(numbers)), numbers, kMostDivisions);
}

}  // namespace echocine
