#include <fmt/format.h>

#include "frame/plan_loop.h"
#include "plan/loop_plan.h"

namespace echocine {

std::string planSummary(const LoopPlan& plan) {
  std::string on, off;
  for (const EffectDecision& d : plan.effects.decisions) {
    if (d.effect == Effect::channel) continue;
    std::string& list = d.on ? on : off;
    list += (list.empty() ? "" : ", ") + d.name();
  }
  return fmt::format("{} tracer, {} of {} triangles met; on: {}; off: {}", plan.tracerName(),
                     plan.triangles_met, plan.triangles_given, on, off);
}

}  // namespace echocine
