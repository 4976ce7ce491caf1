#!/bin/sh
# needed_libs.sh has|lacks REGEX FILES...: what the loader brings in with each file, by its own wish
# (readelf) and through its libraries (ldd). Every file must need the C library: an empty answer
# would prove nothing.
set -eu
verdict=$1
regex=$2
shift 2
failed=0
for file in "$@"; do
  needed=$(readelf -d "$file" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'; ldd "$file" | awk '{ print $1 }')
  found=$(echo "$needed" | grep -E "$regex" | sort -u || true)
  if ! echo "$needed" | grep -q '^libc\.so'; then
    echo "needed_libs: $file: no libc in: $needed"
    failed=1
  elif [ "$verdict" = lacks ] && [ -n "$found" ]; then
    echo "needed_libs: $file needs" $found
    failed=1
  elif [ "$verdict" = has ] && [ -z "$found" ]; then
    echo "needed_libs: $file does not need $regex: the test looks for the wrong name"
    failed=1
  else
    echo "needed_libs: $file: $(echo "$needed" | sort -u | wc -l) libraries, $verdict $regex"
  fi
done
exit $failed
