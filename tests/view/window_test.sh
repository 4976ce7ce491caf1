#!/bin/sh
# window_test.sh PROGRAM FOLDER CASE [MAKE_SAMPLES]: the window on a display without a screen.
set -eu
program=$1
folder=$2
what=$3
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
cat > scene.json <<'EOF'
{"name": "a ball", "volumes": [{"name": "ball", "source": "analytic",
 "parameters": {"kind": "sphere", "radius": "0.5 km", "extinction_per_m": 0.01, "max_level": 2}}],
 "camera": {"fov_deg": 40},
 "sun": {"azimuth_deg": 120, "elevation_deg": 40}, "image": {"width": 96, "height": 54},
 "render": {"budget_mib": 32, "light": "single", "probe_pixels": 8, "probe_paths": 0}}
EOF
view() {
  timeout 100 xvfb-run -a -s "-screen 0 640x480x24" "$program" view "$@"
}
fail() {
  echo "FAILED: $1"
  exit 1
}
says() {  # says TEXT FILE
  grep -q -- "$1" "$2" || { cat "$2"; fail "'$1' is not said"; }
}
# The window's own thread works no longer than this at a stretch, whatever is opened or compiled.
window_is_free() {  # window_is_free FILE
  cpu=$(sed -n 's/^window: .* at most \([0-9]*\) ms of CPU$/\1/p' "$1")
  [ -n "$cpu" ] && [ "$cpu" -le 100 ] || { cat "$1"; fail "the window was held up"; }
}
case $what in
  no_display)
    if env -u DISPLAY -u WAYLAND_DISPLAY "$program" view scene.json --frames 3 2> said; then
      fail "a window without a display"
    fi
    says "no display" said
    says "nephoscope render" said
    ;;
  old_opengl)
    if MESA_GL_VERSION_OVERRIDE=3.3 view scene.json --frames 3 2> said; then
      fail "OpenGL 3.3 is enough"
    fi
    says "OpenGL 3.3" said
    says "4.5" said
    ;;
  bad_input)
    echo "no cloud" > broken.nc
    if view broken.nc --frames 3 2> said; then fail "a broken file is shown"; fi
    says "broken.nc" said
    printf 'P6\n2 1\n255\nabcdef' > bare.ppm
    if view bare.ppm --frames 3 2> said; then fail "a picture without a scene is shown"; fi
    says "bare.ppm" said
    if view scene.json --path none.json 2> said; then fail "a path that is not there"; fi
    says "none.json" said
    if view scene.json --target-ms 30 --frames 3 2> said; then fail "a target in motion"; fi
    says "--target-ms" said
    if view scene.json --coarse 3 --frames 3 2> said; then fail "every third pixel"; fi
    says "1, 2, 4 or 8" said
    ;;
  flight)
    view scene.json --frames 40 --record flown.json --screenshot shot.ppm > said 2>&1 ||
      { cat said; fail "the first flight"; }
    says "longest block" said
    window_is_free said
    cat said
    [ "$(grep -c eye_m flown.json)" = 40 ] || fail "not 40 cameras"
    view scene.json --path flown.json --bench times.csv > said 2>&1 || { cat said; fail "replay"; }
    says "^gap,39," times.csv
    says "^view," times.csv
    view scene.json --path flown.json --bench times.json > said 2>&1 || fail "replay"
    says '"worst_ms"' times.json
    # Each place until it is at rest: there is an error line then.
    view scene.json --path flown.json --settle --bench settled.csv > said 2>&1 ||
      { cat said; fail "a replay at rest"; }
    says "at rest" said
    says "^error (estimated): integration" said
    says "^pass,frames,median_ms,worst_ms,clock" settled.csv
    view scene.json --coarse 4 --path flown.json --bench reuse.csv > said 2>&1 || fail "every fourth"
    says "^reuse," reuse.csv
    view scene.json --coarse 4 --path flown.json --no-reuse --bench bare.csv > said 2>&1 ||
      fail "no reuse"
    if grep -q "^reuse," bare.csv; then fail "--no-reuse uses pixels again"; fi
    # The picture brings its view back: drawn again, it is the same.
    "$program" render shot.ppm -o again.ppm > said
    "$program" compare shot.ppm again.ppm > said
    cat said
    view shot.ppm --frames 20 --screenshot third.ppm > said 2>&1 || { cat said; fail "restored"; }
    # Twice the same pixels.
    tail -c 15552 shot.ppm > a
    tail -c 15552 again.ppm > b
    tail -c 15552 third.ppm > c
    cmp a b || fail "render draws another picture than the window"
    cmp a c || fail "the window restores another view"
    ;;
  samples)
    "$4" made --size small > said
    for file in made/*.vdb made/*.nc; do
      view "$file" --frames 60 --size 160x90 > said 2>&1 || { cat said; fail "$file"; }
      says "longest block" said
      echo "$file: $(grep 'longest block' said)"
    done
    # Nothing named: the planet.
    view --frames 60 --size 160x90 > said 2>&1 || { cat said; fail "the planet"; }
    says "longest block" said
    echo "planet: $(grep 'longest block' said)"
    ;;
  forecast)
    # While it is read, refined, uploaded and lit. What others run on this machine delays frames
    # too: what is this program's doing is there each time.
    "$4" made --size 200x200x40 > said
    for try in 1 2 3; do
      view made/*.nc --frames 500 --size 320x180 > said 2>&1 || { cat said; fail "the forecast"; }
      window_is_free said
      says "at rest" said
      cat said
      block=$(sed -n 's/^window: .*longest block \([0-9]*\) ms.*/\1/p' said)
      [ "$block" -gt 100 ] || break
      [ $try -lt 3 ] || fail "the window stood still for $block ms"
    done
    ;;
  memory)
    # 2000 frames of a flight in circles take no more than the first 400 of them.
    for frames in 400 2000; do
      awk -v n=$frames 'BEGIN { print "{\"cameras\": ["; for (i = 0; i < n; ++i) { a = i * 0.02
        printf "%s{\"eye_m\": [%.3f, %.3f, 300], \"target_m\": [0, 0, %.3f], \"up\": [0, 0, 1], \"fov_rad\": 0.7}\n",
          i ? "," : "", 1500 * cos(a), 1500 * sin(a), 100 * sin(7 * a) } print "]}" }' > path.json
      view scene.json --size 160x90 --coarse 2 --path path.json > said 2>&1 ||
        { cat said; fail "$frames frames"; }
      sed -n 's/peak memory \(.*\) MiB/\1/p' said > peak.$frames
      says "frames; below" said
    done
    echo "measured: peak memory after 400 and 2000 frames: $(cat peak.400) and $(cat peak.2000) MiB"
    [ "$(cat peak.2000)" -le $(($(cat peak.400) + 4)) ] || fail "memory grows"
    ;;
  *) fail "no such case: $what" ;;
esac
