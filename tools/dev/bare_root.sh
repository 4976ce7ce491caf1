#!/usr/bin/env bash
# tools/dev/bare_root.sh DIR [demo|test]...: proves the two commands on a bare Debian 12. Makes a
# minimal root in DIR (debootstrap, needs root), puts a fresh clone of this checkout's HEAD in it,
# and runs each command twice there: cold (no build folder, no compiler cache) and warm.
# MIRROR = Debian mirror; REAL_DATA = folder handed to the tests as NEPHO_REAL_DATA.
# What is printed goes to DIR/bare_root.log too. An existing root is used again: delete DIR for a
# bare one.
set -euo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
if [ $# -lt 1 ]; then
  sed -n '2,7s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
mkdir -p "$1"
dir=$(cd "$1" && pwd)
shift
commands=("$@")
[ $# -gt 0 ] || commands=(demo test)
inside=$dir/root

case $dir/ in "$repo"/*) echo "bare_root: DIR must lie outside the checkout" >&2; exit 2 ;; esac
if ! git -C "$repo" diff --quiet HEAD; then
  echo "bare_root: uncommitted changes are not in the clone" >&2
fi
exec > >(tee -a "$dir/bare_root.log") 2>&1

if [ ! -e "$inside/etc/debian_version" ]; then
  echo "bare_root: debootstrap into $inside"
  debootstrap --variant=minbase bookworm "$inside" "${MIRROR:-http://deb.debian.org/debian}" \
    >"$dir/debootstrap.log"
  echo "bare_root: $(chroot "$inside" dpkg-query -W | wc -l) packages in the bare root"
fi

mounted=()
unmount_all() {
  local at
  for at in "${mounted[@]}"; do umount "$at" || umount --lazy "$at"; done
}
trap unmount_all EXIT
mount_in() {  # mount_in PATH MOUNT_ARGUMENTS...
  mkdir -p "$inside$1"
  mountpoint -q "$inside$1" && return
  mount "${@:2}" "$inside$1"
  mounted=("$inside$1" "${mounted[@]}")
}
mount_in /proc -t proc proc
mount_in /dev --bind /dev
if [ -n "${REAL_DATA:-}" ]; then
  mount_in /real_data --bind -o ro "$REAL_DATA"
fi

home=$(chroot "$inside" getent passwd root | cut -d: -f6)  # inside

run_inside() {  # run_inside LABEL COMMAND...
  local label=$1 start_s=$SECONDS status=0
  shift
  chroot "$inside" /usr/bin/env -i HOME="$home" PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
    ${JOBS:+JOBS=$JOBS} ${REAL_DATA:+NEPHO_REAL_DATA=/real_data} "$@" || status=$?
  echo "bare_root: $label: exit $status, $((SECONDS - start_s)) s"
  [ $status = 0 ] || exit $status
}

for command in "${commands[@]}"; do
  rm -rf "$inside/src/nephoscope" "$inside$home/.cache"
  git clone -q --no-local "$repo" "$inside/src/nephoscope"
  echo "bare_root: tools/$command.sh at $(git -C "$repo" rev-parse --short HEAD)"
  run_inside "$command cold" "/src/nephoscope/tools/$command.sh"
  run_inside "$command warm" "/src/nephoscope/tools/$command.sh"
done
