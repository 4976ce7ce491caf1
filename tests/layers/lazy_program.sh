#!/bin/sh
# lazy_program.sh loads|skips REGEX PROGRAM ARGUMENTS... OUTPUT: what the loader opened from start
# to end (LD_DEBUG=files), and that the run made its output.
set -eu
verdict=$1
regex=$2
shift 2
for output in "$@"; do :; done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
rm -f "$output"
LD_DEBUG=files LD_DEBUG_OUTPUT="$folder/ld" "$@"
[ -s "$output" ] || { echo "lazy_program: no $output"; exit 1; }
opened=$(cat "$folder"/ld.* | sed -n 's/.*file=\([^ ]*\) .*generating link map/\1/p' | sort -u)
found=$(echo "$opened" | grep -E "$regex" || true)
echo "lazy_program: $(echo "$opened" | wc -l) libraries opened; of $regex:" $found
echo "$opened" | grep -q 'libc\.so' || { echo "lazy_program: cannot see what is loaded"; exit 1; }
case $verdict in
  loads) [ -n "$found" ] ;;
  skips) [ -z "$found" ] ;;
esac
