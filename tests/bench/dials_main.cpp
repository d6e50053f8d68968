// dial_table [cost|smooth|pairs|looks|rates]: what one evaluation of a heart's dials costs, stage
// by stage; how smooth the discrepancy is along two dials; and how far its least value lies from
// the dials of three hearts under another look, and of one under several.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "bench/cpu_time.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/dial_scan.h"
#include "metrics/statistics.h"
#include "support/view_loops.h"

namespace echocine::bench {
namespace {

using namespace echo;
using namespace fit;
using namespace support;

// A heart under a scanner's look. Wall and rate are told to the models.
struct Pair {
  double ef, edv_ml, wall_mm, rate_bpm;
  int seed;
};
constexpr std::array kPairs{Pair{0.45, 150, 11, 72, 3}, Pair{0.60, 130, 9, 65, 17},
                            Pair{0.36, 190, 10, 80, 29}};

std::map<std::string, double> givenOf(const Pair& p) {
  return {{"hr", p.rate_bpm}, {"wall-thickness", p.wall_mm}};
}

using Change = std::function<void(Scene&)>;
void unchanged(Scene&) {}

EchoLoop loopOf(const Pair& p, Look look, const Change& change) {
  std::map<std::string, double> dials = givenOf(p);
  dials["ef"] = p.ef;
  dials["edv"] = p.edv_ml;
  Scene scene = heart::heartScene(heart::parametersFrom(dials), View::a4c, 24, look);
  change(scene);
  return scannedLoop(scene, 24, p.seed);
}

HeartFamily familyOf(const Pair& p) {
  return {givenOf(p),
          {{"ef", p.ef - 0.1, p.ef + 0.1}, {"edv", p.edv_ml - 30, p.edv_ml + 30}},
          View::a4c,
          kFitFrames,
          4};
}

SideOptions fromFirstFrame() {
  SideOptions side;
  side.ed_frame = 0;
  return side;
}

// A pair with its pose as the heart of its own dials finds it.
struct Fitted {
  HeartFamily family;
  EchoLoop loop;
  ModelLoop right;
  ModelDiscrepancy d;
  FitPose pose;

  explicit Fitted(const Pair& p, Look look = Look::scanner, const Change& change = unchanged)
      : Fitted(p, familyOf(p), loopOf(p, look, change)) {}
  // warped: the models' systole may have another share of the beat than the loop's.
  Fitted(const Pair& p, HeartFamily models, EchoLoop shown, bool warped = true)
      : family(std::move(models)),
        loop(std::move(shown)),
        right(rightOf(p, warped)),
        d(loop, fromFirstFrame(), right),
        pose(d.search(right).pose) {}

