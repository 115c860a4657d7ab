#!/usr/bin/env bash
# make-docs-pictures.sh — renders the pictures of README.md and docs/ into docs/pictures/.
# Environment  ARRIS_SPP   samples per pixel, 256 by default
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release
cmake --build --preset release --target arris_program
arris=build/release/arris
pictures=docs/pictures
spp=${ARRIS_SPP:-256}
mkdir -p "$pictures"

render() { # INPUT PICTURE [OPTION…]
  "$arris" render "$1" -o "$pictures/$2" --spp "$spp" --quiet "${@:3}"
  echo "$pictures/$2"
}

render examples/models/keypad.obj keypad.jpg --size 1280x720
render examples/models/keypad.obj keypad_sharp.jpg --size 1280x720 --round none
render examples/models/dice.stl dice.jpg --size 960x540
render examples/models/arch.obj arch.jpg --size 960x540 --lighting sky
render examples/csg/bearing_block.csg bearing_block.jpg --size 960x540
render examples/scenes/bevel_shader.toml bevel_shader.jpg
render examples/scenes/cornell_box.toml cornell_box.jpg

# The second frame of a view.
frame_of() { # INPUT PICTURE [OPTION…]
  local made
  made=$(mktemp -d)
  "$arris" render "$1" --frames 0..2 -o "$made/#.jpg" --quiet "${@:3}"
  mv "$made/1.jpg" "$pictures/$2"
  echo "$pictures/$2"
  if [ -e "$made/1.edges.png" ]; then mv "$made/1.edges.png" "$pictures/${2%.jpg}_classes.png"; fi
  rm -r "$made"
}

# Its points are a fifth of the pixels; its edges are those of shadows, too.
points=(--integrator edge-point --trace-below 0 --point-paths 64 --density 0.001)
frame_of examples/scenes/trellis.toml trellis.jpg "${points[@]}" --aov edges
frame_of examples/scenes/trellis.toml trellis_without_edges.jpg "${points[@]}" --edges off
frame_of examples/scenes/trellis.toml trellis_traced.jpg --spp "$spp"

# The viewer, where a browser and what tests/web needs are installed.
if [ -d tests/web/node_modules ]; then node tests/web/pictures.js; fi
