#!/usr/bin/env bash
# demo.sh — installs what is missing, builds Arris and renders examples/models/keypad.obj to out/, once
# with its edges rounded, as `arris render keypad.obj -o keypad.png` does, and once as the mesh is.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh
cmake --preset release
cmake --build --preset release --target arris_program
mkdir -p out
start=$SECONDS
build/release/arris render examples/models/keypad.obj -o out/keypad.png --spp 32
build/release/arris render examples/models/keypad.obj -o out/keypad_sharp.png --spp 32 --round none
echo "demo.sh: rendered out/keypad.png and out/keypad_sharp.png in $((SECONDS - start)) s"
