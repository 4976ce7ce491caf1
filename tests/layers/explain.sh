#!/bin/sh
# explain.sh free|planet PROGRAM RENDER_ARGUMENTS...: what --explain says that a scene loaded,
# allocated, ran and left out. `free`: a cloud in free space asks for no planet, no tables of air, no
# second channel, no NetCDF. `planet` is the control: the same words are there where they belong.
set -eu
kind=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$@" --size 32x18 --probe-pixels 0 --explain -o "$scratch/p.pfm" >"$scratch/said"
part() { sed -n "/^$1/,/^[^ ]/p" "$scratch/said" | sed '$d'; }
fail() { cat "$scratch/said"; echo "explain: $1"; exit 1; }
for title in 'modules loaded' 'libraries that the scene' 'passes (CPU)' 'shader switches'; do
  [ "$(part "$title" | wc -l)" -gt 1 ] || fail "says nothing of '$title'"
done
planet=$(part 'passes (CPU)' | grep -cE '^  (ground|air|air tables|sun map) ' || true)
switches=$(part 'shader switches' | grep -cE '^  (GROUND|AIR|SUN_MAP|ICE)\b' || true)
bytes=$(sed -n 's/.* planet \([0-9.]*\) MiB.*/\1/p' "$scratch/said")
[ -n "$bytes" ] || fail 'says nothing of the bytes of a planet'
case $kind in
  free)
    [ "$planet" = 0 ] || fail 'ran a pass of the planet'
    [ "$switches" = 0 ] || fail 'compiled a planet or a second channel'
    [ "$bytes" = 0.00 ] || fail "holds $bytes MiB of a planet"
    part 'libraries that the scene' | grep -qE 'netcdf|hdf5|eccodes|openvdb|OpenImageIO|gdal' &&
      fail 'loaded a library of data'
    grep -q '^  air and ground: the scene is on no planet$' "$scratch/said" || fail 'names no planet'
    grep -q '^  the second channel: no volume tells ice apart' "$scratch/said" || fail 'names no second channel'
    ;;
  planet)
    [ "$planet" -gt 0 ] || fail 'ran no pass of the planet: the names are stale'
    [ "$switches" -gt 1 ] || fail 'compiled no planet: the names are stale'
    [ "$bytes" != 0.00 ] || fail 'holds nothing of a planet'
    ;;
esac
if grep -q 'EACH_' "$scratch/said"; then fail 'shows the loops that are written out'; fi
