#include "cli/doppler_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/documents.h"
#include "cli/enum_names.h"
#include "cli/progress_line.h"
#include "core/error.h"
#include "core/units.h"
#include "scene/names.h"
#include "scene/scene_reader.h"

namespace echocine {

DopplerCommand::DopplerCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "doppler", "Write tissue Doppler: velocities measured from pulses, beside the exact ones");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option("-o,--output", options_.folder,
                   "Folder for velocity/, doppler.gif and doppler.json")
      ->required();
  DopplerRequest& request = options_.request;
  command->add_option("--prf", request.prf_hz, "Pulses a second on each line, Hz")
      ->capture_default_str();
  command->add_option("--pulses", request.pulses, "Pulses of a packet")->capture_default_str();
  command
      ->add_option("--gate", gate_mm_, "Length along the line over which a velocity averages, mm")
      ->capture_default_str();
  command->add_option("--wall-filter", wall_, "Polynomial that is removed from each packet")
      ->check(CLI::IsMember(enumNames<WallFilterKind>()))
      ->capture_default_str();
  CLI::Option* depth = command->add_option(
      "--depth", depth_mm_, "Depth of a place on the line, mm; writes a spectrum there");
  CLI::Option* angle =
      command->add_option("--angle", angle_deg_, "Angle of that line, degrees; default: 0");
  CLI::Option* offset = command->add_option(
      "--offset", offset_mm_, "Linear probes: lateral offset of that line, mm; default: 0");
  CLI::Option* through =
      command
          ->add_option("--through", through_,
                       "Place of the heart at end-diastole; writes a spectrum there")
          ->check(CLI::IsMember(enumNames<MModeTarget>()));
  angle->excludes(offset)->needs(depth);
  offset->needs(depth);
  through->excludes(angle)->excludes(offset)->excludes(depth);
  command->add_option("--volume", volume_mm_,
                      "Length of the spectrum's sample volume, mm; default: 5");
  command->add_flag("--png", options_.png, "A PNG of each frame too");
  command->add_option("--threads", options_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine doppler scene.toml -o tdi --through mitral-septal\n" +
                  std::string(kDocuments));
}

int DopplerCommand::run() {
  const Scene scene = readScene(scene_file_);
  options_.request.gate_m = metresFromMillimetres(gate_mm_);
  options_.request.wall = valueOf<WallFilterKind>(wall_).value();
  if (volume_mm_ && !depth_mm_ && through_.empty())
    throw SceneError(
        "--volume: needs a place of the spectrum, accepted: with --depth or --through");
  if (depth_mm_ || !through_.empty()) {
    SpectrumRequest& spectrum = options_.spectrum.emplace();
    if (volume_mm_) spectrum.volume_m = metresFromMillimetres(*volume_mm_);
    if (depth_mm_) spectrum.at.depth_m = metresFromMillimetres(*depth_mm_);
    if (!through_.empty()) spectrum.at.through = valueOf<MModeTarget>(through_);
    spectrum.at.place = placeGiven(scene.probe, angle_deg_, offset_mm_);
  }
  ProgressLine progress(quiet_);
  const DopplerSummary made = writeDoppler(scene, options_, progress.monitor());
  progress.finish();
  if (quiet_) return 0;
  constexpr double kCentimetres = 100;
  fmt::print(
      "{}: {} frames, Nyquist velocity {:.1f} cm/s\n  against the exact velocities: bias {:.2f} "
      "cm/s, RMS {:.2f} cm/s; {:.1f} % of the tissue is faster than Nyquist\n",
      options_.folder.string(), made.frames, kCentimetres * made.nyquist_m_s,
      kCentimetres * made.bias_m_s, kCentimetres * made.rms_m_s, 100 * made.aliased_share);
  if (made.spectrum)
    fmt::print("  spectrum on scan line {} at {:.1f} mm\n", made.spectrum->line,
               millimetresFromMetres(made.spectrum->depth_m));
  if (made.spectrum && made.spectrum->exact_peak != 0)
    fmt::print("  peak systolic velocity: {:.1f} cm/s, exact {:.1f} cm/s\n",
               kCentimetres * made.spectrum->mean_peak, kCentimetres * made.spectrum->exact_peak);
  return 0;
}

}  // namespace echocine
