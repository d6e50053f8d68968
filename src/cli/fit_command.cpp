#include "cli/fit_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>

#include "cli/documents.h"
#include "cli/number_check.h"
#include "cli/progress_line.h"
#include "cli/view_list.h"
#include "core/error.h"
#include "core/parallel.h"
#include "fit/dial_scan.h"
#include "fit/fit_resamples.h"
#include "video/video.h"

namespace echocine {

namespace {

struct ViewText {
  heart::View view{};
  std::string rest;
};

// "a4c=REST".
ViewText namedIn(const char* option, const std::string& text, const char* example) {
  const std::size_t at = text.find('=');
  const auto view = heart::viewOf(text.substr(0, at));
  if (at == std::string::npos || !view || at + 1 == text.size())
    throw SceneError(fmt::format("{}: \"{}\" is not accepted: VIEW={}, VIEW one of {}", option,
                                 text, example, viewList()));
  return {*view, text.substr(at + 1)};
}

void printFit(const fit::HeartFit& fit, const std::filesystem::path& folder) {
  const auto row = [](const char* name, const std::optional<fit::Estimate>& e, const char* unit,
                      int digits) {
    if (e)
      fmt::print("  {:<4} {:.{}f} ({:.{}f} to {:.{}f} at 90 %){}\n", name, e->value, digits, e->low,
                 digits, e->high, digits, unit);
  };
  fmt::print("{}{}\n", fit.stopped ? "stopped: the best heart so far, in " : "", folder.string());
  row("EF", fit.ef, "", 3);
  row("EDV", fit.edv_ml, " mL", 1);
  row("ESV", fit.esv_ml, " mL", 1);
  row("GLS", fit.gls, "", 3);
  for (const std::string& hint : fit.hints) fmt::print("  {}\n", hint);
}

}  // namespace

FitCommand::FitCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "fit", "Fit a beating heart with an error bar to one to three echo videos");
  command->add_option("files", files_,
                      "Loops of unknown view: each view is ranked, and refused if it is unclear; "
                      "36 s of one core each");
  command
      ->add_option("--view", views_,
                   "A loop and its view, VIEW=FILE: a video, DICOM, folder of frames or of a "
                   "render, EchoXFlow (.zarr), or zea (.hdf5); VIEW one of " +
                       viewList())
      ->allow_extra_args(false)
      ->type_name("VIEW=FILE");
  command->add_option("-o,--output", folder_, "Folder for the results")->required();
  command
      ->add_option("--scale", scales_,
                   "Length scale of a loop, VIEW=NUMBER in cm per pixel, 0.0001 to 10, or NUMBER "
                   "for all; without a scale no mL")
      ->allow_extra_args(false)
      ->type_name("[VIEW=]CM");
  command
      ->add_option("--ed", ends_of_diastole_,
                   "Frame of end-diastole, VIEW=NUMBER, from 0, or NUMBER for all")
      ->allow_extra_args(false)
      ->type_name("[VIEW=]FRAME");
  command
      ->add_option("--es", ends_of_systole_,
                   "Frame of end-systole, VIEW=NUMBER, from 0, or NUMBER for all")
      ->allow_extra_args(false)
      ->type_name("[VIEW=]FRAME");
  command
      ->add_option("--fps", rates_,
                   "Frame rate of a loop, VIEW=NUMBER, 0.5 to 10000, or NUMBER for all")
      ->allow_extra_args(false)
      ->type_name("[VIEW=]FPS");
  command->add_option("--dials", dials_,
                      "Fixed dials of the heart, such as hr=72,wall-thickness=11");
  command
      ->add_option("--tilt", tilt_deg_,
                   fmt::format("Limit of tilt and rotation of each plane, degrees, 0 to {:g}",
                               fit::kMostTilt_deg))
      ->check(within(0, fit::kMostTilt_deg))
      ->type_name("NUMBER")
      ->capture_default_str();
  command
      ->add_option("--resamples", resamples_,
                   fmt::format("Fit again without each of so many blocks of the beat, {} to {}: "
                               "intervals include their spread; 0: none",
                               fit::kLeastResamples, fit::kMostResamples))
      ->type_name("NUMBER")
      ->capture_default_str();
  CLI::Option* own_look = command->add_flag(
      "--own-look", own_look_,
      "Expect the edges and grey levels of the found heart's rendered loops: five times the time; "
      "default with two or three loops, or one with persistence");
  command->add_flag("--no-own-look", no_own_look_, "Expect those of the model alone")
      ->excludes(own_look);
  command->add_flag("--resume", resume_, "Continue a stopped fit in the folder");
  command->add_flag("--no-cache", no_cache_,
                    "Neither read nor keep computed hearts in the user's cache folder");
  command->add_flag("--no-ecg", no_ecg_, "Do not read an ECG from the pictures");
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer(
      "Example: echocine fit --view a4c=four.mp4 --scale a4c=0.021 --view a2c=two.dcm -o heart\n" +
      std::string(kDocuments));
}

