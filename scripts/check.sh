#!/usr/bin/env bash
# check.sh — everything besides the tests that must hold: format, clang-tidy, include arrows, tests
# under sanitizers, bounded fuzzing, the installed package and the examples built on it.
# Goes on after a failure and exits 1 if any step failed. Logs: build/check/STEP.log
#
# Usage        scripts/check.sh [STEP…]     all steps by default
# Environment  ARRIS_FUZZ_SECONDS           time for each fuzzer, 8 by default
#              ARRIS_TIDY_SECONDS           time limit of clang-tidy, 1800 by default
set -uo pipefail
cd "$(dirname "$0")/.."

logs=$PWD/build/check
jobs=$(nproc)
fuzz_seconds=${ARRIS_FUZZ_SECONDS:-8}
steps=(dependencies release format includes tidy asan tsan fuzz install examples)

step_dependencies() { scripts/install-deps.sh; }

step_release() {
  cmake --preset release
  cmake --build --preset release
}

step_format() {
  git ls-files -z --cached --others --exclude-standard '*.h' '*.cpp' |
    xargs -0 clang-format --dry-run -Werror
}

step_includes() {
  scripts/check-includes.py --self-test
  scripts/check-includes.py
}

step_tidy() { scripts/tidy.py; }

# Built by clang, whose warnings are errors here. Without statistics, which are about numbers and shoot a million rays
# each, and without the browser, whose tests send what tests/view sends.
step_asan() {
  local statistics='samples_follow_their_pdf|sampled_irradiance_is_what_is_seen'
  statistics+='|shares_of_what_.*_hold_what_rays_find|agree_with_the_balls'
  statistics+='|takes_away_nothing_but_edges|where_a_ball_fits|rays_from_inside_leave|settled_as_all_others'
  statistics+='|same_from_all_sides|what_rays_find|converges_to_the_path|halve_the_error|volume_of_their_solid'
  cmake --preset asan
  cmake --build --preset asan
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 \
    ctest --preset asan --parallel "$jobs" -E "^web\\.|$statistics"
}

# The modules that start threads; the rest of the tests would find nothing here. What must be done in a
# given time is not: everything is ten times slower. Nor what only sends many rays at one thing, or makes many frames.
step_tsan() {
  local threaded='base|render'
  local many_rays='VoidNeighborsOf|Furnace|csg_edges|csg_shadows|rounded_scene|rounded_shadow|closed_form|\.trace\.'
  many_rays+='|converges_to_the_path|edges_halve_the_error|rounded_outlines|glass_agrees|agree_with_the_path'
  many_rays+='|agrees_with_the_path|mis\.strategies|tends_to_the_path|grooves_are_hollow'
  cmake --preset tsan
  cmake --build --preset tsan --target test_base test_render
  TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp:halt_on_error=1:second_deadlock_stack=1" \
    ctest --preset tsan --parallel "$jobs" -R "^($threaded)\\." -E "time_limit|$many_rays" \
    --no-tests=error
}

# With the library that step asan has built.
step_fuzz() {
  cmake --preset asan
  cmake --build --preset asan --target fuzzers
  local fuzzers=(build/asan/*_fuzz)
  [ -x "${fuzzers[0]}" ] || { echo "no fuzzers were built"; return 1; }
  export fuzz_seconds
  printf '%s\0' "${fuzzers[@]}" | xargs -0 -n 1 -P "$jobs" scripts/fuzz-one.sh
}

step_install() {
  rm -rf build/check/prefix build/check/find_package
  cmake --install build/release --prefix build/check/prefix
  cmake -S examples/find_package -B build/check/find_package -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$PWD/build/check/prefix"
  cmake --build build/check/find_package
  build/check/find_package/rounded_box
  build/check/prefix/bin/arris --version
}

step_examples() {
  scripts/check-examples.sh
}

run_step() {
  local name=$1 start=$SECONDS status
  printf 'check: %-12s ' "$name"
  (
    set -e
    "step_$name"
  ) >"$logs/$name.log" 2>&1 </dev/null
  status=$?
  if [ $status -eq 0 ]; then
    printf 'passed %4d s\n' $((SECONDS - start))
  else
    printf 'FAILED %4d s, build/check/%s.log ends with:\n' $((SECONDS - start)) "$name"
    tail -n 60 "$logs/$name.log" | sed 's/^/    /'
    failed+=("$name")
  fi
}

mkdir -p "$logs"
failed=()
selected=("$@")
[ $# -gt 0 ] || selected=("${steps[@]}")
for name in "${selected[@]}"; do
  if ! declare -F "step_$name" >/dev/null; then
    echo "check.sh: no step \"$name\"; there are: ${steps[*]}" >&2
    exit 2
  fi
done
for name in "${selected[@]}"; do
  run_step "$name"
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "check.sh: ${#failed[@]} of ${#selected[@]} steps failed after $SECONDS s: ${failed[*]}"
  exit 1
fi
echo "check.sh: all ${#selected[@]} steps passed after $SECONDS s"