 private:
  ModelLoop rightOf(const Pair& p, bool warped) const {
    ModelLoop model = family.at({p.ef, p.edv_ml});
    if (!warped) model.systole = 0;
    return model;
  }
};

template <typename Body>
void timed(const char* what, int rounds, const Body& body) {
  std::vector<double> ms;
  for (int i = 0; i < rounds; ++i) ms.push_back(millisecondsOf([&] { body(i); }));
  fmt::print("  {:<44} {:7.1f} ms\n", what, quartilesOf(ms).median);
}

// Of one core, medians.
void tellCost() {
  const Pair& p = kPairs[0];
  const Fitted fitted(p);
  const auto dialsOf = [&](int i) {
    return std::vector<double>{p.ef - 0.05 + 0.004 * i, p.edv_ml + 10 - i};
  };
  std::vector<ModelLoop> models;
  for (int i = 0; i < 25; ++i) models.push_back(fitted.family.at(dialsOf(i)));
  const auto modelOf = [&](int i) -> const ModelLoop& {
    return models[static_cast<std::size_t>(i)];
  };
  fmt::print("one evaluation of {} frames\n", kFitFrames);
  timed("surfaces between recorded hearts", 25,
        [&](int i) { fitted.family.surfacesAt(dialsOf(i)); });
  timed("surfaces, labels, boundaries, motion", 25, [&](int i) { fitted.family.at(dialsOf(i)); });
  timed("terms", 25, [&](int i) { fitted.d.at(modelOf(i), fitted.pose); });
  timed("pose from one start, terms", 25,
        [&](int i) { fitted.d.refine(modelOf(i), {fitted.pose}); });
  timed("all of it", 25,
        [&](int i) { fitted.d.refine(fitted.family.at(dialsOf(i)), {fitted.pose}); });
  timed("pose from everywhere", 5, [&](int i) { fitted.d.search(modelOf(i)); });
}

void tellLine(const char* what, const std::vector<PoseFound>& found) {
  std::vector<double> y;
  for (const PoseFound& f : found) y.push_back(f.discrepancy);
  double rest = 0, jump = 0, bend = 0;
  for (std::size_t i = 0; i + 1 < y.size(); ++i) jump = std::max(jump, std::abs(y[i + 1] - y[i]));
  for (std::size_t i = 0; i + 3 < y.size(); ++i)
    bend = std::max(bend, std::abs(y[i + 3] - 3 * y[i + 2] + 3 * y[i + 1] - y[i]));
  // What the best cubic leaves of five neighbours: 6/70 of their fourth difference at most.
  for (std::size_t i = 2; i + 2 < y.size(); ++i)
    rest = std::max(
        rest, 6.0 / 70 * std::abs(y[i - 2] - 4 * y[i - 1] + 6 * y[i] - 4 * y[i + 1] + y[i + 2]));
  fmt::print("{}: largest step {:.4f}, third difference {:.4f}, residual to cubics {:.5f}\n", what,
             jump, bend, rest);
}

void tellSmooth() {
  const Pair& p = kPairs[0];
  const Fitted fitted(p);
  const auto along = [&](const char* what, auto dialsOf) {
    std::vector<PoseFound> found, held;
    for (int i = -10; i <= 10; ++i) {
      const std::vector<double> dials = dialsOf(i);
      const ModelLoop model = fitted.family.at(dials);
      found.push_back(fitted.d.refine(model, {fitted.pose}));
      held.push_back(fitted.d.at(model, fitted.pose));
      const PoseFound &f = found.back(), &h = held.back();
      fmt::print(
          "  {:.2f} {:.0f}  D {:.5f} R {:.5f} B {:.5f} M {:.5f} c {:.5f}  {:.2f} {:.2f} mm {:.2f} "
          "deg   held D {:.5f} R {:.5f} B {:.5f} M {:.5f}\n",
          dials[0], dials[1], f.discrepancy, f.terms.region, f.terms.boundary, f.terms.motion,
          f.terms.overlap, 1e3 * f.pose.shift_x_m, 1e3 * f.pose.shift_z_m,
          degreesFromRadians(f.pose.turn_rad), h.discrepancy, h.terms.region, h.terms.boundary,
          h.terms.motion);
    }
    tellLine(what, found);
    tellLine("  with the pose held", held);
  };
  along("EF in steps of 0.01", [&](int i) {
    return std::vector<double>{p.ef + 0.01 * i, p.edv_ml};
  });
  along("EDV in steps of 2 mL", [&](int i) {
    return std::vector<double>{p.ef, p.edv_ml + 2.0 * i};
  });
}

// Where a parabola through the least of three values at even steps lies, in steps.
double leastOf(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0;
}

// Where the loop's edges lie about the boundaries of the right heart: what biases its dials.
void tellEdges(const ModelDiscrepancy& d, const ModelLoop& right, const FitPose& pose) {
  const FitMap map = d.map(right, pose);
  for (const OffsetCurve& c : offsetCurves(map, right.structures.size())) {
    double sum = 0, n = 0;
    for (const double mm : c.offset_mm)
      if (std::isfinite(mm)) sum += mm, ++n;
    fmt::print("  edges of {} lie {:+.2f} mm out of blood\n", right.structures[c.part],
               n > 0 ? sum / n : 0);
  }
}

void tellPair(const char* name, const Pair& p, const Fitted& fitted) {
  const BeatFound beat = ModelDiscrepancy(fitted.loop, {}, fitted.right).beat();
  constexpr int kHalf = 5;
  constexpr double kEf = 0.02, kEdv = 0.04;  // steps; of EDV relative
  constexpr int kSide = 2 * kHalf + 1;
  std::vector<PoseFound> found(kSide * kSide);
  parallelBlocks(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const int i = static_cast<int>(n) / kSide - kHalf, j = static_cast<int>(n) % kSide - kHalf;
      found[n] = fitted.d.refine(
          fitted.family.at({p.ef + kEf * i, p.edv_ml * (1 + kEdv * j * 0.99)}), {fitted.pose});
    }
  });
  fmt::print("EF {:.2f}, EDV {:.0f} mL, {:.0f} mm, {:.0f} bpm, {}\n", p.ef, p.edv_ml, p.wall_mm,
             p.rate_bpm, name);
  const BeatFound& timed = fitted.d.beat();
  fmt::print("  end-systole of the models {:.3f}, of the loop {:.3f}, confidence {:.3f}\n",
             timed.span.shown_systole, timed.span.systole, timed.systole_confidence);
  const EchoSpread& spread = fitted.d.stack().spread();
  fmt::print("  echoes spread by {:.2f} mm along, {:.2f} mm across at 10 cm, {:.0f} dB\n",
             1e3 * spread.along_m, 100 * spread.across_rad, spread.contrast_db);
  fmt::print("  end-diastole where none is given: frame {:.2f}, confidence {:.3f}\n",
             beat.span.end_diastole, beat.confidence);
  tellEdges(fitted.d, fitted.right, fitted.pose);
  const auto tell = [&](const char* what, auto value) {
    int bi = 1, bj = 1;
    const auto at = [&](int i, int j) {
      return value(found[static_cast<std::size_t>(i * kSide + j)]);
    };
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j)
        if (at(i, j) < at(bi, bj)) bi = i, bj = j;
    const int i = std::clamp(bi, 1, kSide - 2), j = std::clamp(bj, 1, kSide - 2);
    const double ef = kEf * (i - kHalf + leastOf(at(i - 1, bj), at(i, bj), at(i + 1, bj))),
                 edv = kEdv * (j - kHalf + leastOf(at(bi, j - 1), at(bi, j), at(bi, j + 1)));
    // Along EF alone, EDV right.
    int only = 1;
    for (int k = 1; k + 1 < kSide; ++k)
      if (at(k, kHalf) < at(only, kHalf)) only = k;
    const double ef_alone =
        kEf * (only - kHalf + leastOf(at(only - 1, kHalf), at(only, kHalf), at(only + 1, kHalf)));
    fmt::print("  {:<10} EF {:+.3f}, EDV {:+.1f} %, least {:.4f}; EF alone {:+.3f}\n", what, ef,
               100 * edv, at(bi, bj), ef_alone);
  };
  tell("D", [](const PoseFound& f) { return f.discrepancy; });
  tell("region", [](const PoseFound& f) { return f.terms.region; });
  tell("boundary", [](const PoseFound& f) { return f.terms.boundary; });
  tell("motion", [](const PoseFound& f) { return f.terms.motion; });
  std::fflush(stdout);
}

