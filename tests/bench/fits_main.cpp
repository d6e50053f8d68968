// fit_table VIEWS HEARTS [KEY=VALUE ...]: fits of planted hearts, one line each, then bias, RMS,
// the model error of Eq. 15 and how many intervals hold the planted value. Keys: `first`, number of
// the first heart; `degrees`, limit of tilts and rotations of the planes; `dials`, those searched,
// separated by commas; `look`, that of the planted loops; `own_look` and `own_loops`, 1 or 0: with
// or without; `sections`, 1: hearts have other sections and walls than the models.
// fit_table VIEWS foreign [KEY=VALUE ...]: the same for meshes of other people.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <span>

#include "core/parallel.h"
#include "core/units.h"
#include "fit/fit_interval.h"
#include "fit/fit_strain.h"
#include "fit/option_list.h"
#include "scene/names.h"
#include "support/moving_statics.h"
#include "support/planted_fits.h"

namespace echocine::bench {
namespace {

using namespace fit;
using namespace support;

// Errors of one number over hearts.
struct Errors {
  const char* name;
  double sum = 0, squares = 0, noise = 0;  // noise: sum of variances by curvature
  int count = 0, held = 0;

  void add(double error, double sd, bool within) {
    sum += error;
    squares += error * error;
    noise += sd * sd;
    ++count;
    held += within ? 1 : 0;
  }
  void print() const {
    if (count == 0) return;
    const double mean = sum / count, rms = std::sqrt(squares / count);
    const double model = std::sqrt(std::max(0.0, (squares - noise) / count));
    fmt::print(
        "{}: {} hearts, bias {:+.4f}, RMS {:.4f}, SD by curvature {:.4f}, model error {:.4f}, "
        "{} intervals of 90 % hold\n",
        name, count, mean, rms, std::sqrt(noise / count), model, held);
  }
};

constexpr NamedHeart kNamedHearts[] = {
    {"patient with atria", &wholePatientScene},
    {"whole heart", &wholeHeartScene},
    {"patient's ventricles alone", [](View view) { return sceneOf(Family::patient, view); }}};
// Named here before the first of their fits. The first two were never used to choose anything.
constexpr NamedHeart kStatedHearts[] = {
    {"four chambers", &movingFourChambersScene},
    {"template", &movingTemplateScene},
    {"whole heart, muscle keeps its volume", &movingWholeHeartScene}};

double sdOf(const HeartFit& fit, const char* key) {
  for (const DialFound& dial : fit.found)
    if (dial.key == key) return dial.sd;
  return 0;
}

void tellFit(int number, const PlantedHeart& heart, const HeartFitOptions& options, Errors& ef,
             Errors& edv, Errors& gls) {
  const HeartFit fit = fitHeart(heart.given(), options);
  const double true_ef = heart.dials.at("ef"), true_edv = heart.dials.at("edv");
  if (!fit.ef || !fit.edv_ml) {
    fmt::print("{}: refused: {}\n", number, fit.refusal);
    return;
  }
  const double ef_error = fit.ef->value - true_ef, edv_error = fit.edv_ml->value / true_edv - 1;
  const auto within = [](const Estimate& e, double value) {
    return value >= e.low && value <= e.high;
  };
  ef.add(ef_error, sdOf(fit, "ef"), within(*fit.ef, true_ef));
  edv.add(edv_error, sdOf(fit, "edv") / true_edv, within(*fit.edv_ml, true_edv));
  if (fit.gls && heart.dials.contains("twist")) {  // of a parametric heart
    const double true_gls = longitudinalStrainOf(heart::parametersFrom(heart.dials));
    // From the interval of Eq. 15, without the model error.
    const double sd = (fit.gls->high - fit.gls->low) / (2 * 1.645), model = fit.model_error.gls;
    gls.add(fit.gls->value - true_gls, std::sqrt(std::max(0.0, sd * sd - model * model)),
            within(*fit.gls, true_gls));
  }
  const auto own = [&](const char* key) {
    return fit.own_error.contains(key) ? fit.own_error.at(key) : 0;
  };
  fmt::print(
      "{}: EF {:.3f} for {:.3f}: {:+.3f}, own error {:+.3f}; EDV {:.1f} for {:.1f}: {:+.1f} %, own "
      "error {:+.1f} %; {:.0f} s\n",
      number, fit.ef->value, true_ef, ef_error, own("ef"), fit.edv_ml->value, true_edv,
      100 * edv_error, 100 * own("edv") / true_edv, 1e-3 * fit.cpu_ms);
  for (const DialFound& dial : fit.found) {
    const auto planted = heart.dials.find(dial.key);
    fmt::print("  {} {:.3f} ({:.3f})", dial.key, dial.value, dial.sd);
    if (planted != heart.dials.end()) fmt::print(" for {:.3f}", planted->second);
  }
  fmt::print("\n");
  for (const std::string& hint : fit.hints) fmt::print("  {}\n", hint);
  fmt::print("  J {:.1f}, look {}, agreement {:.2f}\n", fit.cost, nameOf(fit.rendered_as),
             fit.agreement.value_or(-1));
  for (const ViewFitted& view : fit.views) {
    const OwnSight sight = view.own_sight.value_or(OwnSight{});
    fmt::print(
        "  {}: D {:.3f}, own look {:.2f} (edges), {:.2f} (greys); tilt {:.1f}, rotate {:.1f}\n",
        keyOf(view.view), view.found.discrepancy, sight.edges, sight.greys,
        degreesFromRadians(view.tilt.tilt_rad), degreesFromRadians(view.tilt.rotate_rad));
    for (const RegionFinding& r : view.regions)
      fmt::print(
          "  {} {}: offset {:+.2f} ({:.2f}) mm, motion {:+.2f} ({:.2f}) mm, local {:+.2f} ({:.2f}) "
          "mm, {:.0f} pieces, "
          "certainty {:.2f}{}\n",
          keyOf(view.view), r.name, r.offset_mm, r.offset_sd_mm, r.motion_mm, r.motion_sd_mm,
          r.local_mm.value_or(0), r.local_sd_mm, r.pieces, r.certainty,
          r.significant ? ", significant" : "");
  }
  std::fflush(stdout);
}

constexpr const char* kUsage =
    "fit_table VIEWS HEARTS|foreign [first=N] [degrees=D] [dials=A,B] [look=LOOK] [own_look=0] "
    "[own_loops=0] [sections=1] [beat=0] [descents=N]";

int run(int argc, char** argv) {
  std::map<std::string, std::string> given{
      {"first", "0"},     {"degrees", ""},   {"dials", ""}, {"look", "scanner"}, {"own_look", ""},
      {"own_loops", "1"}, {"sections", "0"}, {"beat", "1"}, {"descents", "2"}};
  bool known = argc >= 3;
  for (int i = 3; i < argc; ++i) {
    const std::vector<std::string> parts = splitOption(argv[i], '=');
    known = known && parts.size() == 2 && given.contains(parts[0]);
    if (known) given[parts[0]] = parts[1];
  }
  const std::optional<Look> look = valueOf<Look>(given["look"]);
  if (!known || !look) {
    fmt::print("{}\n", kUsage);
    return 2;
  }
  const auto views = static_cast<std::size_t>(std::clamp(std::atoi(argv[1]), 1, 3));
  const bool foreign = std::strcmp(argv[2], "foreign") == 0;
  const int hearts = std::atoi(argv[2]), first = std::atoi(given["first"].c_str());
  const double most_deg =
      given["degrees"].empty() ? (foreign ? 5 : 8) : std::atof(given["degrees"].c_str());
  HeartFitOptions options;
  if (!given["dials"].empty()) options.searched = splitOption(given["dials"], ',');
  if (!given["own_look"].empty()) options.own_look = given["own_look"] != "0";
  options.own_loops = given["own_loops"] != "0";
  options.descents = std::atoi(given["descents"].c_str());
  Errors ef{"EF"}, edv{"EDV, relative"}, gls{"GLS"};
  withThreads(0, [&] {
    if (foreign) {
      int n = 0;
      for (const std::span<const NamedHeart> group :
           {std::span(kNamedHearts), std::span(kStatedHearts)})
        for (const double deg : {0.0, most_deg})
          for (const NamedHeart& heart : group) {
            const int number = n++;
            if (number < first) continue;
            fmt::print("{}, planes off by up to {:g} degrees\n", heart.name, deg);
            tellFit(number, foreignHeart(heart.in, number, views, deg), options, ef, edv, gls);
          }
      return;
    }
    for (int n = first; n < first + hearts; ++n)
      tellFit(
          n,
          plantedHeart(n, views, most_deg, *look, given["sections"] != "0", given["beat"] != "0"),
          options, ef, edv, gls);
  });
  ef.print();
  edv.print();
  gls.print();
  return 0;
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  return echocine::bench::run(argc, argv);
}
