#pragma once
// Minima of a smooth function of a pose: Newton's method from several starts.

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace echocine::fit {

// Two shifts, a rotation, a scale. The units have similar effect on the function: one unit is a
// shift of 2 mm in 15 cm, a rotation of 2 degrees, or a scale of 3 %.
inline constexpr std::size_t kUnknowns = 4;
using Unknowns = std::array<double, kUnknowns>;

struct Descent {
  Unknowns at{};
  double value = 2;
};

// Bounds of the unknowns. An unknown with equal bounds is fixed.
struct SearchBox {
  Unknowns low{}, high{};

  Unknowns clamped(const Unknowns& at) const;
  bool atLimit(const Unknowns& at) const;
};

// Values at several places. Shared work is done once. Thread-safe.
using PoseFunction = std::function<std::vector<double>(std::span<const Unknowns>)>;
PoseFunction oneByOne(std::function<double(const Unknowns&)> f);

// At least five units of shift or of rotation apart, so in different basins. Our choice.
bool standApart(const Unknowns& a, const Unknowns& b);

// The function at every point of a lattice, with `each_way` steps in each direction. Runs in
// parallel.
std::vector<Descent> lattice(const PoseFunction& f, const SearchBox& box,
                             const std::array<int, kUnknowns>& each_way);

// The lowest `most` of them that stand apart, in ascending order.
std::vector<Descent> leastApart(std::vector<Descent> all, std::size_t most);

// Newton's method with central differences and absolute curvatures. Steps are halved until the
// value falls. Starts are refined in parallel.
Descent descend(const PoseFunction& f, const Unknowns& start, const SearchBox& box);
std::vector<Descent> descendAll(const PoseFunction& f, const std::vector<Descent>& starts,
                                const SearchBox& box);

// (8)  confidence = (min(rival, baseline) - best) / baseline,   between 0 and 1,
// for every search in this room. `baseline` is the value of an uninformative model; a perfect one
// has 0. The confidence is 0 if another place fits as well or nothing was found, and 1 if the best
// is perfect and no other place fits at all. It is relative to the whole range because the best
// result of a search through noise exceeds its rivals by chance, but only by a small part of that
// range.
double confidenceOf(double best, double rival, double baseline);

}  // namespace echocine::fit
