#!/usr/bin/env bash
# Sets up, builds and runs all tests: tests/run.sh [PRESET [CTEST OPTION...]], PRESET one of release (default), dev,
# coverage, clang, tsan.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -eq 0 ] || shift
bash .ci/setup.sh packages.txt test-packages.txt
cmake --preset "$preset"
cmake --build --preset "$preset"
[ "$preset" != coverage ] || find build/coverage -name '*.gcda' -delete
ctest --preset "$preset" -j "$(nproc)" "$@"
[ "$preset" != coverage ] ||
  gcovr --root . --filter src/ --filter motion/ --fail-under-line 90 -j "$(nproc)" build/coverage
