#!/usr/bin/env python3
"""What a frame costs, pass by pass, from three places over a procedural planet: space, 14 km, ground.

  tools/bench/fly_views.py OUT_DIR [--nephoscope PROGRAM] [--frames N] [--only PLACE]
                         [view options]

The places are frames 0, 700 and 1474 of the camera path in the benchmark of the program of Mulen's
thesis, 640x360, every pixel, its field of view and its sun, so that milliseconds stand beside those
measured of that program in the same way: process CPU time of each pass. Its planet is a sphere of
6371 km, ours WGS 84 under water: eyes are put at the same height in the same direction from the
centre, and look the same way. N cameras a place, each 1 mm beside the last, so that each has a frame
of its own; each stays until its bricks and their light are there: minutes a place on a CPU.
Writes a path and a table (CSV) for each place; prints medians. Without a display, run it under
xvfb-run. Python's standard library only.
"""
import csv
import json
import math
import pathlib
import subprocess
import sys

SPHERE_M, EQUATORIAL_M, FLATTENING = 6371000.0, 6378137.0, 1 / 298.257223563
FOV_RAD = 1.0175270354911845
TO_SUN = (1, 0.6, 0.4)
# Position from the planet's centre, metres; rotation of the view, x y z w.
VIEWS = {
    "space": ((-590242.5789743908, -548860.6667341137, 7329358.48397929),
              (-0.33827257289553414, 0.16605290377244333, 0.4235632892598487, 0.82376710274613)),
    "14 km": ((305276.72996727616, -188110.94457939256, 6375009.196021865),
              (-0.2829143316949058, 0.4861594541762392, 0.715227957625793, 0.41479806492692667)),
    "ground": ((463322.75031194673, -297160.69451678684, 6347179.7956935875),
               (-0.3619906531013846, 0.5978538270934407, 0.6143297195590173, 0.3662411284434047)),
}
SCENE = {
    "name": "the procedural planet",
    "volumes": [{"name": "sky", "source": "noise", "parameters": {"seed": 3, "land": 0}}],
    "sun": {"to_sun_ecef": TO_SUN},
    "image": {"width": 640, "height": 360},
    "render": {"budget_mib": 256, "probe_pixels": 0},
}


def turned_back(q, v):
    """From the camera's frame to the world's: by the inverse of the view's rotation."""
    x, y, z, w = -q[0], -q[1], -q[2], q[3]
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def height_m(p):
    """Over WGS 84, along its normal (Bowring 1985: nanometres at these heights)."""
    polar, e2 = EQUATORIAL_M * (1 - FLATTENING), FLATTENING * (2 - FLATTENING)
    across, r = math.hypot(p[0], p[1]), math.hypot(*p)
    u = math.atan2(polar * p[2] * (1 + e2 / (1 - e2) * polar / r), EQUATORIAL_M * across)
    lat = math.atan2(p[2] + e2 / (1 - e2) * polar * math.sin(u) ** 3,
                     across - e2 * EQUATORIAL_M * math.cos(u) ** 3)
    return (across * math.cos(lat) + p[2] * math.sin(lat)
            - EQUATORIAL_M * math.sqrt(1 - e2 * math.sin(lat) ** 2))


def eye(position):
    """The same height in the same direction."""
    wanted = math.hypot(*position) - SPHERE_M
    p = list(position)
    for _ in range(20):
        r = math.hypot(*p)
        p = [c * (r + wanted - height_m(p)) / r for c in p]
    return p


def path(view, count):
    position, q = VIEWS[view]
    at = eye(position)
    ahead, up, right = (turned_back(q, v) for v in ((0, 0, -1), (0, 1, 0), (1, 0, 0)))
    cameras = []
    for n in range(count):
        here = [a + 1e-3 * n * r for a, r in zip(at, right)]
        cameras.append({"eye_m": here, "target_m": [h + 1e4 * a for h, a in zip(here, ahead)],
                        "up": up, "fov_rad": FOV_RAD})
    return {"cameras": cameras}


def main(words):
    program, count, only, rest = "build/release/bin/nephoscope", 12, list(VIEWS), []
    if not words or words[0].startswith("-"):
        raise SystemExit(__doc__)
    out = pathlib.Path(words[0])
    out.mkdir(parents=True, exist_ok=True)
    left = iter(words[1:])
    for word in left:
        if word == "--nephoscope":
            program = next(left)
        elif word == "--frames":
            count = int(next(left))
        elif word == "--only":
            only = [next(left)]
        else:
            rest.append(word)
    (out / "planet.json").write_text(json.dumps(SCENE))
    tables = {}
    for view in only:
        name = view.replace(" ", "_")
        (out / f"{name}.json").write_text(json.dumps(path(view, count)))
        done = subprocess.run(
            [program, "view", str(out / "planet.json"), "--path", str(out / f"{name}.json"), "--settle",
             "--coarse", "1", "--bench", str(out / f"{name}.csv"), "--screenshot",
             str(out / f"{name}.ppm"), *rest], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"{view}\n{done.stdout}{done.stderr}")
        print(f"{view}: " + "; ".join(done.stdout.splitlines()[-5:-1]))
        with open(out / f"{name}.csv", newline="") as file:
            tables[view] = {(row["pass"], row["clock"]): row for row in csv.DictReader(file)}
    passes = sorted({key for table in tables.values() for key in table})
    print(f"\n{'median ms (worst)':24}" + "".join(f"{view:>20}" for view in only))
    for key in passes:
        cells = [tables[view].get(key) for view in only]
        print(f"{key[0] + ', ' + key[1]:24}" + "".join(
            f"{float(c['median_ms']):11.1f} ({float(c['worst_ms']):6.0f})" if c else f"{'-':>20}"
            for c in cells))


if __name__ == "__main__":
    main(sys.argv[1:])
