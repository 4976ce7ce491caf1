#!/bin/sh
# Runs the stability rows of a build folder (default build/release), and the mutants that hold their
# naive forms, and rewrites the tables of docs/stability.md from tests/stability/rows.table and from
# what they measured. With --check: says whether the page agrees with the table (its numbers stay).
set -eu
cd "$(dirname "$0")/.."
table=tests/stability/rows.table
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
: > "$out/beside"
: > "$out/live"
: > "$out/naive"
check=0
if [ "${1:-}" = --check ]; then
  check=1
else
  build=${1:-build/release}
  NEPHO_STABILITY_OUT=$out/beside NEPHO_ACCURACY_OUT=$out/live \
    ctest --test-dir "$build" --output-on-failure -R '^stability\.[0-9L]'
  # Each row with a mutant: its program, run for what it measures, not for how it ends.
  awk '$1 == "shown" { filter = $3 } $1 == "mutant" { print $2, filter }' "$table" | sort -u |
    while read -r mutant filter; do
      : > "$out/one"
      NEPHO_ACCURACY_OUT=$out/one "$build/tests/$mutant" --gtest_filter="$filter" \
        > "$out/log" 2>&1 || true
      sed "s/^/$mutant	/" "$out/one" >> "$out/naive"
    done
fi
LC_ALL=C awk -v check=$check -f tools/stability_page.awk "$table" kind=beside "$out/beside" \
  kind=live "$out/live" kind=naive "$out/naive" kind=page docs/stability.md > "$out/page"
if [ $check = 1 ]; then
  diff docs/stability.md "$out/page" ||
    { echo "docs/stability.md is not what $table says: run tools/update_stability.sh"; exit 1; }
else
  cat "$out/page" > docs/stability.md
fi
