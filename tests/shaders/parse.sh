#!/bin/sh
# parse.sh VALIDATOR FOLDER PROGRAM RENDER_ARGUMENTS...: draws something small, takes the switches
# that the program says it compiled its shaders with, and has every shader in FOLDER parsed with
# them. A driver may take what the language forbids; the validator does not.
set -eu
validator=$1
folder=$2
shift 2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$@" --size 16x9 --probe-pixels 0 --explain-macros -o "$scratch/picture.pfm" >"$scratch/said"
sed -n 's/^macro: /#define NEPHO_/p' "$scratch/said" >"$scratch/switches"
[ -s "$scratch/switches" ] || { echo "parse: the program names no switches"; exit 1; }
failed=0
count=0
for shader in "$folder"/*.comp; do
  name=$(basename "$shader")
  # LIT says that there are light tiles to read: not while they are made, nor in a planet's passes,
  # which other scenes never compile.
  drop=NEPHO_LIT
  extra=
  case $name in
    view.comp) drop=nothing extra=NEPHO_SEEN_DEPTH ;;  # what a view that moves asks for
    light_*) ;;
    sun_map.comp) grep -q NEPHO_SUN_MAP "$scratch/switches" || continue ;;
    ground.comp | surface.comp) grep -q NEPHO_GROUND "$scratch/switches" || continue ;;
    *) drop=nothing ;;
  esac
  { sed -n 1p "$shader"; grep -v " $drop " "$scratch/switches"; sed 1d "$shader"; } >"$scratch/$name"
  "$validator" "$scratch/$name" || failed=$((failed + 1))
  count=$((count + 1))
  [ -n "$extra" ] || continue
  sed "1a #define $extra 1" "$scratch/$name" >"$scratch/$extra.comp"
  "$validator" "$scratch/$extra.comp" || failed=$((failed + 1))
  count=$((count + 1))
done
echo "parse: $failed of $count refused, with" $(sed 's/#define NEPHO_//' "$scratch/switches" |
  grep -v EACH)
[ "$count" -gt 0 ] && [ "$failed" = 0 ]
