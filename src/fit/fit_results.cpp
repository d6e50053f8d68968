#include "fit/fit_results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fit/fit_interval.h"
#include "fit/fit_page.h"
#include "fit/fit_report.h"
#include "fit/fit_strain.h"
#include "fit/results_folder.h"
#include "motion/heart/heart_cycle.h"
#include "scene/names.h"

namespace echocine::fit {

namespace {

using Json = nlohmann::ordered_json;

Json estimateJson(const std::optional<Estimate>& e) {
  if (!e) return {};
  return {{"value", e->value}, {"low", e->low}, {"high", e->high}};
}

Json dialsJson(const HeartFit& fit) {
  Json out = Json::array();
  for (const DialFound& dial : fit.found) {
    // Without a length scale no mL and no mm.
    if (!fit.edv_ml && std::string(dialOf("dials", dial.key).unit) != "1") continue;
    out.push_back({{"dial", dial.key},
                   {"value", dial.value},
                   {"sd", dial.sd},
                   {"prior_sd", dial.prior_sd},
                   {"determined", dial.determined},
                   {"at_limit", dial.at_limit}});
    if (const auto sd = fit.resampled_sd.find(dial.key); sd != fit.resampled_sd.end())
      out.back()["resampled_sd"] = sd->second;
  }
  return out;
}

Json viewsJson(const HeartFit& fit, const std::vector<std::string>& labels) {
  Json out = Json::array();
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    const ViewFitted& view = fit.views[v];
    Json json{{"view", keyOf(view.view)}, {"loop", labels[v]}, {"has_scale", view.scaled}};
    json["fit"] = foundJson(view.found);
    json["tilt_deg"] = degreesFromRadians(view.tilt.tilt_rad);
    json["rotate_deg"] = degreesFromRadians(view.tilt.rotate_rad);
    json["beat"] = beatJson(view.beat);
    json["persistence"] = view.persistence ? Json(*view.persistence) : Json();
    json["own_look"] =
        view.own_sight ? Json{{"edges", view.own_sight->edges}, {"greys", view.own_sight->greys}}
                       : Json();
    if (view.controls)
      json["controls"] = {{"own", view.controls->own},
                          {"mirrored", view.controls->mirrored},
                          {"shuffled", view.controls->shuffled}};
    json["regions"] = regionsJson(view.regions);
    out.push_back(std::move(json));
  }
  return out;
}

Json ownErrorJson(const HeartFit& fit) {
  Json out = Json::object();
  for (const auto& [key, error] : fit.own_error)
    if (fit.edv_ml || std::string(dialOf("dials", key).unit) == "1") out[key] = error;
  return out;
}

Json rivalsJson(const HeartFit& fit) {
  Json out = Json::array();
  for (const HeartRival& rival : fit.rivals) {
    Json json{{"ef", rival.ef}, {"cost_above", rival.cost_above}};
    if (rival.gls) json["gls"] = *rival.gls;
    if (fit.edv_ml) json["dials"] = rival.dials;
    out.push_back(std::move(json));
  }
  return out;
}

}  // namespace

Json fitJson(const HeartFit& fit, const std::vector<std::string>& labels) {
  Json json{{"version", ECHOCINE_VERSION},
            {"result",
             {{"interval", 0.9},
              {"ef", estimateJson(fit.ef)},
              {"edv_ml", estimateJson(fit.edv_ml)},
              {"esv_ml", estimateJson(fit.esv_ml)},
              {"gls", estimateJson(fit.gls)}}},
            {"model_error",
             {{"agreement", fit.agreement ? Json(*fit.agreement) : Json()},
              {"ef", fit.model_error.ef},
              {"edv_relative", fit.model_error.edv},
              {"gls", fit.model_error.gls}}},
            {"own_loops_look", nameOf(fit.rendered_as)},
            {"refusal", fit.refusal.empty() ? Json() : Json(fit.refusal)},
            {"hints", fit.hints},
            {"dials", dialsJson(fit)},
            {"fixed_dials", fit.fixed},
            {"tilt_limit_deg", fit.tilt_deg},
            {"own_error", ownErrorJson(fit)},
            {"views", viewsJson(fit, labels)},
            {"rivals", rivalsJson(fit)},
            {"assumptions", assumptionsOf(fit)},
            {"stopped", fit.stopped},
            {"cost", fit.cost},
            {"cpu_s", 1e-3 * fit.cpu_ms}};
  return json;
}

