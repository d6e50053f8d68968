#pragma once
// The least values of a smooth function of a pose: Newton's method from several starts.

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace echocine::fit {

// Two shifts, a turn, a scale, each in units that change the function about alike at the size of
// what is looked for: a unit of shift is 2 mm in 15 cm, of turn 2 degrees, of scale 3 %.
inline constexpr std::size_t kUnknowns = 4;
using Unknowns = std::array<double, kUnknowns>;

struct Descent {
  Unknowns at{};
  double value = 2;
};

// Where the unknowns may lie; those whose ends are equal stay.
struct SearchBox {
  Unknowns low{}, high{};

  Unknowns clamped(const Unknowns& at) const;
  bool atLimit(const Unknowns& at) const;
};

// Values at several places: what they share is made once. Thread-safe.
using PoseFunction = std::function<std::vector<double>(std::span<const Unknowns>)>;
PoseFunction oneByOne(std::function<double(const Unknowns&)> f);

// Five units of shift or of turn apart: other hills. Our choice.
bool standApart(const Unknowns& a, const Unknowns& b);

// The function at every place of a lattice of so many steps each way. Runs in parallel.
std::vector<Descent> lattice(const PoseFunction& f, const SearchBox& box,
                             const std::array<int, kUnknowns>& each_way);

// The least `most` of them that stand apart, least first.
std::vector<Descent> leastApart(std::vector<Descent> all, std::size_t most);

// Newton's method with central differences, curvatures made positive, steps halved until they gain.
// Starts are followed in parallel.
Descent descend(const PoseFunction& f, const Unknowns& start, const SearchBox& box);
std::vector<Descent> descendAll(const PoseFunction& f, const std::vector<Descent>& starts,
                                const SearchBox& box);

// (8)  confidence = (min(rival, nothing) - best) / nothing,   between 0 and 1,
// of every search in this room: by which part of the way from `nothing`, the value of what says
// nothing, to 0, the value of what is perfect, the best beats its best rival. 0: as good elsewhere,
// or nothing was found; 1: perfect, and nothing else says anything. Measured by the whole way: the
// best of a search through noise beats others by luck, but by little of it.
double confidenceOf(double best, double rival, double baseline);

}  // namespace echocine::fit
