#include "cli/live_command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cli/documents.h"
#include "cli/stop_signal.h"
#include "cli/warning_printer.h"

extern char** environ;

namespace echocine {

namespace {

bool hasDisplay() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

// Without waiting for it. The link is printed anyway, so a failure is not reported.
void openBrowser(std::string link) {
  std::string program = "xdg-open";
  std::array<char*, 3> words{program.data(), link.data(), nullptr};
  posix_spawn_file_actions_t actions;
  if (::posix_spawn_file_actions_init(&actions) != 0) return;
  for (const int stream : {1, 2})
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  ::posix_spawnp(&child, program.c_str(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
}

}  // namespace

LiveCommand::LiveCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("live", "Serve a page on this machine: move the probe and see the echo");
  command->add_option("scene", options_.scene, "Scene file (TOML; each key carries its unit)")
      ->required();
  command->add_option("--port", options_.port, "Port of 127.0.0.1; default 0: any free one")
      ->check(CLI::Range(0, 65535));
  command->add_flag("--no-browser", no_browser_, "Print the link only");
  command->add_option("--record", options_.record,
                      "Folder for a scene file of each pose at which the probe comes to rest");
  command->add_option("--threads", options_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print the link and errors only");
  command->footer("Example: echocine live scene.toml\n" + std::string(kDocuments));
}

int LiveCommand::run() {
  const auto listening = [&](const std::string& link) {
    fmt::print("{}\n", link);
    if (!quiet_) fmt::print("Ctrl-C ends the session.\n");
    std::fflush(stdout);
    if (!no_browser_ && hasDisplay()) openBrowser(link);
  };
  live::serveLive(options_, listening, warningPrinter(quiet_), stopWanted);
  return 0;
}

}  // namespace echocine
