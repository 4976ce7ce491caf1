#!/bin/sh
# The nine settings of Mulen's Table 6.1 on the sample scenes: rewrites the tables between the bench
# marks of docs/accuracy.md and the charts docs/images/pareto-*.svg. Needs build/release and the
# sample data (make_samples data-samples).
#   tools/update_bench.sh [SCENE...]   default: cumulus plume les
# His budgets of 8, 4 and 2 GiB at 2560x1440 are 2330, 1165 and 583 bytes a pixel; at 64x36 that is
# 5.12, 2.56 and 1.28 MiB. His steps of 0.1, 0.2 and 0.4 of half a node are 0.35, 0.7 and 1.4
# voxels. Refinement goes on until the budget is spent (pixels-per-voxel 0.05), as his does.
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- cumulus plume les
report=$(mktemp -d)
trap 'rm -rf "$report"' EXIT
for scene in "$@"; do
  build/release/bin/nephoscope bench "data-samples/scenes/$scene.json" --size 64x36 \
    --sweep budget-mib=5.12,2.56,1.28 --sweep step=0.35,0.7,1.4 --sweep pixels-per-voxel=0.05 \
    --spp 1024 --exact-orders 2 --host-mib 256 -o "$report/$scene"
  cp "$report/$scene/pareto.svg" "docs/images/pareto-$scene.svg"
  cat "$report/$scene/tables.md" >>"$report/tables.md"
done
awk -v tables="$report/tables.md" '
  /^<!-- bench -->$/ { print; print ""; while ((getline line < tables) > 0) print line; skip = 1; next }
  /^<!-- bench end -->$/ { skip = 0 }
  !skip { print }' docs/accuracy.md >"$report/accuracy.md"
cat "$report/accuracy.md" >docs/accuracy.md
