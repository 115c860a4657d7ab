#!/usr/bin/env bash
# run.sh ARRIS SCREENSHOTS NAME — runs tests/web/NAME_test.js; CTest calls it.
# Exit 77, which CTest counts as skipped, if what it needs is not installed (scripts/install-deps.sh installs it).
set -euo pipefail
export ARRIS=$1 ARRIS_SCREENSHOTS=$2
name=$3
cd "$(dirname "$0")"

skip() {
  echo "tests/web is skipped: $1; scripts/install-deps.sh installs it"
  exit 77
}
command -v node >/dev/null || skip "node is missing"
if [ "$name" = server ] || [ "$name" = view ]; then
  CHROMIUM=$(command -v chromium) || skip "chromium is missing"
  export CHROMIUM
  [ -d node_modules/playwright-core ] || skip "playwright-core is missing"
fi
exec node --test --test-reporter=spec "${name}_test.js"
