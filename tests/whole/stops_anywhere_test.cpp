// Whenever SIGTERM comes, and whatever command runs, it ends soon and leaves nothing half-written.

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <ctime>
#include <memory>
#include <random>

#include "support/all_cases.h"
#include "support/faulty_run.h"
#include "support/loop_output.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

using namespace support;

#ifdef ECHOCINE_SANITIZED
constexpr double kMost_s = 15;
constexpr std::size_t kSectors = 1;
#else
constexpr double kMost_s = 1;
constexpr std::size_t kSectors = 2;
#endif

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Processor time of all children that have ended: a busy machine does not change it.
double usedByChildren_s() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Whether the process has asked for SIGTERM: before, the signal ends it as it ends any program.
bool listens(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
  return false;
}

struct Verb {
  std::string name;
  std::vector<std::string> arguments;  // OUT stands for where results go
  double seconds;                      // instants are drawn up to here
};

class StopsAnywhere : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<TempFolder>();
    run({"heart", "-o", at("paper"), "--look", "paper", "--keyframes", "6"});
    run({"heart", "-o", at("scanner"), "--keyframes", "6"});
    const auto changed = [](std::string text, const std::string& from, const std::string& to) {
      const std::size_t found = text.find(from);
      EXPECT_NE(found, std::string::npos) << from;
      return text.replace(found, from.size(), to);
    };
    std::string small = bytesOf(at("paper/scene.toml"));
    small = changed(small, "lines = 256", "lines = 64");
    small = changed(small, "samples = 1024", "samples = 256");
    small = changed(small, "frame_rate_hz = 50", "frame_rate_hz = 20");
    place->write("paper/small.toml", small);
    run({"render", at("paper/small.toml"), "-o", at("loop")});
    std::string spec =
        "name = \"stopped\"\nhearts = 2\nviews = [\"a4c\", \"a2c\"]\n"
        "layouts = [\"echonet\", \"camus\", \"native\", \"nnunet\"]\n" +
        bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml");
    place->write("spec.toml", spec);
    SceneText ball = ballScene(2);
    ball.probe["lines"] = "512";
    ball.probe["samples"] = "2048";
    ball.motion["subdivision"] = "2";
    ball.effects["refraction"] = "\"on\"";
    ball.accuracy["rays_per_beam"] = "64";
    writeBall(*place, ball);
  }
  static void TearDownTestSuite() { place.reset(); }

  static std::string at(const std::string& name) { return *place / name; }
  static void run(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--quiet", "--threads", "1"});
    const Outcome made = outcomeOf({arguments});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  static std::vector<Verb> verbs() {
    const std::string scanner = at("scanner/scene.toml"), paper = at("paper/small.toml"),
                      loop = at("loop"), cine = at("loop/cine.avi");
    return {
        {"render with speckle and truth",
         {"render", scanner, "-o", "OUT", "--frames", "0:4", "--truth", "all"},
         2},
        {"render of bent rays", {"render", at("scene.toml"), "-o", "OUT"}, 1},
        {"render within a tolerance",
         {"render", paper, "-o", "OUT", "--frames", "0:2", "--tolerance-db", "1"},
         2},
        {"plan", {"plan", scanner, "--page", "OUT/page.html"}, 2.5},
        {"plan of interpolations", {"plan", scanner, "--interpolation"}, 0.1},
        {"view", {"view", scanner, "-o", "OUT/page.html"}, 1.2},
        {"study",
         {"study", paper, "-o", "OUT", "--frames", "1", "--repeats", "1", "--knobs",
          "lines,samples,refraction"},
         2},
        {"dataset", {"dataset", at("spec.toml"), "-o", "OUT"}, 0.5},
        {"preview of a dataset",
         {"dataset", at("spec.toml"), "-o", "OUT/page.html", "--preview", "2"},
         0.5},
        {"compare", {"compare", loop, loop, "-o", "OUT", "--scene", paper, "--tilt", "4"}, 1},
        {"compare with hearts", {"compare", cine, "-o", "OUT", "--scan", "ef=0.4:0.6:0.1"}, 2},
        {"compare with views", {"compare", cine, "-o", "OUT", "--views", "a4c,plax"}, 2},
        {"fit",
         {"fit", "--no-cache", "--view", "a4c=" + cine, "--tilt", "0", "-o", "OUT", "--dials",
          "edv=130,wall-thickness=9,sphericity=0.6,mapse=13,conicity=0.7,apical-motion=1,rv-edv="
          "135"},
         8},
        {"heart", {"heart", "-o", "OUT/heart", "--keyframes", "24"}, 0.5},
    };
  }

  // Runs into a new folder. Where `instant_s` is not negative, SIGTERM comes once the run has used
  // so much processor time; returns what it used after that.
  double stop(const Verb& verb, double instant_s, Outcome& outcome) {
    out = place->path() / "out";
    fs::remove_all(out);
    fs::create_directory(out);
    FaultyRun asked{{}};
    for (std::string argument : verb.arguments) {
      if (argument.starts_with("OUT")) argument.replace(0, 3, out.string());
      asked.arguments.push_back(argument);
    }
    asked.arguments.insert(asked.arguments.end(), {"--quiet", "--threads", "1"});
    asked.limit_s = 1800;
    double at_signal_s = 0;
    if (instant_s >= 0)
      asked.meanwhile = [&](pid_t child) {
        for (bool ready = false;; ::usleep(1000)) {
          const double used_s = usedBy_s(child);
          if (used_s < 0) return;
          ready = ready || listens(child);
          if (!ready || used_s < instant_s) continue;
          ::kill(child, SIGTERM);
          at_signal_s = used_s;
          return;
        }
      };
    const double before_s = usedByChildren_s();
    outcome = outcomeOf(asked);
    return usedByChildren_s() - before_s - at_signal_s;
  }

  void expectNothingHalfWritten() const {
    for (const auto& [name, bytes] : leftIn(out)) {
      EXPECT_FALSE(name.ends_with(".part")) << name;
      EXPECT_EQ(name.find(".echocine-part"), std::string::npos) << name;
      const bool json = name.ends_with(".json") && name != "manifest.json";
      EXPECT_TRUE(!json || nlohmann::json::accept(bytes)) << name;
      EXPECT_TRUE(!name.ends_with(".avi") || cineFrames(out / name) > 0) << name;
    }
  }

  inline static std::unique_ptr<TempFolder> place;
  fs::path out;
};

