#!/usr/bin/env bash
# test.sh — installs what is missing, builds the release preset and runs every test.
# The last line says how many passed and failed. Arguments go to ctest: scripts/test.sh -R rounding
#
# Environment  ARRIS_BATCHES   ON: sources are compiled in batches, which takes half the time from scratch
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh
cmake --preset release ${ARRIS_BATCHES:+"-DARRIS_BATCHES=$ARRIS_BATCHES"}
cmake --build --preset release
results=$PWD/build/release/test-results.xml
status=0
ctest --preset release --parallel "$(nproc)" --output-junit "$results" "$@" || status=$?

python3 - "$results" <<'PYTHON'
import sys
import xml.etree.ElementTree as tree
suite = tree.parse(sys.argv[1]).getroot()
total, failed, skipped = (int(suite.get(key)) for key in ("tests", "failures", "skipped"))
print(f"test.sh: {total - failed - skipped} passed, {failed} failed, {skipped} skipped")
PYTHON
exit "$status"
