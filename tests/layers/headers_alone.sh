#!/bin/sh
# headers_alone.sh COMPILER FLAGS... -- HEADERS...: compiles each header as if it were all there is.
set -eu
compiler=$1
shift
flags=
while [ "$1" != -- ]; do
  flags="$flags $1"
  shift
done
shift
failed=0
for header in "$@"; do
  # shellcheck disable=SC2086  # flags are words
  if ! printf '#include "%s"\n' "$header" | "$compiler" -std=c++20 -fsyntax-only -Wall -Wextra \
      -Wshadow -Wconversion -Werror $flags -x c++ -; then
    echo "headers_alone: $header does not compile alone"
    failed=$((failed + 1))
  fi
done
echo "headers_alone: $failed of $# failed"
[ $# -gt 0 ] && [ "$failed" = 0 ]
