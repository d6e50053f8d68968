#!/usr/bin/env bash
# Sets up, builds and renders the shipped beating heart: examples/run.sh [FOLDER], FOLDER out/beating_heart if left out.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-out/beating_heart}
bash .ci/setup.sh
cmake --preset release
cmake --build --preset release --target echocine
build/release/echocine render examples/beating_heart/scene.toml -o "$folder"
echo "The cine loop is $folder/cine.avi, its intensities are in $folder/intensity/."
