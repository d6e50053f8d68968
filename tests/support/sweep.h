#pragma once
// Errors swept across a hard point: the worst one is held against a bound, and kept for the record.
//
// With the environment variable ECHOCINE_HARD_CASES set to a file, each sweep appends a row
// `case | oracle | points | worst error | bound` to it (Markdown) and writes its points into a
// folder beside it, named after the file, as CSV (hard/plot/sweep_files.h), which `sweep_plots`
// plots.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace echocine::support {

class Sweep {
 public:
  // `variable` is what add() calls `at`. Errors are relative to the expected value, or to `floor`
  // where that is smaller.
  Sweep(std::string name, std::string oracle, std::string variable, double bound, double floor = 0)
      : name_(std::move(name)),
        oracle_(std::move(oracle)),
        variable_(std::move(variable)),
        bound_(bound),
        floor_(floor) {}
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;
  ~Sweep() {
    EXPECT_FALSE(points_.empty()) << name_ << ": nothing was swept";
    EXPECT_LE(worst_.error, bound_) << name_ << " against " << oracle_ << ": at " << worst_.at
                                    << " it is " << worst_.got << " instead of " << worst_.expected;
    std::printf("%s: worst error %.2g of %.2g over %zu points\n", name_.c_str(), worst_.error,
                bound_, points_.size());
    if (const char* file = std::getenv("ECHOCINE_HARD_CASES")) record(file);
  }

  void add(long double at, long double got, long double expected) {
    Point point{static_cast<double>(at), static_cast<double>(got), static_cast<double>(expected),
                errorOf(got, expected)};
    points_.push_back(point);
    if (point.error > worst_.error) worst_ = point;
  }
  // An error that the test has measured itself, in the unit of the bound.
  void addError(double at, double error) {
    const double seen = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    points_.push_back({at, seen, 0, seen});
    if (seen > worst_.error) worst_ = points_.back();
  }

 private:
  struct Point {
    double at = 0, got = 0, expected = 0, error = 0;
  };

  double errorOf(long double got, long double expected) const {
    if (got == expected) return 0;
    const long double size = std::max(std::abs(expected), static_cast<long double>(floor_));
    const auto error = static_cast<double>(std::abs(got - expected) / size);
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
  }

  void record(const std::filesystem::path& file) const {
    char row[512];
    std::snprintf(row, sizeof row, "| %s | %s | %zu | %.1e | %.0e |\n", name_.c_str(),
                  oracle_.c_str(), points_.size(), worst_.error, bound_);
    appendRow(file, row);
    const std::filesystem::path folder = file.parent_path() / file.stem();
    std::filesystem::create_directories(folder);
    std::string slug = name_;
    for (char& c : slug)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    std::ofstream out(folder / (slug + ".csv"));
    out.precision(17);
    out << "# case: " << name_ << "\n# against: " << oracle_ << "\n# variable: " << variable_
        << "\n# bound: " << bound_ << "\nat,got,expected,error\n";
    for (const Point& p : points_)
      out << p.at << ',' << p.got << ',' << p.expected << ',' << p.error << '\n';
  }

  // Tests may run side by side: the first one to make the file writes its head.
  static void appendRow(const std::filesystem::path& file, const std::string& row) {
    const std::string head =
        "| case | oracle | points | worst error | bound |\n| --- | --- | --- | --- | --- |\n";
    const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0644);
    if (made >= 0) {
      EXPECT_EQ(::write(made, head.data(), head.size()), static_cast<ssize_t>(head.size()));
      ::close(made);
    }
    const int out = ::open(file.c_str(), O_WRONLY | O_APPEND);
    EXPECT_EQ(::write(out, row.data(), row.size()), static_cast<ssize_t>(row.size()));
    ::close(out);
  }

  std::string name_, oracle_, variable_;
  double bound_, floor_;
  Point worst_;
  std::vector<Point> points_;
};

// The variable of a sweep over the tracers (support/world.h).
inline constexpr const char* kOfTracer = "tracer: 0 slice, 1 cells, 2 hierarchy";

// A double with its neighbours, `ulps` on each side.
inline std::vector<double> ulpsAround(double x, int ulps) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> all{x};
  for (double up = x, down = x; ulps-- > 0;) {
    all.push_back(up = std::nextafter(up, kFar));
    all.push_back(down = std::nextafter(down, -kFar));
  }
  return all;
}

// From lo to hi in equal ratios, ends included.
inline std::vector<double> decades(double lo, double hi, int count) {
  std::vector<double> all;
  for (int i = 0; i < count; ++i)
    all.push_back(lo * std::pow(hi / lo, static_cast<double>(i) / (count - 1)));
  return all;
}

}  // namespace echocine::support
