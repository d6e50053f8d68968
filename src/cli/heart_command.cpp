#include "cli/heart_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>

#include "cli/documents.h"
#include "cli/enum_names.h"
#include "cli/stop_signal.h"
#include "cli/view_list.h"
#include "core/error.h"
#include "scene/names.h"

namespace echocine {

namespace {

// "N:AMPLITUDE" or "N:AMPLITUDE:DELAY_MS".
void applySegment(const std::string& text, heart::Parameters& parameters) {
  const auto refuse = [&] {
    throw SceneError(fmt::format(
        "--segment: \"{}\" is not accepted: NUMBER:AMPLITUDE or NUMBER:AMPLITUDE:DELAY_MS, the "
        "number 1 to {}, such as 7:0 for an akinetic mid-anterior wall",
        text, heart::kSegments));
  };
  // from_chars and not stod: it knows no locale, in which 0.5 might end at the point.
  std::vector<double> values;
  for (const char *at = text.data(), *end = at + text.size();; ++at) {
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec != std::errc()) refuse();
    values.push_back(value);
    at = result.ptr;
    if (at == end) break;
    if (*at != ':') refuse();
  }
  if (!(values[0] >= 1 && values[0] <= heart::kSegments)) refuse();
  const int number = static_cast<int>(values[0]);
  // A segment number with a fraction is a mistake, not the segment below.
  if (values.size() < 2 || values.size() > 3 || values[0] != number) refuse();
  heart::Segment& segment = parameters.segments[static_cast<std::size_t>(number - 1)];
  segment.amplitude = values[1];
  if (values.size() == 3) segment.delay_s = values[2] * 1e-3;
}

}  // namespace

HeartCommand::HeartCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "heart", "Write a parametric beating heart: keyframe meshes, a scene, ground truth");
  command
      ->add_option("-o,--output", folder_, "New folder for the meshes, scene.toml and truth.json")
      ->required();
  command->add_option("--view", view_, "Standard view of the probe")
      ->type_name(viewChoice())
      ->capture_default_str();
  const heart::Parameters defaults;
  // One option per dial, with unit, range and default from the heart's own table.
  for (const heart::Dial& dial : heart::dials()) {
    const std::string unit = std::string(dial.unit) == "1" ? "" : std::string(" ") + dial.unit;
    const auto standard = dial.get(defaults);
    command
        ->add_option_function<double>(
            std::string("--") + dial.key,
            [this, &dial](const double& value) { given_[dial.key] = value; },
            fmt::format("{}{}; {:g} to {:g}{}{}", dial.meaning, unit.empty() ? "" : "," + unit,
                        dial.low, dial.high, standard ? "; default " : "",
                        standard ? fmt::format("{:g}", *standard) : ""))
        ->type_name(unit.empty() ? "NUMBER" : dial.unit);
  }
  command->add_option(
      "--segment", segments_,
      "Wall motion of one of the 17 segments, NUMBER:AMPLITUDE[:DELAY_MS]: 1 healthy, "
      "0 akinetic, below 0 dyskinetic; may be repeated");
  command
      ->add_option("--rule", rule_,
                   "If --segment reduces wall motion: segments (the ejection fraction falls) or "
                   "volumes (the ejection fraction stays that of --ef)")
      ->check(CLI::IsMember({"segments", "volumes"}))
      ->capture_default_str();
  command
      ->add_option("--look", look_,
                   "Look of the scene's pictures: paper (the published model, without speckle), "
                   "clean (speckle and a grey map), scanner (clean, with scanner artefacts)")
      ->check(CLI::IsMember(enumNames<Look>()))
      ->capture_default_str();
  command->add_option("--keyframes", wanted_.keyframes, "Keyframes per beat")
      ->check(CLI::Range(4, 100))
      ->capture_default_str();
  command->add_flag(
      "--even", even_,
      "Space keyframes evenly in time, not by motion; end-systole then lies between two keyframes");
  command
      ->add_option("--format", format_,
                   "Files of the keyframes: obj (one per structure and keyframe) or npz (one NumPy "
                   "file per structure: points [K, V, 3] and faces [F, 3])")
      ->check(CLI::IsMember({"obj", "npz"}))
      ->capture_default_str();
  command->add_option("--threads", wanted_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine heart --ef 0.35 --view a2c -o failing_heart\n" +
                  std::string(kDocuments));
}

// Ranges and contradictions are the heart's to judge: this only reads.
int HeartCommand::run() {
  const auto view = heart::viewOf(view_);
  if (!view)
    throw SceneError(fmt::format("--view: \"{}\" is not a view, accepted: {}", view_, viewList()));
  wanted_.view = *view;
  if (even_) wanted_.spacing = heart::KeyframeSpacing::even;
  if (const std::string fault = heart::contradictionIn(given_); !fault.empty())
    throw SceneError(fault);
  wanted_.parameters = heart::parametersFrom(given_);
  for (const std::string& segment : segments_) applySegment(segment, wanted_.parameters);
  wanted_.parameters.volumes_rule = rule_ == "volumes";
  for (const auto& [look, name] : NamesOf<Look>::kAll)
    if (look_ == name) wanted_.look = look;
  if (format_ == "npz") wanted_.format = heart::MeshFormat::npz;
  writeHeart(wanted_, folder_, {.keep_going = [] { return !stopWanted(); }});
  if (!quiet_)
    fmt::print("{0} keyframes in {1}\n  echocine render {2} -o LOOP\n", wanted_.keyframes,
               folder_.string(), (folder_ / "scene.toml").string());
  return 0;
}

}  // namespace echocine
