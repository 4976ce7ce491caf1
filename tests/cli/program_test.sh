#!/bin/sh
# program_test.sh CLAIM BIN_DIR WORK_DIR: one claim about the program, checked from outside. The
# scenes are small: 32x18 pixels of an analytic sphere.
set -eu
claim=$1 work=$3
PATH=$2:$PATH
rm -rf "$work" && mkdir -p "$work/in" && cd "$work"

fail() { echo "FAIL: $1"; exit 1; }
has() { grep -Eq -- "$2" "$1" || { cat "$1"; fail "$1 does not match: $2"; }; }
sphere() {  # sphere FILE [MEMBERS]
  cat >"$1" <<END
{"volumes": [{"source": "analytic", "name": "ball",
  "parameters": {"kind": "sphere", "radius": "0.5 km", "extinction_per_m": 0.01, "max_level": 2}}],
 "image": {"width": 32, "height": 18}${2:+, $2}}
END
}
formats() {  # those that this build writes, and that keep what they are given
  echo ppm pfm
  nephoscope render in/s.json -o probe.png >/dev/null 2>&1 && echo png exr hdr
}

version_and_help() {
  nephoscope --version >v.txt && has v.txt '^nephoscope [0-9]+\.[0-9]+\.[0-9]+$'
  nephoscope --help >h.txt && has h.txt 'Examples:' && has h.txt 'nephoscope render'
  nephoscope render --help >r.txt
  for option in size look-from look-at fov sun budget-mib step tolerance fetch seed frame fps \
    density-scale up metres-per-unit grid light exposure explain explain-all at heading pitch view time \
    no-planet force region engine spp noise levels host-mib exact-orders target-error target-ms; do
    has r.txt "^ *(-o,)?--$option"
  done
  nephoscope bench --help >b.txt
  for option in sweep size repeat spp exact-orders host-mib finest-step; do
    has b.txt "^ *--$option "
  done
  nephoscope compare --help >c.txt
  for option in diff diff-of diff-scale exposure tone-map pixels-per-degree json; do
    has c.txt "^ *--$option "
  done
}

render_repeats_from_its_metadata() {
  sphere in/s.json '"camera": {"fov_deg": 33.3}, "sun": {"azimuth_deg": 77.7, "elevation_deg": 21}'
  for ending in $(formats); do
    nephoscope render in/s.json --probe-pixels 4 -o "in/one.$ending" >one.txt
    # From another folder, and after the scene file is gone: all that it needs is in the picture.
    mv in/s.json in/hidden
    mkdir -p other && (cd other && nephoscope render "../in/one.$ending" -o "two.$ending") >two.txt
    mv in/hidden in/s.json
    nephoscope compare "in/one.$ending" "other/two.$ending" >same.txt
    has same.txt 'bit for bit'
    [ "$(grep '^error' one.txt)" = "$(grep '^error' two.txt)" ] || fail "another error line"
    nephoscope info "other/two.$ending" >info.txt
    has info.txt '^nephoscope:error: error \(estimated\): integration'
    has info.txt '^nephoscope:version: [0-9]'
  done
  # Without a name for the second one, it stands beside the first, which is not touched.
  ending=ppm
  if [ -f in/one.png ]; then ending=png; fi
  cp "in/one.$ending" kept
  (cd in && nephoscope render "one.$ending") >again.txt
  cmp "in/one.$ending" kept || fail "replaced its input"
  has again.txt "^one-again.$ending: 32x18"
  nephoscope compare "in/one.$ending" "in/one-again.$ending" >same.txt && has same.txt 'bit for bit'
  # A changed option is another picture: the comparison above can fail.
  nephoscope render in/one.ppm --sun 200,40 -o three.ppm >/dev/null
  nephoscope compare in/one.ppm three.ppm >differ.txt && has differ.txt 'not the same pixels'
}

