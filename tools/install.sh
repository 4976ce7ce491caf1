#!/usr/bin/env bash
# Installs what tools/packages.txt lists and this Debian 12 machine lacks. Asks dpkg first: where
# nothing is missing, it touches neither apt nor the network and needs no rights.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

missing_packages() {
  local wanted installed
  wanted=$(sed 's/#.*//' "$here/packages.txt" | awk 'NF { print $1 }' | sort -u)
  # dpkg-query exits 1 where it does not know a name: that name is then missing.
  installed=$({ dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null || true; } |
    awk '$1 == "installed" { print $2 }' | sort -u)
  comm -23 <(echo "$wanted") <(echo "$installed")
}

if ! command -v dpkg-query apt-get >/dev/null; then
  echo "install: this machine has no apt; install the libraries of tools/packages.txt yourself" >&2
  exit 1
fi

missing=$(missing_packages)
if [ -z "$missing" ]; then
  echo "install: all packages are there"
  exit 0
fi

as_root=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install: needs root or sudo to install:" $missing >&2
    exit 1
  fi
  as_root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# apt's machine-readable state on descriptor 3 becomes a line at each tenth of the way. The shell
# inside opens it: sudo passes none above 2, and apt would close 1 to the packages' own scripts.
apt_quietly() {
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LOG="$log" sh -c \
      'exec apt-get -qq -o Dpkg::Use-Pty=0 -o APT::Status-Fd=3 "$@" 3>&1 >>"$LOG" 2>&1 </dev/null' \
      apt-get "$@" | awk -F: '
        $1 == "dlstatus" || $1 == "pmstatus" {
          tenth = int($3 / 10)
          if ($1 == phase && tenth <= last) next
          printf "install: %s %3d %%\n", $1 == "dlstatus" ? "download" : "unpack  ", tenth * 10
          fflush()
          phase = $1; last = tenth
        }'; then
    echo "install: apt-get $1 failed:" >&2
    tail -n 20 "$log" >&2
    exit 1
  fi
}

count=$(echo "$missing" | wc -l)
start_s=$SECONDS
echo "install: $count packages are missing:" $missing
echo "install: asking the mirror for its lists"
apt_quietly update >/dev/null
apt_quietly install -y --no-install-recommends $missing

still=$(missing_packages)
if [ -n "$still" ]; then
  echo "install: apt-get reported success, but these are still missing:" $still >&2
  exit 1
fi
echo "install: done in $((SECONDS - start_s)) s"