namespace {

// V(t) = EDV (1 - EF e(t)), e: share of the stroke volume ejected so far. The interval scales the
// relative SD of EDV and ESV between end-diastole and end-systole.
struct VolumeAt {
  double phase, value, low, high;
};

std::vector<VolumeAt> volumeOf(const HeartFit& fit) {
  constexpr int kInstants = 50;
  const heart::Cycle cycle(heart::parametersFrom(fit.dials));
  const double edv = fit.edv_ml ? fit.edv_ml->value : 1;
  const Estimate end =
      fit.esv_ml ? *fit.esv_ml : Estimate{1 - fit.ef->value, 1 - fit.ef->high, 1 - fit.ef->low};
  const Estimate rest = fit.edv_ml.value_or(Estimate{1, 1, 1});
  std::vector<VolumeAt> out;
  for (int i = 0; i < kInstants; ++i) {
    const double phase = static_cast<double>(i) / kInstants;
    const double ejected = cycle.at(phase).left.ejected;
    out.push_back({phase, edv * (1 - fit.ef->value * ejected),
                   rest.low + ejected * (end.low - rest.low),
                   rest.high + ejected * (end.high - rest.high)});
  }
  return out;
}

// Eq. 17 over the beat; the interval scales that at end-systole.
std::vector<Estimate> strainsOf(const HeartFit& fit, const std::vector<VolumeAt>& at) {
  if (!fit.gls) return {};
  std::vector<double> phases;
  for (const VolumeAt& one : at) phases.push_back(one.phase);
  std::vector<Estimate> out;
  for (const double strain : longitudinalStrains(heart::parametersFrom(fit.dials), phases)) {
    const double share = strain / fit.gls->value,
                 half = 0.5 * std::abs(share) * (fit.gls->high - fit.gls->low),
                 middle = 0.5 * share * (fit.gls->high + fit.gls->low);
    out.push_back({strain, middle - half, middle + half});
  }
  return out;
}

}  // namespace

std::string curvesCsv(const HeartFit& fit) {
  std::string text = fit.edv_ml ? "phase,lv_ml,low_ml,high_ml" : "phase,lv_per_edv,low,high";
  text += fit.gls ? ",gls,gls_low,gls_high\n" : "\n";
  const std::vector<VolumeAt> volumes = volumeOf(fit);
  const std::vector<Estimate> strains = strainsOf(fit, volumes);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const VolumeAt& at = volumes[i];
    text += fmt::format("{:.3f},{:.6g},{:.6g},{:.6g}", at.phase, at.value, at.low, at.high);
    if (fit.gls)
      text +=
          fmt::format(",{:.6g},{:.6g},{:.6g}", strains[i].value, strains[i].low, strains[i].high);
    text += "\n";
  }
  return text;
}

Json volumeJson(const HeartFit& fit) {
  Json out{{"unit", fit.edv_ml ? "mL" : "of end-diastole"}};
  for (const VolumeAt& at : volumeOf(fit)) {
    out["phase"].push_back(at.phase);
    out["value"].push_back(at.value);
    out["low"].push_back(at.low);
    out["high"].push_back(at.high);
  }
  return out;
}

std::string fitText(const HeartFit& fit, const std::vector<std::string>& labels) {
  return fitJson(fit, labels).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::vector<std::string> assumptionsOf(const HeartFit& fit) {
  std::vector<std::string> out{
      "the heart is one of the parametric family: other shapes and still walls are not fitted",
      "the prior is that of people with and without an infarct, in equal parts",
      "the interval holds the noise of the loops and the error of the model",
      fit.agreement
          ? fmt::format("the model error belongs to an agreement of {:.2f}: about 1 for hearts of "
                        "the family in the look of their own rendered loops, lower for others",
                        *fit.agreement)
          : fmt::format("the model error belongs to an agreement of {:g}: without own loops it is "
                        "not measured",
                        kUnmeasuredAgreement)};
  if (fit.views.size() > 1)
    out.emplace_back(
        "the loops are of one heart in one state: only their heart rates are compared");
  out.insert(out.end(), fit.assumed.begin(), fit.assumed.end());
  for (const ViewFitted& view : fit.views) {
    if (fit.own_look && view.own_sight)
      out.push_back(fmt::format(
          "{}: edges and greys deviate from the model as in its own rendered loops (look {}), by a "
          "factor of {:.2f} and {:.2f}",
          keyOf(view.view), nameOf(fit.rendered_as), view.own_sight->edges, view.own_sight->greys));
    if (view.beat.length_source == kLoopIsBeat)
      out.push_back(fmt::format("{}: {}", keyOf(view.view), kLoopIsBeat));
    if (!view.scaled)
      out.push_back(fmt::format("{}: the sector has the model's depth", keyOf(view.view)));
  }
  return out;
}

void writeFit(const HeartFit& fit, const std::vector<std::string>& labels,
              const std::filesystem::path& folder) {
  const ResultsFolder results(folder, kFitFiles);
  if (fit.ef) results.write("curves.csv", curvesCsv(fit));
  if (!fit.stopped) writeFitPage(fit, labels, folder / "fit.html");
  results.write("fit.json", fitText(fit, labels));
}

}  // namespace echocine::fit
