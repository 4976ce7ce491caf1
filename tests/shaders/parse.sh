#!/bin/sh
# parse.sh VALIDATOR DEFINES... -- SHADERS...: each shader alone (-l: it takes -D only when linking,
# and would link all the shaders of one call into one program).
set -eu
validator=$1
shift
defines=
while [ "$1" != -- ]; do
  defines="$defines $1"
  shift
done
shift
failed=0
for shader in "$@"; do
  # shellcheck disable=SC2086  # defines are words
  "$validator" -l $defines "$shader" || failed=$((failed + 1))
done
echo "parse: $failed of $# refused"
[ $# -gt 0 ] && [ "$failed" = 0 ]