targets_choose_settings() {
  sphere in/s.json
  nephoscope render in/s.json --target-error 10% -o e.ppm >e.txt
  has e.txt '^target: error 10 %: tolerance [0-9.e-]+, [0-9]+ MiB, [0-9.]+ pixels a voxel give [0-9.]+ %'
  has e.txt "the light model's [0-9]+ % is beside it"
  # What was chosen is the picture's scene: the same bits again, and no target in it.
  nephoscope info e.ppm >i.txt && has i.txt '"tolerance"'
  ! grep -q '"target_error"' i.txt || fail "the target stayed in the scene"
  nephoscope render e.ppm -o again.ppm >/dev/null
  nephoscope compare e.ppm again.ppm >same.txt && has same.txt 'bit for bit'
  nephoscope render in/s.json --target-ms 1e8 -o t.ppm >t.txt
  has t.txt '^target: frame 1e.08 ms: .* ms of [CG]PU time for light passes and view'
  # Too short for any: a picture all the same, and the time that it takes.
  nephoscope render in/s.json --target-ms 0.001 -o u.ppm >u.txt 2>u.err
  has u.txt '^target: frame 0.001 ms is not met: '
  has u.err 'warning: --target-ms 0.001 is not met: the fastest setting takes [0-9.]+ ms'
  refuses() {
    status=$1 reason=$2 && shift 2
    code=0 && nephoscope "$@" >/dev/null 2>no.txt || code=$?
    [ "$code" = "$status" ] || fail "exit $code: $*"
    has no.txt "$reason"
  }
  for target in 0 -1% 0.001% 300%; do
    refuses 1 "from 0.0001 to 1" render in/s.json "--target-error=$target" -o no.ppm
  done
  refuses 1 'at least 0.26 %, the rounding of 8 bits.*write .exr or .pfm: 0.01 %' \
    render in/s.json --target-error 0.1% -o no.ppm
  refuses 1 'probe-pixels' render in/s.json --target-error 1% --probe-pixels 0 -o no.ppm
  refuses 1 'engine march' render in/s.json --target-error 1% --engine reference -o no.ppm
  refuses 2 'excludes' render in/s.json --target-error 1% --tolerance 0.1 -o no.ppm
  refuses 2 'excludes' render in/s.json --target-ms 5 --budget-mib 4 -o no.ppm
  refuses 2 'excludes' render in/s.json --target-ms 5 --target-error 1% -o no.ppm
}

frames_and_exposes_by_itself() {
  sphere in/s.json
  nephoscope render in/s.json -o a.ppm >a.txt
  has a.txt '^error \(estimated\): integration [0-9.e+-]+ %, level of detail [0-9.e+-]+ %, quantisation [0-9.e+-]+ %, light model [0-9.e+-]+ % \([0-9]+ paths a pixel\)$'
  has a.txt 'exposure [+-][0-9.]+ EV \(from the picture\)'
  has a.txt '^assumed: camera: frames the cloud'
  has a.txt "^assumed: sun: 40 degrees high, behind the camera's left shoulder"
  # The sphere fills the picture's height and no more: the middle row is cloud, and sky at its ends.
  nephoscope render in/s.json --tone-map none -o b.pfm >/dev/null
  nephoscope info b.pfm >b.txt && has b.txt '"exposure_ev"'
  # What was stated is what was used: giving it again changes no bit.
  ev=$(sed -n 's/.*exposure \([+-][0-9.]*\) EV.*/\1/p' a.txt)
  nephoscope render in/s.json --exposure "$ev" -o c.ppm >c.txt
  nephoscope compare a.ppm c.ppm >same.txt && has same.txt 'bit for bit'
  if grep -q 'from the picture' c.txt; then fail "a given exposure is not found again"; fi
}

explain_lists_what_was_used() {
  sphere in/s.json
  nephoscope render in/s.json --explain -o a.ppm >a.txt
  has a.txt '^device: .*OpenGL'
  has a.txt '^  analytic$'
  has a.txt '^  ball: [0-9]+ nodes, [0-9]+ bricks'
  has a.txt '^bytes: budget 256 MiB, used [0-9.]+ MiB'
  has a.txt '^passes \(CPU\):'
  has a.txt '^shader switches:'
  has a.txt '^left out:'
  if grep -qi 'openvdb\|nepho_image_oiio' a.txt; then fail "loaded what the scene does not need"; fi
  # A picture module brings hundreds of libraries: by name those that it asks for itself.
  nephoscope render in/s.json --explain -o b.exr >b.txt 2>/dev/null || return 0
  has b.txt '^  nepho_image_oiio.so$' && has b.txt '^  libOpenImageIO\.so' &&
    has b.txt '^  and [0-9]+ that these need \(--explain-all names them\)$'
  nephoscope render in/s.json --explain-all -o c.exr >c.txt
  [ "$(grep -c '^  lib.*\.so' c.txt)" -gt "$(grep -c '^  lib.*\.so' b.txt)" ] || fail "names no more"
  if grep -q 'that these need' c.txt; then fail "counts what it names"; fi
}

