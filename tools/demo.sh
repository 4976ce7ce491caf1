#!/usr/bin/env bash
# From a bare Debian 12 (root or sudo) to pictures: builds preset release, makes the sample clouds,
# renders the sample scenes into out/, and writes out/index.html to look at.
#   tools/demo.sh [FILE...]: and pictures of these files (data, or scenes), with no option but -o
# JOBS = parallel compilers; SIZE = WIDTHxHEIGHT of the pictures (default: what the scenes say);
# SCENES = other names in data-samples/scenes than the demo's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
start_s=$SECONDS
inputs=() scenes=()
for file in "$@"; do inputs+=("$(realpath "$file")"); done
"$root/tools/build.sh" programs
cd "$root"
for scene in ${SCENES:-forecast les plume planet_ground planet_12km planet_space}; do
  scenes+=("data-samples/scenes/$scene.json")
done
inputs=("${scenes[@]}" "${inputs[@]}")
program=build/release/bin/nephoscope
mkdir -p out

echo "demo: sample clouds"
samples_start_s=$SECONDS
build/release/bin/make_samples data-samples
echo "demo: sample clouds made in $((SECONDS - samples_start_s)) s"

html_text() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

# What a reader of the picture must know of the data: the source's facts of where they end.
caption_facts() {
  "$program" info "$1" | sed -n 's/^ *fact: \(.*data end.*\)/\1/p' | html_text | sed 's/$/<br>/'
}

# figure NAME SECONDS FACTS COMMAND...: one picture with its command, its error line and its time.
figure() {
  local name=$1 seconds=$2 facts=$3
  shift 3
  printf '<figure>\n<a href="%s.png"><img src="%s.png" alt="%s"></a>\n' "$name" "$name" "$name"
  printf '<figcaption><code>%s</code><br>\n%s\n%s<br>\n%s s from launch to picture\n' \
    "$(echo "$*" | html_text)" "$facts" "$(grep '^error' "out/$name.txt" | html_text)" "$seconds"
  printf '<details><summary>all it said</summary><pre>%s</pre></details>\n</figcaption>\n</figure>\n' \
    "$(html_text <"out/$name.txt")"
}

figures=$(mktemp)
trap 'rm -f "$figures"' EXIT
for input in "${inputs[@]}"; do
  name=$(basename "${input%.*}")
  command=("$program" render "$input" --explain -o "out/$name.png")
  [ -z "${SIZE:-}" ] || command+=(--size "$SIZE")
  echo "demo: ${command[*]}"
  from_ns=$(date +%s%N)
  if ! "${command[@]}" >"out/$name.txt" 2>&1; then
    cat "out/$name.txt" >&2
    exit 1
  fi
  seconds=$(awk -v ns="$(($(date +%s%N) - from_ns))" 'BEGIN { printf "%.1f", ns / 1e9 }')
  grep '^error' "out/$name.txt"
  echo "demo: out/$name.png in $seconds s"
  figure "$name" "$seconds" "$(caption_facts "$input")" "${command[@]}" >>"$figures"
done

cat >out/index.html.part <<HTML
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Nephoscope: sample scenes</title>
<style>
body { max-width: 70rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 sans-serif;
       background: #16191d; color: #d8dde3 }
figure { margin: 0 0 3rem } img { max-width: 100%; height: auto; display: block }
code, pre { font-size: .85rem; overflow-wrap: anywhere; white-space: pre-wrap }
a { color: inherit }
</style>
<h1>Nephoscope: sample scenes</h1>
<p>$("$program" --version | head -n 1 | html_text), $(date -u +%Y-%m-%d), $(nproc) cores,
$(sed -n 's/^device: //p' out/*.txt | head -n 1 | html_text).</p>
$(cat "$figures")
</html>
HTML
mv out/index.html.part out/index.html
echo "demo: look at $root/out/index.html ($((SECONDS - start_s)) s in all)"
