#!/bin/sh
# user_test.sh PROGRAM X11_USER FOLDER CASE [MAKE_SAMPLES]: somebody at the window, on a display
# without a screen: files dropped by XDND, keys, drags, pictures of what is shown.
set -eu
if [ -z "${USER_TEST_INSIDE:-}" ]; then
  USER_TEST_INSIDE=1 exec timeout 280 xvfb-run -a -s "-screen 0 800x600x24" sh "$0" "$@"
fi
program=$1
user=$2
folder=$3
what=$4
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
scene() {  # scene NAME AZIMUTH
  cat <<EOF
{"name": "$1", "volumes": [{"name": "$1", "source": "analytic",
 "parameters": {"kind": "sphere", "radius": "0.5 km", "extinction_per_m": 0.01, "max_level": 2}}],
 "camera": {"fov_deg": 40}, "sun": {"azimuth_deg": $2, "elevation_deg": 40},
 "image": {"width": 640, "height": 360},
 "render": {"budget_mib": 32, "light": "single", "probe_pixels": 16, "probe_paths": 0}}
EOF
}
scene "a ball" 120 > ball.json
scene "the ball from the other side" 300 > evening.json
viewer=
fail() {
  echo "FAILED: $1"
  cat said
  if [ -n "$viewer" ]; then
    kill "$viewer" 2> /dev/null || true
    wait "$viewer" || true
  fi
  exit 1
}
begin() {
  : > said  # or the first look at it may come before it is there
  "$program" view "$@" 2> said > printed &
  viewer=$!
}
lines() { grep -c -- "$1" said || true; }
# until TEXT N: it is in the log N times.
until_said() {
  n=0
  while [ "$(lines "$1")" -lt "$2" ]; do
    n=$((n + 1))
    [ $n -lt 600 ] || fail "'$1' is not said"
    kill -0 "$viewer" 2> /dev/null || fail "the window is gone"
    sleep 0.1
  done
}
act() { "$user" Nephoscope "$@" || fail "x11_user $*"; }
end() {
  act key Escape
  wait "$viewer" || fail "it ended badly"
  viewer=
}
# The rows above messages, which stand at the foot of the window: 250 of 360.
above() { tail -c +16 "$1" | head -c $((640 * 3 * 250)); }
# Frames whose pixels were shared out otherwise differ in the last bit of a float: 1 of 255 here and there.
same() {
  above "$1" > above.1 && above "$2" > above.2
  [ "$(cmp -l above.1 above.2 | awk '
    function value(octal, i, v) {
      for (i = 1; i <= length(octal); ++i) v = 8 * v + substr(octal, i, 1)
      return v
    }
    { apart = value($2) - value($3); if (apart > 1 || apart < -1) ++far }
    END { print far + 0 }')" = 0 ]
}
# Pixels in the colour of errors: 255, 153, 102.
errors_shown() { od -An -v -tx1 -w3 "$1" | grep -c 'ff 99 66' || true; }

case $what in
  drop)
    mkdir heap
    echo "no cloud" > broken.nc
    printf 'P6\n2 1\n255\nabcdef' > bare.ppm
    # Shares as the machine can bear differ in the last bit of a float: 1 of 255 here and there.
    begin ball.json --coarse 4
    until_said "at rest: error" 1
    act key h
    sleep 0.5
    act look before.ppm
    [ "$(tail -c +16 before.ppm | od -An -v -tx1 -w3 | sort -u | wc -l)" -gt 100 ] ||
      fail "there is nothing to see"
    [ "$(errors_shown before.ppm)" = 0 ] || fail "an error before there is one"
    for file in heap broken.nc bare.ppm; do
      act drop $file
      until_said "warning: .*$file" 1
      sleep 1
      act look after.$file.ppm
      same before.ppm after.$file.ppm || fail "the scene is another after $file"
      [ "$(errors_shown after.$file.ppm)" -gt 100 ] || fail "no message about $file in the window"
    done
    # And it goes on: a file that is one, and a picture that brings its view back.
    act drop evening.json
    until_said "opened evening.json" 1
    until_said "at rest: error" 2
    act look evening.ppm
    same before.ppm evening.ppm && fail "evening.json is not shown"
    "$program" render ball.json -o ball.ppm > /dev/null 2>&1
    act drop ball.ppm
    until_said "opened ball.ppm" 1
    until_said "at rest: error" 3
    sleep 0.3
    act look back.ppm
    same before.ppm back.ppm || fail "ball.ppm does not bring its view back"
    if [ $# -gt 4 ]; then
      "$5" made --size small > /dev/null
      for file in made/*.vdb made/*.nc; do
        act drop "$file"
        until_said "opened $(basename "$file")" 1
      done
    fi
    end
    ;;
  keys)
    begin ball.json
    until_said "at rest: error" 1
    act key F12
    act key F12  # while the first is drawn, or about to be
    until_said "nephoscope-1.*: error (estimated)" 1
    until_said "nephoscope-2.*: error (estimated)" 1
    picture=$(ls nephoscope-1.*)
    end
    "$program" render "$picture" -o "again.${picture##*.}" > /dev/null 2>&1
    "$program" compare "$picture" "again.${picture##*.}" --json > apart.json
    grep -q '"same_bits": true' apart.json ||
      { cat apart.json; fail "render draws another picture than F12"; }
    # Eyes of the first and the last frame, and what they look at.
    ends() { tr -d ' \n' < "$1" | sed 's/"eye_m":/\n&/g' | grep "$2" |
      sed "s/.*\"$2\":\[\([^]]*\)\].*/\1/" | sed -n '1p;$p' | uniq | wc -l; }
    begin ball.json --record ahead.json
    until_said "at rest: error" 1
    act hold w 600
    end
    [ "$(ends ahead.json eye_m)" = 2 ] || fail "W goes nowhere"
    begin ball.json --record round.json
    until_said "at rest: error" 1
    act key m
    act drag 100 20 480 150  # beside the panel
    end
    [ "$(ends round.json eye_m)" = 2 ] || fail "a drag in orbit goes nowhere"
    [ "$(ends round.json target_m)" = 1 ] || fail "an orbit lets go of what is looked at"
    ;;
  first)
    # Nothing of what was named can be shown: the message, and the planet instead.
    echo "no cloud" > broken.nc
    begin broken.nc
    until_said "warning: .*broken.nc" 1
    until_said "opened the procedural planet" 1
    end
    begin ball.json --budget-mib 1
    until_said "warning: .*no room" 1
    until_said "opened the procedural planet" 1
    end
    ;;
  *) fail "no such case: $what" ;;
esac
