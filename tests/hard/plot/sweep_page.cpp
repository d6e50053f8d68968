#include "sweep_page.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "page/page.h"

namespace echocine {

namespace {

constexpr std::size_t kMostPoints = 2000;  // of a plot: more than it has pixels

std::string textOf(const char* file) {
  std::ifstream in(std::filesystem::path(ECHOCINE_SWEEP_PAGE_DIR) / file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void writeSweepPage(const std::vector<HardCaseSweep>& sweeps, const std::filesystem::path& path) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const HardCaseSweep& sweep : sweeps) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const SweepPoint& p : thinned(sweep.points, kMostPoints))
      points.push_back({p.at, p.error});  // an infinite error becomes null
    const SweepPoint worst = sweep.worst();
    list.push_back({{"file", sweep.file},
                    {"case", sweep.name},
                    {"against", sweep.oracle},
                    {"variable", sweep.variable},
                    {"bound", sweep.bound},
                    {"count", sweep.points.size()},
                    {"worst", worst.error},
                    {"worst_at", worst.at},
                    {"within", worst.error <= sweep.bound},
                    {"points", std::move(points)}});
  }
  const std::string body = textOf("sweeps.html"), script = textOf("sweeps.js");
  writePage(path, pageLook("EchoCine: hard cases", body, script),
            {{"version", ECHOCINE_VERSION}, {"sweeps", std::move(list)}});
}

}  // namespace echocine
