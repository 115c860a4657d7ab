#!/usr/bin/env bash
# fuzz-one.sh FUZZER — runs one libFuzzer program for a bounded time, from its seeds in
# tests/fuzz/seeds/<name>/ and with the words of tests/fuzz/<name>.dict (where there are some) and what
# earlier runs found.
# Environment  fuzz_seconds   8 by default
set -euo pipefail
cd "$(dirname "$0")/.."

name=$(basename "$1")
corpus=build/asan/corpus/$name
seeds=tests/fuzz/seeds/$name
mkdir -p "$corpus" build/asan/crashes
folders=("$corpus")
[ ! -d "$seeds" ] || folders+=("$seeds")
options=()
[ ! -f "tests/fuzz/$name.dict" ] || options+=("-dict=tests/fuzz/$name.dict")
log=build/asan/$name.log
if "$1" "${folders[@]}" "${options[@]}" -max_total_time="${fuzz_seconds:-8}" -timeout=10 -rss_limit_mb=2048 \
  -artifact_prefix="build/asan/crashes/$name-" >"$log" 2>&1 </dev/null; then
  echo "$name: $(tail -n 1 "$log")"
else
  echo "$name: FAILED, $log ends with:"
  tail -n 40 "$log"
  exit 1
fi
