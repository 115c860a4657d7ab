#!/usr/bin/env bash
# check-examples.sh — every model and scene in examples/ loads: `arris info` of each.
set -euo pipefail
cd "$(dirname "$0")/.."

build/release/arris --version
