// Plots the sweeps across hard cases that the tests wrote (ECHOCINE_HARD_CASES) on one page:
//   sweep_plots FOLDER OUTPUT_FOLDER

#include <cstdio>
#include <exception>

#include "core/error.h"
#include "core/file.h"
#include "sweep_page.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("sweep_plots: accepted: FOLDER OUTPUT_FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::vector<echocine::HardCaseSweep> sweeps = echocine::readSweeps(argv[1]);
    echocine::makeFolder(argv[2]);
    echocine::writeSweepPage(sweeps, std::filesystem::path(argv[2]) / "sweeps.html");
  } catch (const echocine::SceneError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
