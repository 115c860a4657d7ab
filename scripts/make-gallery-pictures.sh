#!/usr/bin/env bash
# make-gallery-pictures.sh — renders the pictures of docs/rounding-gallery.md into docs/pictures/gallery/.
# Environment  ARRIS_SPP   samples per pixel, 48 by default; light is averaged up to edges
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release
cmake --build --preset release --target arris_program
arris=build/release/arris
pictures=docs/pictures/gallery
mkdir -p "$pictures"
models=$(mktemp -d)
trap 'rm -r "$models"' EXIT
python3 examples/gallery/make_models.py "$models"

row() { # NAME MODEL RADIUS TARGET POSITION FOV [OPTION…]
  local method
  for method in exact shader mesh:3; do
    "$arris" render "$models/$2.obj" -o "$pictures/$1_${method%:*}.jpg" --round "$3" --round-method "$method" \
      --camera-target "$4" --camera-position "$5" --fov "$6" --size 320x240 --spp "${ARRIS_SPP:-48}" --denoise edges \
      --material plastic-blue --quiet "${@:7}"
  done
  echo "$pictures/$1_*.jpg"
}

row box box 0.4 -0.2,0.2,-0.2 1.9,-2.7,1.8 32
row apex pyramid 0.25 0,0,-0.5 1.2,-2.8,1.2 32
row one_concave bracket 0.25 0.1,0,0 2,-2.6,1.7 32
row two_concave pocket 0.25 0,0,0.4 1.4,-1.9,2.3 34
row saddle saddle 0.3 0,0,0 1.2,-3.2,3.6 34
row boss boss 0.25 0.6,-0.6,0.25 2.4,-3.2,2 34
row hole hole 0.2 0,0.7,-0.2 0.6,-2.2,1.9 34
row too_large step 0.3 0,0.2,0 2,-2.5,1.5 32
row rib rib 0.25 0.2,-0.8,0.3 2.2,-3.8,2.6 34
row fillet_end bracket 0.25 0.1,0,0 2,-2.6,1.7 32 --round-edges both
row fillet_foot boss 0.25 0.6,-0.6,0.25 2.4,-3.2,2 34 --round-edges both

# Only the exact rounding has edges of several radii.
"$arris" render "$models/radii.toml" -o "$pictures/radii_exact.jpg" --camera-target 0.5,0.6,0.3 \
  --camera-position 4.2,-4.4,3.4 --fov 32 --size 480x320 --spp "${ARRIS_SPP:-48}" --denoise edges \
  --material plastic-blue --quiet
echo "$pictures/radii_exact.jpg"
