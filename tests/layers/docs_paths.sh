#!/bin/sh
# docs_paths.sh ROOT: every path of the tree that README.md and docs/*.md name in backquotes exists.
set -eu
cd "$1"
failed=0
count=0
for page in README.md docs/*.md; do
  paths=$(grep -oE '`[^`]+`' "$page" | tr -d '`' | tr ' ,' '\n\n' |
    grep -E '^(formats|ingest|render|tools|tests|docs|cmake|data-samples|\.ci)/' | sort -u || true)
  for path in $paths; do
    count=$((count + 1))
    # shellcheck disable=SC2086  # ingest/sources/* is meant as a pattern
    if ! ls -d $path >/dev/null 2>&1; then
      echo "docs_paths: $page names $path, which does not exist"
      failed=1
    fi
  done
done
echo "docs_paths: $count paths"
[ "$count" -gt 0 ] && exit $failed
