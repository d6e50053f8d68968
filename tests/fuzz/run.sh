#!/usr/bin/env bash
# Runs the fuzzers of the preset `dev`, which must be built: tests/fuzz/run.sh [SECONDS [TARGET...]]
# Without SECONDS a short run that is the same every time; with SECONDS each target gets that long,
# begins where its last long run ended (build/dev/fuzz/corpus), and leaves what breaks it in
# build/dev/fuzz/findings.
set -euo pipefail
cd "$(dirname "$0")"
build=../../build/dev
work=$build/fuzz
seconds=${1:-}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(ecg exr folder lid npz obj off ply record request scene spec stl video zarr)

# A file of a hundred bytes must not cost gigabytes. A library that asks for memory and takes no for an answer gets
# none over 256 MB; one that does not, or more than 1 GB in all, is a finding. ASan's quarantine would count as held.
limits=(-malloc_limit_mb=257 -rss_limit_mb=1024 -timeout=20 -max_len=4096)
export ASAN_OPTIONS=quarantine_size_mb=16:max_allocation_size_mb=256:allocator_may_return_null=1
[ ! -d /dev/shm ] || export TMPDIR=/dev/shm  # for readers that take a path
mkdir -p "$work/findings"

# Targets run side by side, each in a process of this script.
if [ ${#targets[@]} -gt 1 ]; then
  printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -n 1 ./run.sh "$seconds"
  exit
fi

target=${targets[0]}
dictionary=()
runs=5000
case $target in
  ecg) runs=500 ;;  # each run reads a loop of pictures
  scene | spec) dictionary=(-dict=toml.dict) ;;
  video) limits+=(-max_len=16384 -rss_limit_mb=2048) ;;
  lid | obj | off | ply | stl) dictionary=(-dict=mesh.dict) ;;
esac
if [ -n "$seconds" ]; then
  mkdir -p "$work/corpus/$target"
  folders=("$work/corpus/$target" "corpus/$target")
  length=(-max_total_time="$seconds" -print_final_stats=1)
else
  rm -rf "$work/short/$target"
  mkdir -p "$work/short/$target"
  folders=("$work/short/$target" "corpus/$target")
  length=(-runs=$runs -seed=1)
fi
log=$work/$target.log
if ! ECHOCINE_FUZZ_TARGET=$target "$build/fuzzer" "${limits[@]}" "${dictionary[@]}" "${length[@]}" \
  -artifact_prefix="$work/findings/$target-" "${folders[@]}" 2>"$log"; then
  tail -n 60 "$log" >&2
  exit 1
fi
echo "fuzz $target: $(grep -E '^#[0-9]+.*DONE' "$log" | tail -n 1)"
