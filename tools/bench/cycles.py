#!/usr/bin/env python3
"""The reference path tracer against Blender's Cycles: the same cloud, view, sun and sky.

  tools/bench/cycles.py [CLOUD.vdb ...] [--pair] [--out DIR] [options; --help]

For each file (y up, grid "density", one world unit = 1 m), and for two clouds 26 km apart that
make_samples writes (--pair), both programs draw pictures of some seeds. Printed, and written to
DIR/cycles.json: CPU s (user + system) and relative mean square error (compare's measure; from the
spread of the seeds, each program about its own mean), CPU s at the error that Cycles reached,
whether the two means are one picture within their noise, and peak memory above that of a process
that draws next to nothing, beside the bytes of the sparse tree in the file. Cycles stops at
--bounces scatterings; ours does not, so that its picture is brighter (by 1.5 % for the Disney cloud,
11 % for the pair): with --agree, one more run with 1024 bounces and a quarter of the step tells what is left of that.

Needs Blender (apt-get install blender) and make_samples; else Python's standard library.
"""
import argparse
import array
import json
import math
import os
import pathlib
import re
import subprocess
import sys

from charts import run

HERE = pathlib.Path(__file__).resolve().parent
IRRADIANCE, SKY = [10.0, 9.5, 8.8], [0.21, 0.33, 0.60]
ASYMMETRY, SUN_RADIUS_RAD, FOV_RAD = 0.85, 0.004675, 0.6
SUN_AZIMUTH_DEG, SUN_ELEVATION_DEG = 250, 40
PAIR = {"density_scale": 0.06, "eye_m": [-6258, 894, 900], "target_m": [-510, -816, 1000]}


