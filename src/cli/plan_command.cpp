#include "cli/plan_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/documents.h"
#include "cli/interpolation_table.h"
#include "cli/stop_signal.h"
#include "cli/warning_printer.h"
#include "core/output_check.h"
#include "motion/surfaces/probe_placement.h"
#include "render/estimate.h"
#include "scene/probe_pose.h"
#include "scene/scene_reader.h"
#include "scene/white_rule.h"
#include "view/view_page.h"

namespace echocine {

namespace {

// Seconds as long as one would wait for them.
std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{:.0f} min", seconds / 60);
}

// Only effects that run have a share of time; "0 %" of the others would be uninformative.
void printEffects(const Manifest& manifest) {
  fmt::print("{:<24} {:<4} {:>5}  {}\n", "effect", "", "time", "why");
  for (const EffectDecision& e : manifest.plan.effects.decisions) {
    const double share = timeShare(e, manifest);
    const std::string percent = e.on ? fmt::format("{:.0f} %", 100 * share) : "";
    fmt::print("{:<24} {:<4} {:>5}  {}\n", e.name(), e.on ? "on" : "off", percent, e.reason);
  }
}

// In the syntax of a scene, to be pasted and edited.
void printPose(const Scene& scene) {
  std::string head = "probe       ";
  std::istringstream lines(poseToml(scene));
  for (std::string line; std::getline(lines, line); head = std::string(head.size(), ' '))
    fmt::print("{}{}\n", head, line);
}

void printRest(const Scene& scene, const Estimate& estimate) {
  const LoopPlan& plan = estimate.measured.plan;
  for (const Omission& i : plan.interfaces)
    fmt::print("{:<24} {:<4} {:>5}  {}\n", i.name, "off", "", i.reason);
  fmt::print("\ntracer      {}: {}\n", plan.tracerName(), plan.tracer_reason);
  fmt::print("echoes      {}\n", plan.echo_reason);
  fmt::print("white       {}\n", whiteWords(scene));
  fmt::print("triangles   {} given, {} in structures in use, {} cut by the imaging plane\n",
             plan.triangles_given, plan.triangles_kept, plan.triangles_met);
  std::string stages;
  for (std::size_t s = 0; s < kStages; ++s)
    stages += fmt::format("{}{} {:.2f}", s ? ", " : "", stageName(static_cast<Stage>(s)),
                          estimate.measured.stage_ms[s]);
  fmt::print("time        {} for {} frames; per frame in ms: {}\n", duration(estimate.seconds),
             estimate.frames, stages);
  fmt::print("memory      {:.0f} MB\n", estimate.memory_bytes * 1e-6);
}

}  // namespace

PlanCommand::PlanCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "plan", "List the effects that a scene needs, with reasons, expected time and memory");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  accuracy_.addTo(*command);
  CLI::Option* interpolation =
      command->add_flag("--interpolation", interpolation_,
                        "Print only the errors of each kind of motion.interpolation at omitted "
                        "keyframes, mm and mL");
  command
      ->add_option("--page", page_,
                   "Also write the page of `echocine view` to this file: meshes and sector in 3-D")
      ->excludes(interpolation);
  for (const char* name : {"--preset", "--tolerance-db"})
    interpolation->excludes(command->get_option(name));
  command->add_flag("--json", json_, "Print JSON");
  command->add_flag("--quiet", quiet_, "Print no warnings");
  command->footer("Example: echocine plan scene.toml\n" + std::string(kDocuments));
}

int PlanCommand::run() {
  if (interpolation_) {
    printInterpolation(placed(readScene(scene_file_)), json_);
    return 0;
  }
  if (!page_.empty()) checkOutputFile(page_);
  Scene scene = placed(readScene(scene_file_));
  accuracy_.resolve(scene, threads_, quiet_);
  const Monitor monitor{.keep_going = [] { return !stopWanted(); }, .warn = warningPrinter(quiet_)};
  const Estimate estimate = estimateLoop(scene, threads_, monitor);
  if (!page_.empty()) writeViewPage(scene, page_, threads_, [](const std::string&) {});
  if (json_) {
    fmt::print("{}\n", estimateJson(scene, estimate).dump(1));
  } else {
    printEffects(estimate.measured);
    printRest(scene, estimate);
    printPose(scene);
  }
  return 0;
}

}  // namespace echocine
