#!/usr/bin/env python3
"""Bricks that a picture of weather costs: the planet's shell against cubes in one box around it.

  tools/bench/charts.py FILE.nc [OUT_DIR] [--nephoscope PROGRAM] [render options]

Draws FILE, a forecast or a global analysis, without air and ground from the automatic view (or that
of the options), once over the shell's finest bricks with a fine step (the truth), then over coarser levels of the shell and over
levels of cubes that sample the same field. Prints one row a picture: chart, level, bricks,
error of the picture (rms of luminance over its mean), and what each chart needs for the
errors that both reach, by interpolation in the logarithms. Python's standard library only.
"""
import json
import math
import pathlib
import re
import subprocess
import sys

LEVELS_BELOW = 5  # of the shell's finest
MOST_BRICKS = 150_000


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return done.stdout


def scene_in(picture):
    data = pathlib.Path(picture).read_bytes()
    at = data.find(b'"volumes"')
    start = data.rfind(b"{", 0, at)
    # The scene's first field is before "volumes": go back to the brace that encloses all.
    while start > 0:
        try:
            return json.JSONDecoder().raw_decode(data[start:].decode("utf-8", "ignore"))[0]
        except ValueError:
            start = data.rfind(b"{", 0, start)
    raise SystemExit(f"{picture}: no scene in it")


def draw(program, scene, name, out):
    file, picture = out / f"{name}.json", out / f"{name}.pfm"
    file.write_text(json.dumps(scene))
    text = run(program, "render", file, "--explain", "-o", picture)
    bricks, constant, level = map(int, re.search(
        r"(\d+) bricks, (\d+) constant.*level (\d+) of", text).groups())
    return picture, bricks + constant, level


def error(program, picture, truth):
    return json.loads(run(program, "compare", picture, truth, "--json"))["relative_rms"]["value"]


def needed(rows, goal):
    """Bricks at an error, between the rows on its two sides."""
    rows = sorted(rows, key=lambda r: r[1])
    for (n0, e0), (n1, e1) in zip(rows, rows[1:]):
        if e0 <= goal <= e1 and e0 > 0:
            f = math.log(goal / e0) / math.log(e1 / e0)
            return math.exp(math.log(n0) + f * math.log(n1 / n0))
    return None


def main():
    words = sys.argv[1:]
    program = "build/release/bin/nephoscope"
    if "--nephoscope" in words:
        at = words.index("--nephoscope")
        program = words[at + 1]
        del words[at:at + 2]
    if not words:
        raise SystemExit(__doc__)
    source = words.pop(0)
    out = pathlib.Path(words.pop(0) if words and not words[0].startswith("-") else "out/charts")
    out.mkdir(parents=True, exist_ok=True)
    first = out / "first.pfm"
    size = [] if "--size" in words else ["--size", "320x180"]
    run(program, "render", source, "--no-planet", *size, "--probe-pixels", "0",
        "--exposure", "0", *words, "-o", first)
    scene = scene_in(first)
    for volume in scene["volumes"]:
        volume["files"] = [str(pathlib.Path(source).resolve())]
    scene["render"].update(tolerance=1e-3, budget_mib=2048, pixels_per_voxel=1e-3)
    truth, _, finest = draw(program, scene, "truth", out)
    rows = {"shell": [], "box": []}
    print("chart  level  bricks  picture error")
    for below in range(1, min(LEVELS_BELOW, finest) + 1):
        scene["render"]["max_level"] = finest - below
        picture, bricks, level = draw(program, scene, f"shell_{level_name(finest - below)}", out)
        report(rows, "shell", level, bricks, error(program, picture, truth))
    scene["render"]["max_level"] = 31
    for volume in scene["volumes"]:
        volume.setdefault("parameters", {})["chart"] = "box"
    for level in range(6, 16):
        for volume in scene["volumes"]:
            volume["parameters"]["max_level"] = level
        try:
            picture, bricks, level = draw(program, scene, f"box_{level_name(level)}", out)
        except SystemExit as refused:
            print(f"box    {level:5}  refused: {str(refused).splitlines()[-1]}")
            break
        report(rows, "box", level, bricks, error(program, picture, truth))
        if bricks > MOST_BRICKS:
            break
    for goal in (0.3, 0.2, 0.15, 0.1, 0.07, 0.05):
        shell, box = (needed(rows[chart], goal) for chart in ("shell", "box"))
        if shell and box:
            print(f"error {100 * goal:.0f} %: shell {shell:.0f} bricks, box {box:.0f}: {box / shell:.1f}x")


def level_name(level):
    return f"{level:02d}"


def report(rows, chart, level, bricks, off):
    rows[chart].append((bricks, off))
    print(f"{chart:5}  {level:5}  {bricks:6}  {100 * off:.2f} %", flush=True)


if __name__ == "__main__":
    main()