def measured(command, log):
    """CPU s and peak MiB of a command; its output goes to a file, and is returned."""
    with open(log, "w+") as out:
        child = subprocess.Popen([str(w) for w in command], stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read()
    if child.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{text}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def read_pfm(path):
    with open(path, "rb") as file:
        lines = []
        while len(lines) < 3:
            line = file.readline()
            if not line.startswith(b"#"):
                lines.append(line.split())
        values = array.array("f")
        values.fromfile(file, 3 * int(lines[1][0]) * int(lines[1][1]))  # the scene comes after
    if float(lines[2][0]) > 0:
        values.byteswap()
    return values


class Pictures:
    """Of some seeds: their mean, and the relative mean square error of one of them."""

    def __init__(self, paths):
        all_values = [read_pfm(path) for path in paths]
        n, self.count = len(all_values[0]), len(all_values)
        self.mean = [sum(v) / self.count for v in zip(*all_values)]
        self.floor2 = (0.01 * sum(self.mean) / n) ** 2
        # Half sums of squares of differences: unbiased about the mean that nobody knows.
        off = [[(v - m) ** 2 * self.count / (self.count - 1) for v, m in zip(values, self.mean)]
               for values in all_values]
        self.variance = [sum(v) / self.count for v in zip(*off)]
        each = [self.relative(o) for o in off]
        self.mse = sum(each) / self.count
        self.mse_spread = math.sqrt(sum((e - self.mse) ** 2 for e in each) /
                                    (self.count - 1) / self.count)

    def relative(self, squares):
        return sum(s / (m * m + self.floor2) for s, m in zip(squares, self.mean)) / len(squares)


def agreement(ours, theirs):
    """Where there is cloud: ours over theirs - 1, its standard error; and the squares of the
    differences of all pixels over what the noise of both explains (1: the same picture)."""
    cloud = [i for i, v in enumerate(ours.variance) if v > 0 or theirs.variance[i] > 0]
    noise = [ours.variance[i] / ours.count + theirs.variance[i] / theirs.count for i in cloud]
    apart = [ours.mean[i] - theirs.mean[i] for i in cloud]
    level = sum(theirs.mean[i] for i in cloud)
    return {"ratio_minus_1": sum(apart) / level, "standard_error": math.sqrt(sum(noise)) / level,
            "squares_over_noise": sum(a * a for a in apart) / sum(noise)}


def to_sun():
    azimuth, elevation = math.radians(SUN_AZIMUTH_DEG), math.radians(SUN_ELEVATION_DEG)
    return [math.sin(azimuth) * math.cos(elevation), math.cos(azimuth) * math.cos(elevation),
            math.sin(elevation)]


def our_scene(view, o, volumes, spp, seed):
    return {"volumes": volumes, "planet": "none",
            "camera": {"look_from_m": view["eye_m"], "look_at_m": view["target_m"],
                       "fov_rad": FOV_RAD},
            "sun": {"to_sun_ecef": to_sun(), "irradiance_W_per_m2_nm": IRRADIANCE},
            "sky": {f"{part}_W_per_m2_sr_nm": SKY for part in ("zenith", "horizon", "below")},
            "image": {"width": o.width, "height": o.height},
            "render": {"seed": seed, "engine": "reference", "paths": {"spp": spp}}}


def our_volume(vdb, view):
    return {"source": "openvdb", "files": [str(vdb)], "co_albedo": [0, 0, 0],
            "parameters": {"up": "y", "density_scale": view["density_scale"]},
            "phase": {"kind": "henyey_greenstein", "asymmetry": ASYMMETRY}}


def draw_ours(name, view, o, vdb, spp, seeds):
    paths, cpu_s, peak_mib = [], [], 0
    for seed in range(1, seeds + 1):
        stem = o.out / f"{name}_ours_{spp}_{seed}"
        volumes = [our_volume(vdb, view)]
        stem.with_suffix(".json").write_text(json.dumps(our_scene(view, o, volumes, spp, seed)))
        spent_s, peak, _ = measured([o.nephoscope, "render", stem.with_suffix(".json"), "-o",
                                     stem.with_suffix(".pfm")], stem.with_suffix(".log"))
        paths.append(stem.with_suffix(".pfm"))
        cpu_s.append(spent_s)
        peak_mib = max(peak_mib, peak)
    return paths, cpu_s, peak_mib


def empty_ours(o):
    """A puff of 40 voxels that no path meets: what a process with all its libraries takes."""
    run(o.make_samples, o.out, "--like", "half")
    view = {"eye_m": [0, -1e5, 0], "target_m": [0, -2e5, 0], "density_scale": 1}
    return draw_ours("empty", view, o, o.out / "half.vdb", 1, 1)[2]


def draw_theirs(name, view, o, vdb, spp, seeds, bounces, step_rate):
    stem = o.out / f"{name}_cycles_{spp}_{bounces}"
    paths = [stem.parent / f"{stem.name}_{seed}.pfm" for seed in range(1, seeds + 1)]
    job = {"vdb": str(vdb) if vdb else "", "grid": "density", "up": "y", "asymmetry": ASYMMETRY,
           "density_scale": view["density_scale"], "eye_m": view["eye_m"],
           "target_m": view["target_m"], "vertical_fov_rad": FOV_RAD, "irradiance": IRRADIANCE,
           "sky": SKY, "to_sun": to_sun(), "sun_radius_rad": SUN_RADIUS_RAD, "width": o.width,
           "height": o.height, "bounces": bounces, "step_rate": step_rate, "light_threshold": 0.01,
           "spp": spp, "seeds": list(range(1, seeds + 1)), "pictures": [str(p) for p in paths],
           "result": str(stem.parent / f"{stem.name}_result.json")}
    task = stem.parent / f"{stem.name}.json"
    task.write_text(json.dumps(job))
    _, peak_mib, _ = measured(
        [o.blender, "-b", "--factory-startup", "--python", HERE / "cycles_blender.py", "--", task],
        task.with_suffix(".log"))
    result = json.loads(pathlib.Path(job["result"]).read_text())
    return paths, result["cpu_s"], peak_mib, result["blender"]


def compare(name, vdb, view, o):
    ours_paths, ours_s, ours_mib = draw_ours(name, view, o, vdb, o.spp, o.seeds)
    start_s = min(draw_ours(name, view, o, vdb, 1, 2)[1])
    ours = Pictures(ours_paths)
    paths, theirs_s, theirs_mib, version = draw_theirs(name, view, o, vdb, o.cycles_spp, o.seeds,
                                                       o.bounces, 1)
    theirs = Pictures(paths)
    # Error falls with the paths, what it takes to start does not.
    goal_spp = o.spp * ours.mse / theirs.mse
    per_path_s = (min(ours_s) - start_s) / (o.spp - 1)
    ours_at_goal_s = start_s + per_path_s * (goal_spp - 1)
    tree = re.search(r"The tree takes (\d+) bytes", run(o.nephoscope, "info", vdb))
    row = {"scene": name, "size": [o.width, o.height], "blender": version,
           "ours": {"spp": o.spp, "cpu_s": ours_s, "start_s": start_s, "relative_mse": ours.mse,
                    "relative_mse_standard_error": ours.mse_spread,
                    "peak_mib_above_empty": ours_mib - o.empty_ours_mib},
           "cycles": {"spp": o.cycles_spp, "bounces": o.bounces, "cpu_s": theirs_s,
                      "relative_mse": theirs.mse,
                      "relative_mse_standard_error": theirs.mse_spread,
                      "peak_mib_above_empty": theirs_mib - o.empty_cycles_mib},
           "cpu_s_at_the_error_of_cycles": ours_at_goal_s,
           "cpu_ratio_at_equal_error": ours_at_goal_s / min(theirs_s),
           "tree_mib": int(tree.group(1)) / 2**20, "agreement": agreement(ours, theirs)}
    if o.agree:
        paths = draw_theirs(name, view, o, vdb, o.cycles_spp, o.seeds, 1024, 0.25)[0]
        row["agreement_1024_bounces"] = agreement(ours, Pictures(paths))
    return row


def show(row):
    print(f"\n{row['scene']}, {row['size'][0]} x {row['size'][1]}, Blender {row['blender']}")
    print("           paths/px    CPU s   relative MSE         CPU s at   memory above  over the")
    print("                                                  equal error    empty, MiB      tree")
    for name, at_goal in (("ours", row["cpu_s_at_the_error_of_cycles"]),
                          ("cycles", min(row["cycles"]["cpu_s"]))):
        r = row[name]
        print(f"  {name:8} {r['spp']:8} {min(r['cpu_s']):8.2f}   {r['relative_mse']:.4f} +- "
              f"{r['relative_mse_standard_error']:.4f} {at_goal:10.2f} "
              f"{r['peak_mib_above_empty']:14.0f} "
              f"{r['peak_mib_above_empty'] / row['tree_mib']:9.1f}")
    print(f"  CPU at equal error, ours over Cycles: {row['cpu_ratio_at_equal_error']:.3f}")
    for key in ("agreement", "agreement_1024_bounces"):
        if key in row:
            a = row[key]
            print(f"  {key.replace('_', ' ')}: cloud pixels {100 * a['ratio_minus_1']:+.2f} +- "
                  f"{100 * a['standard_error']:.2f} %, squares {a['squares_over_noise']:.2f} of noise")


def file_view(o, vdb):
    """The view and the density scale that the program works out for a file."""
    text = run(o.nephoscope, "render", vdb, "--size", "64x36", "--probe-pixels", "0", "--up", "y",
               "-o", o.out / "view.pfm")
    numbers = r"([-\d.e+]+),([-\d.e+]+),([-\d.e+]+)"
    view = re.search(f"--look-from {numbers} --look-at {numbers}", text)
    scale = re.search(r"density x ([\d.e+-]+) 1/m", text)
    if not view or not scale:
        raise SystemExit(f"{vdb}: no view or no density scale in\n{text}")
    values = [float(v) for v in view.groups()]
    return {"eye_m": values[:3], "target_m": values[3:], "density_scale": float(scale.group(1))}


def options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vdb", nargs="*", type=pathlib.Path)
    parser.add_argument("--pair", action="store_true", help="two clouds 26 km apart as well")
    parser.add_argument("--agree", action="store_true", help="Cycles with 1024 bounces as well")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/cycles"))
    parser.add_argument("--nephoscope", default="build/release/bin/nephoscope")
    parser.add_argument("--make-samples", default="build/release/bin/make_samples")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--cycles-spp", type=int, default=16)
    parser.add_argument("--bounces", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=8)
    o = parser.parse_args()
    if not o.vdb and not o.pair:
        parser.error("a VDB file, or --pair")
    if o.seeds < 2 or o.spp < 2:
        parser.error("--seeds and --spp: 2 at least")
    o.width, o.height = map(int, o.size.split("x"))
    o.out = o.out.resolve()
    return o


def main():
    o = options()
    o.out.mkdir(parents=True, exist_ok=True)
    o.empty_ours_mib = empty_ours(o)
    nothing = {"density_scale": 1, "eye_m": [0, 0, 0], "target_m": [0, 1, 0]}
    o.empty_cycles_mib = draw_theirs("empty", nothing, o, None, 1, 2, o.bounces, 1)[2]
    scenes = [(path.stem, path.resolve(), None) for path in o.vdb]
    if o.pair:
        run(o.make_samples, o.out, "--only", "pair", "--force")
        scenes.append(("pair", o.out / "pair.vdb", PAIR))
    rows = []
    for name, path, view in scenes:
        rows.append(compare(name, path, view or file_view(o, path), o))
        show(rows[-1])
        (o.out / "cycles.json").write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
