// echocine_bench: Google Benchmark's own output, or with --table the README's table in Markdown.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace {

// Keeps the ratios of all runs by name and size.
class TableReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      for (const auto& [counter, value] : run.counters)
        values_[run.run_name.function_name + "/" + run.run_name.args + " " + counter] = value;
  }

  void print() const {
    fmt::print("| over its floor, triangles moving every frame | 5,000 | 50,000 | 500,000 |\n");
    fmt::print("|---|---|---|---|\n");
    const std::vector<std::string> triangles{"5000/256/1024", "50000/256/1024", "500000/256/1024"};
    row("blend of the keyframes", "keyframes", triangles);
    row("volumes of all structures", "volumes", triangles);
    row("plane slice and its lines", "slice", triangles);
    row("walk and samples, echoes at the lines", "trace/centres", triangles);
    row("walk and samples, echoes over cells", "trace/cells", triangles);
    row("whole frame without files, over the sum of its floors", "wholeFrame", triangles);
    row("whole frame, in bare passes of single rays", "wholeFrame", triangles, "over_single_rays");
    row("hierarchy, straight rays, over refit and packets", "hierarchy/straight", triangles);
    row("hierarchy, refraction, over refit and packets", "hierarchy/refraction", triangles);
    fmt::print("\n| over its floor, lines x samples | 128 x 512 | 256 x 1024 | 512 x 2048 |\n");
    fmt::print("|---|---|---|---|\n");
    const std::vector<std::string> planes{"5000/128/512", "5000/256/1024", "5000/512/2048"};
    row("average over beam and pulse", "beamAverage", planes);
    row("logarithm", "logCompression", planes);
    row("scan conversion", "scanConversion", planes);
    row("EXR, encoded, hashed and written", "exr", planes);
    row("JPEG and AVI", "jpeg", planes);
    fmt::print(
        "\n| EXR kinds over uncompressed floats | none | rle | zips | zip | piz | pxr24 |\n");
    fmt::print("|---|---|---|---|---|---|---|\n");
    for (const int half : {0, 1})
      for (const char* counter : {"over_floor", "size"}) {
        std::vector<std::string> kinds;
        for (int kind = 0; kind < 6; ++kind) kinds.push_back(fmt::format("{}/{}", kind, half));
        row(fmt::format("{}, {}", half ? "half" : "float",
                        counter[0] == 's' ? "size" : "time to encode and write"),
            "exrKinds", kinds, counter);
      }
    fmt::print("\n");
    single("whole frame with EXR and AVI over the floors' sum, one core",
           "withFiles/50000/256/1024", "over_floor");
    single("two cores over one", "withFiles/50000/256/1024", "two_cores");
    growth();
  }

 private:
  double value(const std::string& key) const {
    const auto found = values_.find(key);
    return found != values_.end() ? found->second : 0;
  }
  void row(const std::string& label, const std::string& name, const std::vector<std::string>& sizes,
           const char* counter = "over_floor") const {
    fmt::print("| {} |", label);
    for (const std::string& size : sizes)
      fmt::print(" {:.2g} |", value(name + "/" + size + " " + counter));
    fmt::print("\n");
  }
  void single(const char* label, const std::string& name, const char* counter) const {
    fmt::print("{}: {:.2f}\n", label, value(name + " " + counter));
  }
  // Of the whole frame's time, with the size.
  void growth() const {
    const auto ms = [&](const char* size) {
      return value(std::string("wholeFrame/") + size + " ours_ms");
    };
    fmt::print("500,000 triangles over 50,000: {:.2f}\n",
               ms("500000/256/1024") / ms("50000/256/1024"));
    fmt::print("twice the lines: {:.2f}, twice the samples: {:.2f}, both: {:.2f}\n",
               ms("50000/512/1024") / ms("50000/256/1024"),
               ms("50000/256/2048") / ms("50000/256/1024"),
               ms("50000/512/2048") / ms("50000/256/1024"));
  }

  std::map<std::string, double> values_;
};

}  // namespace

int main(int argc, char** argv) {
  bool table = false;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--table") == 0) {
      table = true;
      std::memmove(argv + i, argv + i + 1, sizeof(char*) * static_cast<std::size_t>(argc - i));
      --argc;
    }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  if (!table) {
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  }
  TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print();
  return 0;
}
