#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recovers scripts/tranos_from_photo.trn by as many hands as are asked for, and says how far off.

Each seed is a hand that traces half a pixel off. Told are the control points' errors in per cent of
the building's length, and in how many runs the eleven parameters of the camera lie in their joint
95 % ellipsoid. `--write-docs docs` writes the table into docs/camera.md.
"""

import argparse
import json
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TRANOS = ROOT / "build" / "release" / "tranos"
SCRIPT = ROOT / "scripts" / "tranos_from_photo.trn"
CHI2_11_95 = 19.675  # the 95 % quantile of chi-squared, 11 degrees of freedom
FIRST_LEFT_OUT, NEXT = "# ---- 5.", "# ---- 6."  # the church that is placed takes no part
BEGIN, END = "<!-- generated: hands -->\n", "<!-- end: hands -->\n"


@dataclass
class Run:
    errors: list  # of the control points, per cent
    distance2: float  # of the camera from the true one, by its own covariance
    seconds: float


def parameters(camera):
    """In the order and the units of the covariance: mm, degrees, metres."""
    return [camera["f_mm"], camera["aspect"], *camera["principal_mm"], camera["skew_deg"],
            camera["omega_deg"], camera["phi_deg"], camera["kappa_deg"], *camera["position_m"]]


def mahalanobis2(difference, covariance):
    """d' C^-1 d, by the Cholesky factor of C."""
    size = len(difference)
    factor = [[0.0] * size for _ in range(size)]
    solved = []
    for i in range(size):
        for j in range(i + 1):
            rest = covariance[i][j] - sum(factor[i][k] * factor[j][k] for k in range(j))
            factor[i][j] = rest ** 0.5 if i == j else rest / factor[j][j]
        known = sum(factor[i][k] * solved[k] for k in range(i))
        solved.append((difference[i] - known) / factor[i][i])
    return sum(x * x for x in solved)


def shortened(folder):
    """The script without what it builds of the results, in a folder with what it uses."""
    shutil.copytree(SCRIPT.parent / "elements", folder / "elements")
    text = SCRIPT.read_text(encoding="utf-8")
    before, rest = text.split(FIRST_LEFT_OUT)
    copy = folder / SCRIPT.name
    copy.write_text(before + NEXT + rest.split(NEXT)[1], encoding="utf-8")
    return copy


def recover(script, seed, edges, times):
    with tempfile.TemporaryDirectory() as folder:
        start = time.monotonic()
        done = subprocess.run(
            [TRANOS, "run", script, "-D", f"seed={seed}", "-D", f"edges={edges}", "-D",
             f"times={times}", "--json", "--threads", "1", "-o", folder],
            capture_output=True, text=True, check=False)
        seconds = time.monotonic() - start
        if done.returncode not in (0, 4):  # 4: an assertion failed, which counts as it is
            sys.exit(f"seed {seed}: {done.stderr}")
        found = {camera["name"]: camera for camera in json.loads(done.stdout)["cameras"]}
    told = re.search(r"off by, in % of the length: \[(.*)\]", done.stderr + done.stdout)
    fire, true = parameters(found["fire"]), parameters(found["envelope"])
    return Run([float(error) for error in told[1].split(",")],
               mahalanobis2([a - b for a, b in zip(fire, true)], found["fire"]["covariance"]),
               seconds)


def row(edges, times, runs):
    worst = sorted(max(run.errors) for run in runs)
    every = [error for run in runs for error in run.errors]
    inside = sum(run.distance2 <= CHI2_11_95 for run in runs)
    return (f"| {edges} | {484 * times} × {319 * times} | {len(runs)} | "
            f"{statistics.median(every):.2f} % | {worst[-(-95 * len(worst) // 100) - 1]:.2f} % | "
            f"{inside} of {len(runs)} | {statistics.median(run.seconds for run in runs):.1f} s |\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--times", type=int, default=1, help="484 x 319 pixels, or so many times that")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--write-docs", metavar="FOLDER")
    options = parser.parse_args()
    table = ("| edges | photograph | hands | median of all | 95th percentile of the worst | camera "
             "in its ellipsoid | a run |\n|---|---|---|---|---|---|---|\n")
    with ThreadPoolExecutor(options.jobs) as pool, tempfile.TemporaryDirectory() as folder:
        script = shortened(Path(folder))
        for edges in ("traced", "detected"):
            seeds = range(1, options.seeds + 1)
            runs = list(pool.map(lambda seed: recover(script, seed, edges, options.times), seeds))
            table += row(edges, options.times, runs)
            print(table.splitlines()[-1], flush=True)
    if options.write_docs:
        path = Path(options.write_docs) / "camera.md"
        text = path.read_text(encoding="utf-8")
        before, rest = text.split(BEGIN)
        path.write_text(before + BEGIN + table + END + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    main()
