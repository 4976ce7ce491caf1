#!/bin/sh
# run_case.sh TABLE NAME BIN_DIR WORK_DIR: runs one row of the table and checks all of it:
#   exit code; exactly one error message, which matches (none where the code is 0); nothing beside it
#   on standard error; no picture and no temporary left (a picture where the code is 0); no signal;
#   5 s of CPU, 60 s of patience for a machine that is busy with other things. Prints what it saw.
set -u
table=$1 name=$2 bin=$3 work=$4
PATH=$bin:$PATH

row=$(grep "^$name *|" "$table") || { echo "no row $name in $table"; exit 1; }
column() { printf '%s\n' "$row" | awk -F ' [|] ' -v c="$1" '{ sub(/^ +/, "", $c); sub(/ +$/, "", $c); print $c }'; }
make=$(column 2) command=$(column 3) wanted=$(column 4) pattern=$(column 5)
[ -n "$pattern" ] || { echo "row $name: five columns are needed"; exit 1; }

rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1

# What rows may call.
scene() {  # scene FILE [MEMBERS]: a small sphere, and whatever else
  printf '{"volumes": [{"source": "analytic", "parameters": {"kind": "sphere", "radius_m": 500, "max_level": 2}}],\n "image": {"width": 32, "height": 18}%s}\n' "${2:+,
 $2}" >"$1"
}
twin() {  # twin NAME: a file with the same trap as a real one
  make_samples . --like "$1" >make_samples.txt 2>&1 || { cat make_samples.txt; exit 1; }
}
full_disk() {  # a folder ./full with 16 KiB left; a file size limit where mounting is not allowed
  mkdir -p full
  if mount -t tmpfs -o size=16k none full 2>/dev/null; then trap 'umount full' EXIT; else ulimit -f 8; fi
}

eval "$make" || { echo "row $name: its input could not be made"; exit 1; }
find . -type f | sort >before.txt
ulimit -t 5
(eval "exec timeout 60 env $command") >stdout.txt 2>stderr.txt
code=$?

bad=0
fail() { echo "FAIL $name: $1"; bad=1; }
errors=$(grep -c ': error: ' stderr.txt)
[ "$code" -eq "$wanted" ] || fail "exit code $code instead of $wanted"
if [ "$wanted" -eq 0 ]; then
  [ "$errors" -eq 0 ] || fail "$errors error messages"
  grep -Eq -- "$pattern" stdout.txt || fail "standard output does not match: $pattern"
else
  [ "$errors" -eq 1 ] || fail "$errors error messages instead of one"
  grep ': error: ' stderr.txt | grep -Eq -- "$pattern" || fail "the message does not match: $pattern"
  # one line and no chatter of libraries; usage (2) has more to say
  [ "$wanted" -eq 2 ] || [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "more than one line of standard error"
  left=$(find . -type f ! -name 'std*.txt' ! -name 'before.txt' | sort | diff before.txt - | grep '^>')
  case $left in *stdout.txt*|*stderr.txt*|'') ;; *) fail "left behind: $left" ;; esac
fi
cat stdout.txt stderr.txt
exit $bad
