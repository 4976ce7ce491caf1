#!/bin/sh
# The nine settings of Mulen's Table 6.1 on the sample scenes: rewrites the tables of these scenes
# between the bench marks of docs/accuracy.md and their charts docs/images/pareto-*.svg. Needs
# build/release and the sample data (make_samples data-samples).
#   tools/update_bench.sh [SCENE...]   default: all of them
# His budgets of 8, 4 and 2 GiB at 2560x1440 are 2330, 1165 and 583 bytes a pixel; at 64x36 that is
# 5.12, 2.56 and 1.28 MiB. His steps of 0.1, 0.2 and 0.4 of half a node are 0.35, 0.7 and 1.4
# voxels. Refinement goes on until the budget is spent (pixels-per-voxel 0.05), as his does. Weather
# of a planet is drawn at 32x18: its references march from each place to the sun and the sky, through
# clouds that reach to the horizon. A procedural planet has no end of levels: 32 MiB are its depth.
set -eu
cd "$(dirname "$0")/.."
all="cumulus plume together les forecast globe planet_ground planet_12km planet_space"
[ $# -gt 0 ] || set -- $all
report=$(mktemp -d)
trap 'rm -rf "$report"' EXIT
for scene in "$@"; do
  size=64x36 budgets=5.12,2.56,1.28 host=256 paths=2048
  case $scene in
    forecast | globe | planet_*) size=32x18 budgets=1.28,0.64,0.32 paths=64 ;;
  esac
  # Over its hills a path takes more than 2 ms, half of it to find where it meets the ground: none.
  [ $scene = forecast ] && paths=0
  case $scene in planet_*) host=32 ;; esac
  # What the light model needs, where it can be had in minutes.
  case $scene in globe) paths=768 ;; planet_space) paths=2048 ;; esac
  build/release/bin/nephoscope bench "data-samples/scenes/$scene.json" --size $size \
    --sweep budget-mib=$budgets --sweep step=0.35,0.7,1.4 --sweep pixels-per-voxel=0.05 \
    --spp $paths --host-mib $host -o "$report/$scene"
  cp "$report/$scene/pareto.svg" "docs/images/pareto-$scene.svg"
  # Those of the scenes that are not asked for stay; all stand in the order above.
  awk -v new="$report/$scene/tables.md" -v scene="$scene" -v all="$all" '
    function flush(   n, i, names) {
      n = split(all, names, " ")
      while ((getline line < new) > 0) fresh = fresh line "\n"
      table[scene] = fresh
      for (i = 1; i <= n; ++i) if (names[i] in table) printf "%s", table[names[i]]
    }
    /^<!-- bench -->$/ { print; print ""; inside = 1; next }
    /^<!-- bench end -->$/ { flush(); inside = 0 }
    inside && /^### / { now = $2 }
    inside { if (now != "") table[now] = table[now] $0 "\n"; next }
    { print }' docs/accuracy.md >"$report/accuracy.md"
  cat "$report/accuracy.md" >docs/accuracy.md
done
times
