#!/usr/bin/env bash
# build.sh [TARGET...]: installs, configures and builds preset release (default: everything): the
# common part of demo.sh and test.sh.
# JOBS = parallel compilers (default: cores, but no more than 1.5 GiB of memory each).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if [ -n "${NEPHO_REAL_DATA:-}" ]; then  # before the change of folder: it may be relative
  NEPHO_REAL_DATA=$(cd "$NEPHO_REAL_DATA" && pwd)
fi
cd "$root"

default_jobs() {
  local cores by_memory
  cores=$(nproc)
  # A source that includes OpenVDB takes 650 MB to compile.
  by_memory=$(awk '/^MemAvailable/ { n = int($2 / 1572864); print n < 1 ? 1 : n }' /proc/meminfo)
  echo $((cores < by_memory ? cores : by_memory))
}

tools/install.sh

start_s=$SECONDS
# Set or not, it is handed over: a folder remembered from an earlier run would be a lie.
cmake --preset release -DNEPHO_REAL_DATA="${NEPHO_REAL_DATA:-}"
configured_s=$SECONDS
NINJA_STATUS='[%f/%t %e s] ' cmake --build --preset release -j "${JOBS:-$(default_jobs)}" \
  ${1:+--target "$@"}
echo "build: configured in $((configured_s - start_s)) s, built in $((SECONDS - configured_s)) s"
