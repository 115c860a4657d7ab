#!/usr/bin/env bash
# install-deps.sh — installs the Debian 12 packages that Arris is built, tested and checked with, and Playwright-core
# for the tests in a browser. Does nothing, and asks no server, when all of them are there. As root or through sudo.
set -euo pipefail

packages=(
  # build
  g++ cmake ninja-build ccache git python3
  # checks: clang-tidy, clang-format, libFuzzer and its sanitizers
  clang clang-tidy clang-format libclang-rt-14-dev
  # ray kernels, threads, vector instructions
  libembree-dev libtbb-dev libhwy-dev
  # pictures
  libopenexr-dev libpng-dev libturbojpeg0-dev libstb-dev
  # STEP: Open CASCADE, with all that it brings
  libocct-data-exchange-dev
  # models, scenes, JSON
  nlohmann-json3-dev
  # geometry
  libqhull-dev
  # the viewer: HTTP and WebSocket
  libboost-dev
  # command line, text, log
  libcli11-dev libfmt-dev libspdlog-dev
  # tests
  libgtest-dev libgmock-dev librapidcheck-dev
)
# What tests/web needs. Programs rather than packages, because they often come from elsewhere.
for program in node:nodejs npm:npm chromium:chromium; do
  command -v "${program%%:*}" >/dev/null || packages+=("${program##*:}")
done

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done

# Playwright-core, which drives the browser; npm leaves a copy of the lock file beside what it has installed.
install_web_tests() {
  local folder
  folder=$(dirname "$0")/../tests/web
  [ ! "$folder/package-lock.json" -nt "$folder/node_modules/.package-lock.json" ] && return
  echo "install-deps: installing what tests/web needs"
  # All else can be built and tested without it.
  if npm ci --prefix "$folder" --ignore-scripts --no-audit --no-fund; then
    touch "$folder/node_modules/.package-lock.json"
  else
    echo "install-deps: npm could not install playwright-core; the tests in a browser will be skipped" >&2
  fi
}

if [ ${#missing[@]} -eq 0 ]; then
  install_web_tests
  echo "install-deps: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install-deps: missing ${missing[*]}; run this as root, or install sudo" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "install-deps: installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -q -y --no-install-recommends "${missing[@]}"
install_web_tests