info_for_people_and_programs() {
  sphere in/s.json
  nephoscope info in/s.json >a.txt && has a.txt '^  extinction 0 to 0\.01'
  nephoscope info in/s.json --json >a.json
  has a.json '"max": 0\.01' && has a.json '"chart": "box"'
}

several_inputs_are_one_scene() {
  sphere in/s.json
  cat >in/two.json <<END
{"volumes": [
  {"source": "analytic", "name": "left", "parameters": {"kind": "sphere", "radius_m": 300, "max_level": 2}},
  {"source": "analytic", "name": "right", "parameters": {"kind": "cube", "center_x_m": 900, "max_level": 2}}],
 "image": {"width": 32, "height": 18}}
END
  nephoscope render in/two.json --explain --probe-pixels 0 -o a.ppm >a.txt
  has a.txt '^  left: [0-9]+ nodes' && has a.txt '^  right: [0-9]+ nodes'
}

options_beat_the_scene() {
  sphere in/s.json '"render": {"tolerance": 0.05, "seed": 3}, "exposure_ev": 1'
  nephoscope render in/s.json --size 20x10 --step 0 --light single --seed 9 --exposure -2.5 \
    --look-from 0,-3000,500 --look-at 0,0,500 --fov 25 --sun 180,10 --max-level 1 --budget-mib 64 \
    --fetch texels8 --probe-pixels 0 -o a.pfm >a.txt
  has a.txt '^a.pfm: 20x10, exposure -2.50 EV$'
  nephoscope info a.pfm >i.txt
  for pattern in '"step_voxels": 0' '"light": "single"' '"seed": 9' '"fetch": "texels8"' \
    '"max_level": 1' '"budget_mib": 64' '"width": 20' '-3000'; do
    has i.txt "$pattern"
  done
  if grep -q tolerance i.txt; then fail "a fixed step leaves no tolerance"; fi
}