namespace {

double numberIn(const char* option, const std::string& whole, const std::string& text, double low,
                double high) {
  double value = 0;
  if (!CLI::detail::lexical_cast(text, value) || !(value >= low && value <= high))
    throw SceneError(fmt::format("{}: {} is not accepted: a number from {:g} to {:g}", option,
                                 whole, low, high));
  return value;
}

}  // namespace

void FitCommand::setNumbers(const char* option, const std::vector<std::string>& given, double low,
                            double high, std::vector<fit::FitFile>& files,
                            std::optional<double> echo::SideOptions::*member, double unit) {
  for (const std::string& text : given) {
    if (text.find('=') == std::string::npos) {
      const double value = numberIn(option, text, text, low, high);
      for (fit::FitFile& file : files) file.side.*member = value * unit;
      continue;
    }
    const ViewText named = namedIn(option, text, "NUMBER");
    const auto file = std::find_if(files.begin(), files.end(),
                                   [&](const fit::FitFile& f) { return f.view == named.view; });
    if (file == files.end())
      throw SceneError(fmt::format("{}: {} has no loop; give --view {}=FILE", option,
                                   keyOf(named.view), keyOf(named.view)));
    file->side.*member = numberIn(option, text, named.rest, low, high) * unit;
  }
}

std::vector<fit::FitFile> FitCommand::filesGiven() const {
  std::vector<fit::FitFile> out;
  for (const std::string& text : views_) {
    const ViewText named = namedIn("--view", text, "FILE");
    out.push_back({named.view, named.rest, {}});
  }
  for (const std::string& file : files_) out.push_back({std::nullopt, file, {}});
  if (out.empty()) throw SceneError("fit: give a loop: --view VIEW=FILE, or FILE");
  for (fit::FitFile& file : out) file.side.read_ecg = !no_ecg_;
  constexpr double kMmPerCm = 10;
  setNumbers("--scale", scales_, echo::kLeastScale_mm / kMmPerCm, echo::kMostScale_mm / kMmPerCm,
             out, &echo::SideOptions::mm_per_pixel, kMmPerCm);
  setNumbers("--ed", ends_of_diastole_, 0, echo::kMostFrame, out, &echo::SideOptions::ed_frame);
  setNumbers("--es", ends_of_systole_, 0, echo::kMostFrame, out, &echo::SideOptions::es_frame);
  setNumbers("--fps", rates_, kLeastFrameRate_hz, kMostFrameRate_hz, out, &echo::SideOptions::fps);
  return out;
}

int FitCommand::run() {
  const std::vector<fit::FitFile> files = filesGiven();
  fit::HeartFitOptions options;
  options.dials = fit::parseDials(dials_);
  options.tilt_deg = tilt_deg_;
  options.resamples = resamples_;
  if (own_look_ || no_own_look_) options.own_look = own_look_;
  if (!no_cache_) options.heart_cache = fit::userHeartCache();
  ProgressLine line(quiet_);
  fit::HeartFit fit;
  withThreads(threads_,
              [&] { fit = fitFiles(files, options, folder_, line.monitor(), resume_).fit; });
  line.finish();
  if (!fit.refusal.empty())
    throw JobError(fmt::format("no result: {}{}", fit.refusal,
                               fit.hints.empty() ? "" : " (fit.json has more hints)"));
  if (!quiet_) printFit(fit, folder_);
  if (fit.stopped)
    throw JobError(fmt::format(
        "stopped: {} has the best heart so far; the same command with --resume continues",
        folder_.string()));
  return 0;
}

}  // namespace echocine
