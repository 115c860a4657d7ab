#!/usr/bin/env bash
# check-examples.sh — the examples do what they say: the models are what their script writes, each model
# and scene renders, in beams, too, and the host renderer, built on the installed package in build/check/prefix, keeps
# every path out of its solids and fillets, and writes pictures.
set -euo pipefail
cd "$(dirname "$0")/.."

arris=$PWD/build/release/arris
out=$PWD/build/check/examples
rm -rf "$out"
mkdir -p "$out/models" "$out/beam"

cp examples/models/make_models.py "$out/models"
python3 "$out/models/make_models.py"
python3 examples/beam/make_scenes.py "$out/beam"
for made in "$out"/{models,beam}/*; do
  cmp "$made" "examples/$(basename "$(dirname "$made")")/$(basename "$made")"
done

inputs=(examples/models/*.{stl,obj} examples/scenes/*.toml examples/csg/*.csg)
if command -v openscad >/dev/null; then
  inputs+=(examples/csg/*.scad)
else
  echo "examples/csg/*.scad are left out: openscad is not installed"
fi
for input in "${inputs[@]}"; do
  echo "$input"
  "$arris" info "$input" >"$out/info.txt"
  "$arris" render "$input" -o "$out/$(basename "$input").png" --size 160x90 --spp 2 --quiet
done
for input in examples/beam/*.toml examples/csg/*.csg examples/models/*.{stl,obj}; do
  echo "$input, in beams"
  "$arris" render "$input" --integrator beam -o "$out/$(basename "$input").beam.png" --size 160x90 --spp 2 \
    --aov coverage_lo,coverage_hi,uncertified,regions --quiet
done

cmake -S examples/host_renderer -B build/check/host_renderer -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$PWD/build/check/prefix"
cmake --build build/check/host_renderer
for edges in convex concave both; do
  for radius in 0.001 0.08 0.2; do
    build/check/host_renderer/host_renderer --furnace "$radius" --edges "$edges"
  done
  build/check/host_renderer/host_renderer --furnace 0.05 --edges "$edges" --vary
  build/check/host_renderer/host_renderer "$out/host-$edges.ppm" 0.08 320 4 --edges "$edges"
  [ "$(stat --format=%s "$out/host-$edges.ppm")" -eq $((320 * 180 * 3 + 15)) ]
done
# Fillets are seen, and change little else: each pixel has random numbers of its own.
changed=$(cmp -l "$out/host-convex.ppm" "$out/host-both.ppm" | wc -l) || true
[ "$changed" -gt 1000 ] && [ "$changed" -lt $((320 * 180 * 3 / 10)) ]
