#!/usr/bin/env bash
# From a bare Debian 12 (root or sudo) to pictures: builds preset release, makes the sample clouds,
# renders the sample scenes into out/, and writes out/index.html to look at.
# JOBS = parallel compilers; SIZE = WIDTHxHEIGHT of the pictures (default: what the scenes say).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
start_s=$SECONDS
"$root/tools/build.sh" programs
cd "$root"
program=build/release/bin/nephoscope
mkdir -p out

echo "demo: sample clouds"
samples_start_s=$SECONDS
build/release/bin/make_samples data-samples
echo "demo: sample clouds made in $((SECONDS - samples_start_s)) s"

html_text() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

# figure NAME SECONDS COMMAND...: one picture with its command, its error line and its time.
figure() {
  local name=$1 seconds=$2
  shift 2
  printf '<figure>\n<a href="%s.png"><img src="%s.png" alt="%s"></a>\n' "$name" "$name" "$name"
  printf '<figcaption><code>%s</code><br>\n%s<br>\n%s s from launch to picture\n' \
    "$(echo "$*" | html_text)" "$(grep '^error' "out/$name.txt" | html_text)" "$seconds"
  printf '<details><summary>all it said</summary><pre>%s</pre></details>\n</figcaption>\n</figure>\n' \
    "$(html_text <"out/$name.txt")"
}

figures=$(mktemp)
trap 'rm -f "$figures"' EXIT
for scene in cumulus plume together; do
  command=("$program" render "data-samples/scenes/$scene.json" --explain -o "out/$scene.png")
  [ -z "${SIZE:-}" ] || command+=(--size "$SIZE")
  echo "demo: ${command[*]}"
  from_ns=$(date +%s%N)
  if ! "${command[@]}" >"out/$scene.txt" 2>&1; then
    cat "out/$scene.txt" >&2
    exit 1
  fi
  seconds=$(awk -v ns="$(($(date +%s%N) - from_ns))" 'BEGIN { printf "%.1f", ns / 1e9 }')
  grep '^error' "out/$scene.txt"
  echo "demo: out/$scene.png in $seconds s"
  figure "$scene" "$seconds" "${command[@]}" >>"$figures"
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
$(sed -n 's/^device: //p' out/cumulus.txt | head -n 1 | html_text).</p>
$(cat "$figures")
</html>
HTML
mv out/index.html.part out/index.html
echo "demo: look at $root/out/index.html ($((SECONDS - start_s)) s in all)"