planets_views_repeat() {  # a cloud on the shell, with a planet because the scene says so
  cat >in/s.json <<END
{"volumes": [{"source": "analytic", "name": "patch",
  "place": {"lat_deg": 47, "lon_deg": 11, "height_m": 3000},
  "parameters": {"kind": "gaussian", "chart": "shell", "sigma": "300 km", "sigma_z": "1500 m",
    "extinction_per_m": 0.002, "max_level": 5, "top": "12 km"}}],
 "planet": {}, "image": {"width": 48, "height": 27}, "render": {"probe_pixels": 0}}
END
  nephoscope render in/s.json -o in/a.ppm >a.txt
  has a.txt '^assumed: view: oblique, where the clouds have most structure, --look-from geo:[-0-9.]*,[-0-9.]*,[0-9.]+ '
  has a.txt '^assumed: sun: 35 degrees high to the side, --sun [0-9.]+,[0-9.]+ \(the data have no date\)$'
  nephoscope render in/a.ppm -o in/b.ppm >/dev/null
  nephoscope compare in/a.ppm in/b.ppm >same.txt && has same.txt 'bit for bit'
  # In linear light, too, and shown the same way: white is that of the sun outside the air.
  linear=in/b.exr  # where this build writes it: then with optical depth
  nephoscope render in/a.ppm -o $linear >/dev/null 2>&1 || {
    linear=in/b.pfm
    nephoscope render in/a.ppm -o $linear >/dev/null
  }
  nephoscope compare $linear in/a.ppm >same.txt && has same.txt '^RMSE of 8-bit RGB: 0$'
  nephoscope compare $linear $linear >same.txt && has same.txt '^rms of .* \(over all pixels\)$'
  nephoscope render in/s.json --view globe --sun 2005-06-21T11:00Z -o in/c.ppm >c.txt
  has c.txt '^assumed: view: the globe'
  nephoscope render in/c.ppm -o in/d.ppm >/dev/null
  nephoscope compare in/c.ppm in/d.ppm >same.txt && has same.txt 'bit for bit'
  nephoscope render in/s.json --at 46,11 --sun 180,30 -o in/e.ppm >e.txt
  has e.txt '^assumed: view: from the ground, --at 46.000000,11.000000,2 --heading '
  # What was stated draws the same view, as far as its digits go.
  options=$(sed -n 's/^assumed: view: from the ground, //p' e.txt)
  nephoscope render in/s.json $options --sun 180,30 -o in/f.ppm >/dev/null
  nephoscope compare in/e.ppm in/f.ppm >same.txt
  rms=$(sed -n 's/^rms.*: \([0-9.e-]*\) %.*/\1/p' same.txt)
  awk -v rms="$rms" 'BEGIN { exit !(rms < 3) }' || { cat same.txt; fail "another view"; }
  # Points are over the scene's own planet, and stay where they were put.
  sed 's/"planet": {}/"planet": {"radius_m": 3400000}/' in/s.json >in/m.json
  sed -i 's/"chart": "shell", "sigma": "300 km", "sigma_z": "1500 m"/"sigma": "3 km"/; s/, "top": "12 km"//' in/m.json
  nephoscope render in/m.json --look-from geo:0,0,1000 --look-at geo:1,0,0 -o in/m.ppm >/dev/null
  nephoscope info in/m.ppm >m.txt && has m.txt '^ *3401000'
  # A stand or a view gives way to an eye, and the other way round.
  nephoscope render in/e.ppm --look-from geo:46,11,9000 -o in/g.ppm >/dev/null
  nephoscope render in/g.ppm --at 46,11 --heading 90 --pitch 5 -o in/h.ppm >h.txt
  if grep -q '^assumed: view' h.txt; then fail "a given view is not worked out"; fi
}

ctrl_c_leaves_nothing() {
  sphere in/s.json
  # Fine and slow enough to be caught at work; the temporary is there before the work begins.
  nephoscope render in/s.json --size 2000x2000 --step 0 -o in/a.ppm >/dev/null 2>&1 &
  pid=$!
  for wait in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    [ -n "$(find in -name '.a.*')" ] && break
    sleep 0.1
  done
  [ -n "$(find in -name '.a.*')" ] || fail "was not at work after 2 s"
  kill -TERM $pid
  if wait $pid; then fail "ended well in spite of the signal"; fi
  [ "$(ls -A in)" = s.json ] || { ls -A in; fail "left something behind"; }
}

# Paths: repeated bit for bit on any number of threads, to a goal, and Ctrl-C keeps what is done.
reference_is_drawn() {
  sphere in/s.json
  nephoscope render in/s.json --engine reference --spp 6 -o a.pfm >a.txt
  has a.txt '^error \(measured\): noise [0-9.e+]+ % .*, 6 paths a pixel; finest bricks\)$'
  taskset -c 0 nephoscope render in/s.json --engine reference --spp 6 -o b.pfm >/dev/null
  cmp a.pfm b.pfm || fail "another number of threads, another picture"
  nephoscope render a.pfm -o c.pfm >/dev/null && nephoscope compare a.pfm c.pfm >c.txt
  has c.txt "same pixels, bit for bit"
  nephoscope render in/s.json --engine reference --noise 60% --levels resident -o d.ppm >d.txt
  awk '/noise/ { sub(/.*noise /, ""); exit !($1 > 0 && $1 <= 60) }' d.txt || { cat d.txt; fail "noise"; }
  nephoscope render in/s.json --spp 4 -o e.ppm 2>e.txt && fail "--spp without paths"
  has e.txt 'error: --spp: nothing to apply it to'
  for idle in "--light single" "--probe-pixels 4" "--budget-mib 64" "--levels resident --host-mib 9"; do
    nephoscope render in/s.json --engine reference --spp 4 $idle -o e.ppm 2>e.txt && fail "$idle taken"
    has e.txt 'nothing to apply it to'
  done
  nephoscope render in/s.json --size 64x64 --engine reference --spp 1000000 -o f.pfm >f.txt &
  pid=$!
  sleep 2
  kill -INT $pid
  wait $pid || fail "Ctrl-C lost the picture"
  has f.txt 'stopped early'
  [ -s f.pfm ] || fail "no picture after Ctrl-C"
}

