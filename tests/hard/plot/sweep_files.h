#pragma once
// Errors swept across a hard point, as the tests record them (ECHOCINE_HARD_CASES): one CSV file a
// sweep,
//   # case: critical angle: R
//   # against: long double
//   # variable: cos_i / cos_c - 1
//   # bound: 1e-05
//   at,got,expected,error
//   1e-16,1,1,0
//   ...

#include <filesystem>
#include <string>
#include <vector>

namespace echocine {

struct SweepPoint {
  double at = 0, error = 0;  // error: 0 or more, infinite where there was no number
};

struct HardCaseSweep {
  std::string file;  // name without folders
  std::string name, oracle, variable;
  double bound = 0;
  std::vector<SweepPoint> points;  // by `at`

  SweepPoint worst() const;
};

// All *.csv of the folder, by name. Throws SceneError with file and line of what is no such sweep,
// and when there is none.
std::vector<HardCaseSweep> readSweeps(const std::filesystem::path& folder);

// At most `count` of the points: the worst of each run of neighbours, so that no spike is lost.
std::vector<SweepPoint> thinned(const std::vector<SweepPoint>& points, std::size_t count);

}  // namespace echocine
