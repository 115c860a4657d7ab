#!/usr/bin/env bash
# demo.sh — installs what is missing, builds Arris and renders examples/models to out/: each model
# with its edges rounded by the automatic radius, as `arris render MODEL -o PICTURE` does.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh
cmake --preset release
cmake --build --preset release --target arris_program
mkdir -p out
arris=build/release/arris
start=$SECONDS
"$arris" render examples/models/keypad.obj -o out/keypad.png
"$arris" render examples/models/keypad.obj --round none -o out/keypad_sharp.png
echo "demo.sh: rendered out/keypad.png and out/keypad_sharp.png in $((SECONDS - start)) s"
