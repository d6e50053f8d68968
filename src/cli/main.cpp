// echocine: arguments in, one call, the exit code out. The only place that catches.

#include <fmt/format.h>
#include <pthread.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <new>
#include <string_view>

#include "cli/archive_command.h"
#include "cli/compare_command.h"
#include "cli/dataset_command.h"
#include "cli/doppler_command.h"
#include "cli/export_command.h"
#include "cli/fit_command.h"
#include "cli/heart_command.h"
#include "cli/live_command.h"
#include "cli/mmode_command.h"
#include "cli/one_line.h"
#include "cli/plan_command.h"
#include "cli/render_command.h"
#include "cli/self_description.h"
#include "cli/standard_error.h"
#include "cli/stop_signal.h"
#include "cli/study_command.h"
#include "cli/view_command.h"
#include "core/error.h"
#include "core/nearest_word.h"
#include "core/out_of_memory.h"
#include "core/stop.h"

namespace {

// 1: try again elsewhere (disk, memory, a signal). 2: change the arguments, the scene or a mesh.
// Scripts rely on the difference.
constexpr int kJobFailed = 1;
constexpr int kUnusable = 2;

// Suggestion for a misspelt word: the nearest command, or option of the command.
std::string nearestTo(const std::string& word, const CLI::App& app) {
  std::vector<std::string> known;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  } else {
    for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  }
  return echocine::nearestWord(word.substr(0, word.find('=')), known);
}

// Suggestion for the first word that the parser rejected.
std::string misspelt(int argc, char** argv, const CLI::App& app) {
  const CLI::App* command = nullptr;
  for (const CLI::App* one : app.get_subcommands({}))
    if (argc > 1 && one->get_name() == argv[1]) command = one;
  if (command == nullptr) {
    if (argc < 2 || argv[1][0] == '-') return {};
    const std::string nearest = nearestTo(argv[1], app);
    return fmt::format("\"{}\" is not a command{}", argv[1],
                       nearest.empty() ? "" : fmt::format(", nearest: {}", nearest));
  }
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    if (!word.starts_with("--") || command->get_option_no_throw(name)) continue;
    const std::string nearest = nearestTo(word, *command);
    return fmt::format("{}: {} is not an option{}", argv[1], name,
                       nearest.empty() ? "" : fmt::format(", nearest: {}", nearest));
  }
  return {};
}

// In one piece, so that lines of two programs do not mix, unless memory is short.
int failed(int code, std::string_view what) {
  echocine::endsFirst();
  try {
    echocine::writeError(fmt::format("echocine: {}\n", echocine::oneLine(what)));
  } catch (const std::bad_alloc&) {
    for (const std::string_view part : {std::string_view("echocine: "), what, {"\n"}})
      echocine::writeError(part);
  }
  return code;
}

int run(int argc, char** argv) {
  CLI::App app{"EchoCine: ultrasound cine loops of a beating heart, ray-traced from its meshes"};
  app.set_version_flag("--version", std::string("echocine ") + ECHOCINE_VERSION);
  app.require_subcommand(1);
  app.fallthrough(false);
  echocine::RenderCommand render(app);
  echocine::MModeCommand mmode(app);
  echocine::DopplerCommand doppler(app);
  echocine::ViewCommand view(app);
  echocine::PlanCommand plan(app);
  echocine::StudyCommand study(app);
  echocine::HeartCommand heart(app);
  echocine::CompareCommand compare(app);
  echocine::FitCommand fit(app);
  echocine::ExportCommand exporting(app);
  echocine::ArchiveCommand archive(app);
  echocine::DatasetCommand dataset(app);
  echocine::LiveCommand live(app);
  try {
    // For the build alone, so not among what help lists: man pages and completions.
    if (argc == 3 && std::string_view(argv[1]) == "--describe-into") {
      echocine::describeInto(argv[2], app);
      return 0;
    }
    app.parse(argc, argv);
    int code = 0;
    echocine::listenForStop();
    echocine::stoppable(echocine::stopWanted, [&] {
      code = app.got_subcommand("heart")     ? heart.run()
             : app.got_subcommand("mmode")   ? mmode.run()
             : app.got_subcommand("doppler") ? doppler.run()
             : app.got_subcommand("archive") ? archive.run()
             : app.got_subcommand("view")    ? view.run()
             : app.got_subcommand("plan")    ? plan.run()
             : app.got_subcommand("study")   ? study.run()
             : app.got_subcommand("compare") ? compare.run()
             : app.got_subcommand("fit")     ? fit.run()
             : app.got_subcommand("export")  ? exporting.run()
             : app.got_subcommand("dataset") ? dataset.run()
             : app.got_subcommand("live")    ? live.run()
                                             : render.run();
    });
    // A plan piped into a full disk has failed, though all was computed.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return failed(kJobFailed, "the output could not be written");
    return code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string wrong = misspelt(argc, argv, app);
    return failed(kUnusable, fmt::format("{} (--help lists what is accepted)",
                                         wrong.empty() ? error.what() : wrong));
  } catch (const echocine::SceneError& error) {
    return failed(kUnusable, error.what());
  } catch (const echocine::JobError& error) {
    return failed(kJobFailed, error.what());
  } catch (const std::bad_alloc&) {
    return failed(kJobFailed, echocine::kOutOfMemory);
  } catch (const std::exception& error) {
    return failed(kJobFailed, error.what());
  }
}

struct Call {
  int argc;
  char** argv;
  int code = kJobFailed;
};

void* runCall(void* call) {
  auto& c = *static_cast<Call*>(call);
  c.code = run(c.argc, c.argv);
  return nullptr;
}

// On a stack of our own: the one that the system gives may be of any size (ulimit -s), and the
// readers of hostile files recurse. Without it the program refuses: the system's stack counts as
// addresses only as it grows, and growth beyond their limit (ulimit -v) is a segmentation fault.
int runOnStack(Call call) {
  constexpr std::size_t kStackBytes = std::size_t{64} << 20;  // taken from memory only as used
  pthread_attr_t attributes;
  pthread_t thread;
  const bool begun = ::pthread_attr_init(&attributes) == 0 &&
                     ::pthread_attr_setstacksize(&attributes, kStackBytes) == 0 &&
                     ::pthread_create(&thread, &attributes, runCall, &call) == 0;
  if (!begun) return failed(kJobFailed, echocine::kOutOfMemory);
  ::pthread_join(thread, nullptr);
  return call.code;
}

}  // namespace

int main(int argc, char** argv) {
  echocine::keepStandardStreams();
  echocine::endCrashesInOneLine(kJobFailed);
  // A file-size limit must come back as an error of write(), not end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  return runOnStack({argc, argv});
}
