#!/usr/bin/env bash
# Sets up, builds and runs all tests: tests/run.sh [PRESET], PRESET one of release (default), dev, clang.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
bash .ci/setup.sh packages.txt test-packages.txt
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"
