#include "fit/caveats.h"

#include <fmt/format.h>

namespace echocine::fit {

std::vector<std::string> caveatsOf(const echo::EchoLoop& real, const BeatFound& beat,
                                   double confidence) {
  std::vector<std::string> out;
  if (confidence < kLeastConfidence)
    out.push_back(fmt::format("only a hint: its confidence of {:.2f} is below {:g}", confidence,
                              kLeastConfidence));
  if (!real.metres_per_pixel)
    out.emplace_back(
        "scale unknown: the sector is assumed to have the model's depth, so sizes and mL are not "
        "measured");
  if (beat.length_source == kLoopIsBeat) out.push_back(beat.length_source);
  return out;
}

}  // namespace echocine::fit