void tellPairs() {
  for (const Pair& p : kPairs) tellPair("scanner", p, Fitted(p));
}

// The first of them under looks that spread echoes otherwise, and show them otherwise.
void tellLooks() {
  const Pair& p = kPairs[0];
  const auto tell = [&](const char* name, Look look, const Change& change) {
    tellPair(name, p, Fitted(p, look, change));
  };
  tell("clean", Look::clean, unchanged);
  tell("paper", Look::paper, unchanged);
  tell("aperture of 14 mm", Look::scanner, [](Scene& s) { s.probe.aperture_m = 14e-3; });
  tell("aperture of 28 mm", Look::scanner, [](Scene& s) { s.probe.aperture_m = 28e-3; });
  tell("dynamic range less by 15 dB", Look::scanner,
       [](Scene& s) { s.signal.dynamic_range_db -= 15; });
  tell("dynamic range more by 12 dB", Look::scanner,
       [](Scene& s) { s.signal.dynamic_range_db += 12; });
  tell("gain less by 8 dB", Look::scanner, [](Scene& s) { s.signal.gain_db -= 8; });
  tell("gain more by 8 dB", Look::scanner, [](Scene& s) { s.signal.gain_db += 8; });
  tell("no beam's width", Look::clean, [](Scene& s) { s.signal.beam_width = BeamWidth::none; });
}

// Models are told another heart rate than the loop's: another share of systole.
void tellRates() {
  for (const auto& [shown, told] : {std::pair{95.0, 60.0}, {55.0, 85.0}}) {
    Pair p = kPairs[0], q = p;
    p.rate_bpm = shown, q.rate_bpm = told;
    for (const bool warped : {false, true})
      tellPair(fmt::format("models of {:.0f} bpm, {}", told, warped ? "warped" : "even").c_str(), p,
               Fitted(p, familyOf(q), loopOf(p, Look::scanner, unchanged), warped));
  }
}

void run(const char* only) {
  const auto wanted = [&](const char* what) {
    return only == nullptr || std::strcmp(only, what) == 0;
  };
  if (wanted("cost")) tellCost();
  if (wanted("smooth")) tellSmooth();
  if (wanted("pairs")) tellPairs();
  if (wanted("looks")) tellLooks();
  if (wanted("rates")) tellRates();
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  echocine::withThreads(argc > 1 && std::strcmp(argv[1], "cost") == 0 ? 1 : 0,
                        [&] { echocine::bench::run(argc > 1 ? argv[1] : nullptr); });
}
