#!/bin/sh
# Builds the benchmark and prints the README's table of ratios in Markdown. An idle machine gives the truest ones;
# those of two cores need it.
set -e
cd "$(dirname "$0")/../.."
cmake --preset release > /dev/null
cmake --build --preset release --target echocine_bench > /dev/null
build/release/echocine_bench --table --benchmark_filter='^(keyframes|volumes|slice|trace|beamAverage|logCompression|scanConversion|exr|exrKinds|jpeg|hierarchy|wholeFrame|withFiles)/'