// ECHOCINE_STOPS sets how many stops; from 50 on each command is timed whole before.
TEST_F(StopsAnywhere, EveryCommandEndsSoonAndLeavesWholeFiles) {
  const char* const wanted = std::getenv("ECHOCINE_STOPS");
  std::vector<Verb> all = verbs();
  const std::size_t stops = wanted ? std::strtoul(wanted, nullptr, 10) : all.size();
  Outcome outcome;
  if (stops >= 50)
    for (Verb& verb : all) {
      verb.seconds = stop(verb, -1, outcome);
      EXPECT_EQ(outcome.code, 0) << verb.name << ": " << outcome.err;
      std::printf("%-30s %.2f s\n", verb.name.c_str(), verb.seconds);
      std::fflush(stdout);  // a child would print it again
    }
  std::mt19937 random(29);
  std::map<std::string, double> longest_s;
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < stops; ++i) {
    const Verb& verb = all[i % all.size()];
    const double instant_s = std::uniform_real_distribution<double>(0, verb.seconds)(random);
    SCOPED_TRACE(verb.name + " after " + std::to_string(instant_s) + " s");
    const double more_s = stop(verb, instant_s, outcome);
    expectNothingHalfWritten();
    if (outcome.code == 0) continue;  // had ended
    ++stopped;
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
    // Only a dataset keeps hearts; a preview that is stopped leaves nothing.
    EXPECT_TRUE(verb.name == "dataset" || outcome.err.find("hearts are kept") == std::string::npos)
        << outcome.err;
    EXPECT_TRUE(!verb.name.starts_with("preview") || fs::is_empty(out));
    EXPECT_LT(more_s, kMost_s);
    longest_s[verb.name] = std::max(longest_s[verb.name], more_s);
  }
  EXPECT_GT(stopped, stops / 4);
  std::printf("%zu of %zu stopped\n", stopped, stops);
  for (const auto& [name, most_s] : longest_s)
    std::printf("%-30s at most %.3f s after the signal\n", name.c_str(), most_s);
}

// The sector is a metre wide, so its speckle is bounded: refused in one line, or made.
TEST_F(StopsAnywhere, ASectorFarFromItsApexTakesLittle) {
  SceneText text = ballScene(1);
  text.probe["kind"] = "\"curvilinear\"";
  text.probe["face_radius_mm"] = "1000";
  text.signal["look"] = "\"scanner\"";
  writeBall(*place, text);
  for (const std::string& per_cell : casesOf<std::string>({"0.1", "12"}, kSectors)) {
    text.extra = "[speckle]\nper_cell = " + per_cell + "\n";
    const fs::path scene = place->write("far.toml", text.text());
    const double before_s = usedByChildren_s();
    const Outcome outcome = renderScene(scene, *place / "far", "--threads 1");
    EXPECT_LT(usedByChildren_s() - before_s, 10 * kMost_s) << per_cell;
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 2) << outcome.err;
    if (outcome.code == 2) expectOneLine(outcome, 2);
    fs::remove_all(*place / "far");
  }
}

}  // namespace
}  // namespace echocine