compare_measures() {
  sphere in/s.json
  nephoscope render in/s.json --probe-pixels 0 --exposure 0 -o a.pfm >/dev/null
  nephoscope render in/s.json --probe-pixels 0 --exposure 0 --step 0 -o b.pfm >/dev/null
  nephoscope compare a.pfm b.pfm >c.txt
  has c.txt '^rms of luminance, relative: [0-9.e-]+ % \(over all pixels\)$'
  has c.txt '^relative MSE: [0-9.e-]+$'
  rms=$(sed -n 's/^rms.*: \([0-9.e-]*\) %.*/\1/p' c.txt)
  awk -v rms="$rms" 'BEGIN { exit !(rms > 0 && rms < 3) }' || { cat c.txt; fail "rms of $rms %"; }
}

grey() { printf 'P6\n2 1\n255\n%b' "\\0$2\\0$2\\0$2\\0$2\\0$2\\0$2" >"$1"; }  # grey FILE OCTAL

compare_shows_both_alike() {
  # Closed forms: ten levels apart are 28.1308 dB, and the maps have the size of the pictures.
  grey a.ppm 156 && grey b.ppm 144
  nephoscope compare a.ppm b.ppm >c.txt
  has c.txt '^RMSE of 8-bit RGB: 10$'
  has c.txt '^PSNR of 8-bit RGB: 28\.1308 dB$'
  has c.txt '^bias of luminance: \+[0-9.]+ %$'
  nephoscope compare b.ppm a.ppm >c.txt && has c.txt '^bias of luminance: -[0-9.]+ %$'
  nephoscope compare a.ppm a.ppm >c.txt
  has c.txt '^PSNR of 8-bit RGB: inf dB$' && has c.txt '^FLIP: mean 0, largest 0 '
  # A linear picture is shown as the truth's scene says, which is how render showed it.
  sphere in/s.json '"dither": "ordered"'
  nephoscope render in/s.json --probe-pixels 0 --exposure 0.5 -o a.pfm >/dev/null
  nephoscope render a.pfm -o b.ppm >/dev/null
  nephoscope compare a.pfm b.ppm >c.txt
  has c.txt "^shown at \+0\.50 EV, tone map aces, dithered \(the 8-bit picture's scene\)$"
  has c.txt '^RMSE of 8-bit RGB: 0$' && has c.txt '^same pixels as shown in 8 bits$'
  nephoscope compare b.ppm a.pfm --tone-map none --exposure 3 >c.txt
  has c.txt '^shown at \+3\.00 EV, tone map none' && has c.txt '^not the same pixels$'
  nephoscope compare a.pfm a.pfm >c.txt && has c.txt "^shown at \+0\.50 EV, .*\(B's scene\)$"
  # Pictures that say nothing are shown as render would show them.
  head -c $((32 * 18 * 12 + 14)) a.pfm >bare.pfm
  nephoscope compare bare.pfm bare.pfm >c.txt && has c.txt '^shown at [+-][0-9.]+ EV, .*found for B'
  nephoscope render a.pfm --exposure 1 -o d.ppm >/dev/null
  nephoscope compare b.ppm d.ppm >c.txt && has c.txt '^note: A and B were shown differently: \+0\.50'
}

