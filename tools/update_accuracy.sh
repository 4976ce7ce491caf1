#!/bin/sh
# Runs the tests of a build folder (default build/release) and rewrites the tables of
# docs/accuracy.md from what they measured. Further arguments go to ctest: -L unit, -R chart, ...
# Rows that this run did not measure stay; to drop a stale one, delete its line first.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
[ $# -gt 0 ] && shift
rows=$(mktemp)
trap 'rm -f "$rows" "$rows.md"' EXIT
NEPHO_ACCURACY_OUT=$rows ctest --test-dir "$build" --output-on-failure -LE 'mutant|slow' "$@"
LC_ALL=C awk -f tools/accuracy_tables.awk "$rows" docs/accuracy.md > "$rows.md"
cat "$rows.md" > docs/accuracy.md
