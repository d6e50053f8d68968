#include "export/tint.h"

#include <cmath>

namespace echocine {

namespace {

struct Exponents {
  double red = 1, green = 1, blue = 1;
};

Exponents exponentsOf(Tint tint) {
  switch (tint) {
    case Tint::sepia:
      return {0.8, 1, 1.3};
    case Tint::blue:
      return {1.3, 1, 0.8};
    case Tint::none:
      break;
  }
  return {};
}

}  // namespace

GreyColours coloursOf(Tint tint) {
  const Exponents e = exponentsOf(tint);
  GreyColours colours;
  for (std::size_t g = 0; g < colours.size(); ++g) {
    const auto channel = [&](double exponent) {
      return static_cast<std::uint8_t>(
          std::lround(255 * std::pow(static_cast<double>(g) / 255, exponent)));
    };
    colours[g] = {channel(e.red), channel(e.green), channel(e.blue)};
  }
  return colours;
}

}  // namespace echocine