compare_maps_differences() {
  sphere in/s.json
  nephoscope render in/s.json --probe-pixels 0 --exposure 0 -o a.pfm >/dev/null
  nephoscope render in/s.json --probe-pixels 0 --exposure 0 --light single -o b.pfm >/dev/null
  nephoscope compare b.pfm a.pfm --diff d.ppm >c.txt && has c.txt '^d\.ppm: FLIP from 0 .* to 1 '
  nephoscope compare b.pfm a.pfm --diff l.ppm --diff-of luminance >c.txt
  has c.txt '^l\.ppm: relative difference of luminance from -[0-9]+ % \(blue\) .* \+[0-9]+ % \(red\)$'
  nephoscope compare d.ppm l.ppm >c.txt && has c.txt '^not the same pixels'
  # The numbers themselves: their mean is the one that is printed.
  nephoscope compare b.pfm a.pfm --diff d.pfm --json >c.json
  has c.json '"file": "d.pfm"' && has c.json '"psnr_db": [0-9.]+' && has c.json '"light": "linear"'
  printed=$(sed -n 's/^ *"mean": \([0-9.e-]*\),*/\1/p' c.json)
  measured=$(tail -c +15 d.pfm | head -c $((32 * 18 * 12)) | od -An -v -tf4 |
    awk '{ for (i = 1; i <= NF; i++) { sum += $i; n++ } } END { print sum / n }')
  awk -v a="$printed" -v b="$measured" 'BEGIN { exit !(a > 0.001 && (a - b) ^ 2 < 1e-8 * a * a) }' ||
    fail "map of mean $measured, printed $printed"
  nephoscope compare b.pfm a.pfm --pixels-per-degree 20 --json >n.json
  if cmp -s c.json n.json; then fail "the distance of the eye changes nothing"; fi
}

bench_reports() {
  sphere in/s.json
  sphere in/t.json '"sun": {"azimuth_deg": 120, "elevation_deg": 30}'
  nephoscope bench in/s.json in/t.json --sweep step=1,2,4 --sweep max-level=1,2 --size 16x9 --spp 0 \
    -o report >b.txt 2>progress.txt
  has b.txt '^s: step 1, max-level 1: frame [0-9.]+ m?s CPU, error [0-9.]+ %$'
  has b.txt '^report/index\.html$'
  has progress.txt '^bench: t: step 4, max-level 2, run 5 of 5, about [0-9]+ s left$'
  ls -A report >files.txt
  printf '%s\n' bench.csv index.html orders.csv pareto-s.svg pareto-t.svg tables.md terms.csv >expected.txt
  cmp files.txt expected.txt || { cat files.txt; fail "other files than those of a report"; }
  # A row for each scene and setting, as many fields as the header has.
  awk -F, 'NR == 1 { n = NF } NF != n { exit 1 } END { exit NR != 13 }' report/bench.csv ||
    fail "bench.csv is no table of 12 settings"
  has report/bench.csv '^scene,step \[voxels\],max-level,runs \[1\],'
  has report/index.html 'no GPU time: the OpenGL device is a rasteriser on the CPU|GPU.s own clock'
  has report/index.html 'order -?[0-9.]+, standard error [0-9.]+, from 3 points|not fitted'
  # One scene: one chart. What was there is replaced.
  nephoscope bench in/s.json --size 16x9 --spp 0 -o report >b.txt 2>/dev/null
  has b.txt '^s: as the scene says: frame ' && [ -f report/pareto.svg ] || fail "no chart"
}

bench_refuses() {
  sphere in/s.json
  refused() {  # refused WORDS OPTIONS...
    words=$1 && shift
    if nephoscope bench in/s.json --size 16x9 "$@" -o new >b.txt 2>err.txt; then
      fail "took $*"
    fi
    has err.txt "$words"
    [ ! -e new ] || fail "$*: left a folder behind"
  }
  refused 'no such setting.*step \(voxels\), tolerance, budget-mib' --sweep stepp=1,2
  refused 'an empty range' --sweep step=
  refused 'a value is missing' --sweep step=1,,2
  refused 'exclude each other' --sweep step=1 --sweep tolerance=0.1
  refused 'swept twice' --sweep step=1 --sweep step=2
  refused 'a whole number from 5' --repeat 4
  refused 'a whole number from 0' --spp -1
  refused 'fewer than 8' --spp 7
  # Nothing but noise: octaves are judged by paths, and two are none.
  refused 'no reference is good enough.*paths.*\(--spp\)' --sweep octaves=7,8 --spp 8
  : >plain
  if nephoscope bench in/s.json -o plain >b.txt 2>err.txt; then fail "wrote into a file"; fi
  has err.txt 'plain: cannot write'
}

"$claim"
