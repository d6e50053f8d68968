// Summary of a study's measurements: medians, and the knob with the most accuracy for its time.

#include <algorithm>

#include "study/study.h"

namespace echocine {

Quartiles StudyPoint::wall_ms() const {
  std::vector<double> values;
  for (const StageTimes& t : times) values.push_back(t.wall_ms);
  return quartilesOf(values);
}

double StudyPoint::stage_ms(Stage stage) const {
  std::vector<double> values;
  for (const StageTimes& t : times) values.push_back(t.stage_ms[static_cast<std::size_t>(stage)]);
  return quartilesOf(values).median;
}

double KnobStep::perMillisecond() const {
  constexpr double kLeast_ms = 0.01;
  return error_drop_db / std::max(added_ms, kLeast_ms);
}

// From draft, where a step shows most; per knob the step with the best return.
std::vector<KnobStep> bestBuys(const StudyResult& result) {
  std::vector<KnobStep> best;
  for (const Knob& knob : result.table.knobs) {
    const StudyRow* base = nullptr;
    std::vector<const StudyRow*> others;
    for (const StudyRow& row : result.rows) {
      if (row.sweep != "from draft" || row.knob != knob.name) continue;
      if (row.value == knob.values[knob.of_preset[0]].label)
        base = &row;
      else
        others.push_back(&row);
    }
    if (base == nullptr) continue;
    KnobStep step{knob.name, base->value, base->value, 0, 0};
    for (const StudyRow* row : others) {
      const StudyPoint &to = result.points[row->point], &from = result.points[base->point];
      const KnobStep s{knob.name, base->value, row->value,
                       to.wall_ms().median - from.wall_ms().median,
                       from.errors.rms_db - to.errors.rms_db};
      if (s.worth() && s.perMillisecond() > step.perMillisecond()) step = s;
    }
    if (step.worth()) best.push_back(step);
  }
  std::sort(best.begin(), best.end(), [](const KnobStep& a, const KnobStep& b) {
    return a.perMillisecond() > b.perMillisecond();
  });
  return best;
}

}  // namespace echocine
