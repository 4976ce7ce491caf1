#!/usr/bin/env bash
# Builds preset release and runs its tests, from a bare Debian 12 on (root or sudo).
# NEPHO_REAL_DATA = a folder of real files adds the tests that read them; JOBS = parallel jobs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
start_s=$SECONDS
"$root/tools/build.sh"
cd "$root"

mutants=$(ctest --test-dir build/release -N -L '^mutant$' | sed -n 's/^Total Tests: //p')
if [ -n "${NEPHO_REAL_DATA:-}" ]; then
  echo "test: real files from $NEPHO_REAL_DATA"
else
  echo "test: NEPHO_REAL_DATA is not set: synthetic twins only"
fi
echo "test: $mutants planted mistakes are among the tests and must be caught"
status=0
ctest --preset release --no-tests=error -j "${JOBS:-$(nproc)}" || status=$?
echo "test: $((SECONDS - start_s)) s in all; those labelled 'slow' run with: ctest --preset all"
exit $status
