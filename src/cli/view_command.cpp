#include "cli/view_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "cli/documents.h"
#include "cli/warning_printer.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scene_reader.h"
#include "view/view_page.h"

namespace echocine {

ViewCommand::ViewCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "view", "Write a page that shows a scene's meshes and imaging plane in 3-D");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option(
          "-o,--output", page_,
          "Page to write (HTML, one file that opens offline); an existing file is replaced")
      ->required();
  command
      ->add_option(
          "--triangles", budget_.triangles,
          "Largest number of triangles drawn, all structures together; open edges are kept")
      ->check(CLI::Range(100, 1000000))
      ->capture_default_str();
  command
      ->add_option(
          "--phases", budget_.phases,
          "Instants of the beat on the page; positions are interpolated linearly between them")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine view scene.toml -o page.html\n" + std::string(kDocuments));
}

int ViewCommand::run() {
  const Scene scene = placed(readScene(scene_file_));
  // The default of one structure is for the default of all.
  budget_.triangles_per_structure =
      std::max(budget_.triangles_per_structure, budget_.triangles / 16);
  const ViewSummary summary =
      writeViewPage(scene, page_, threads_, warningPrinter(quiet_), budget_);
  if (quiet_) return 0;
  fmt::print("{}\n{}: {} structures, {} of {} triangles drawn\n", summary.sight, page_.string(),
             summary.structures, summary.triangles_shown, summary.triangles_given);
  return 0;
}

}  // namespace echocine
