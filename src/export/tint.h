#pragma once
// Colours of grey levels, as scanners offer them.

#include "scene/named.h"
#include "video/animation.h"

namespace echocine {

enum class Tint { none, sepia, blue };

template <>
struct NamesOf<Tint> {
  static constexpr Named<Tint> kAll[] = {
      {Tint::none, "none"}, {Tint::sepia, "sepia"}, {Tint::blue, "blue"}};
};

// Grey level g has the channels 255 (g / 255)^e, with an exponent e per channel: black and white
// stay as they are, and every channel increases with g. The exponents are our choice.
GreyColours coloursOf(Tint tint);

}  // namespace echocine
