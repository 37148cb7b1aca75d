#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures whole processes, from start to end, beside the peers that are installed.

Usage: run.py [NAME...]. Inputs are made under build/bench. Each figure is the median of several
runs, ours and the peer's in turn. A missed target is said and is no failure.
"""

import os
import shutil
import statistics
import sys
import time
from dataclasses import dataclass
from itertools import chain
from math import cos, radians, sin
from pathlib import Path
from typing import Callable, Optional

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "build" / "bench"
TRANOS = ROOT / "build" / "release" / "tranos"
LEAST_RUNS, MOST_RUNS, ENOUGH_S = 5, 25, 2.0
SLOW_S = 10.0  # what takes longer is run once


@dataclass
class Cost:
    seconds: float
    megabytes: float


@dataclass
class Command:
    """What is run, in FOLDER, and the statuses that count as having done it."""
    argv: list
    statuses: tuple = (0,)


@dataclass
class Bench:
    name: str
    what: str
    ours: Command
    seconds: Optional[float] = None  # targets
    megabytes: Optional[float] = None
    times_peer: Optional[float] = None
    peer: Optional[Command] = None


class Failed(Exception):
    """A command that did not do what was to be measured."""


# ---- inputs

def write(name, lines):
    path = FOLDER / name
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(line + "\n" for line in lines)
    return path.name


def places(count):
    """Points of a grid, no two alike."""
    return ((i % 100, i // 100, i % 3) for i in range(count))


def point_script(name, count):
    return write(name, (f"place point xy={x},{y},{z}" for x, y, z in places(count)))


def house_script(name, count, changed):
    """Rows of posts and circles; `changed` inserts a line at the top and alters a few."""
    def lines():
        if changed:
            yield "place line xy=-5,-5 dl=1 reset"
        for i, (x, y, z) in enumerate(places(count)):
            shift = 0.25 if changed and i % 1000 == 500 else 0
            if i % 2:
                yield f"place circle center xy={x + shift},{y},{z} radius=0.4"
            else:
                yield f"place line xy={x + shift},{y},{z} dl=0,0,3 reset"
    return write(name, lines())


def without_picture(script, more=()):
    """A script of scripts/, under its name, but for its last line, which is the picture's."""
    lines = (ROOT / "scripts" / script).read_text(encoding="utf-8").splitlines()
    return write(script, [line for line in lines if "render" not in line] + list(more))


def dot_of(point):
    """Where a camera of 35 mm that stands at the right before the building sees a point, in pixels
    (docs/camera.md, "Conventions")."""
    tilt, pan = radians(12), radians(25)
    x, y, z = point[0] - 34, point[1] + 38, point[2] - 2
    right, ahead = cos(pan) * x + sin(pan) * y, cos(pan) * y - sin(pan) * x
    depth, up = cos(tilt) * ahead + sin(tilt) * z, cos(tilt) * z - sin(tilt) * ahead
    pitch = 36 / 1600
    return 799.5 + 35 / pitch * right / depth, 533 - 35 / pitch * up / depth


def traced_script(name):
    """A building of ten storeys: 200 traced edges, and the height of each storey to be found."""
    def edge(start, end, text):
        noise = ((0.31 * sum(start) + 0.17 * sum(end)) % 1) - 0.5
        dots = " ".join(f"dot={x:.3f},{y + noise:.3f}" for x, y in map(dot_of, (start, end)))
        return f"trace edge from={text[0]} to={text[1]} {dots}"

    shutil.copy(ROOT / "tests" / "language" / "photograph" / "facade.png", FOLDER)

    def lines():
        yield 'attach photo "facade.png" format=36mm,24.0075mm as tower'
        for k in range(10):
            yield f"unknown z{k} = {2.05 * (k + 1):.3f}m +- 10%"
        for z in (0, 24):
            for a, b in (((0, 0), (9, 0)), ((10, 0), (20, 0)), ((20, 0), (20, 14))):
                yield edge((*a, z), (*b, z), [f"[{x},{y},{z}]" for x, y in (a, b)])
        for x, y in ((0, 0), (10, 0), (20, 0), (20, 14)):
            yield edge((x, y, 0), (x, y, 24), [f"[{x},{y},0]", f"[{x},{y},24]"])
        for k in range(10):
            z = 2 * (k + 1)
            for x in range(1, 12):
                yield edge((1.5 * x, 0, z), (1.5 * x + 1, 0, z),
                           [f"[{1.5 * x},0,z{k}]", f"[{1.5 * x + 1},0,z{k}]"])
            for y in range(1, 9):
                yield edge((20, 1.5 * y, z), (20, 1.5 * y + 1, z),
                           [f"[20,{1.5 * y},z{k}]", f"[20,{1.5 * y + 1},z{k}]"])
        yield "calibrate"
    return write(name, lines())


def journal_of(script, name):
    run_once(tranos("run", script, "--no-output", "--journal", name))
    return name


# ---- commands

def tranos(*words, statuses=(0,)):
    return Command([str(TRANOS), *words], statuses)


def peer(program, *words, environment=()):
    found = shutil.which(program)
    return Command(["/usr/bin/env", *environment, found, *words]) if found else None


def run_once(command):
    """Runs to the end and returns what it cost. The peak memory is the child's own, as the system
    counted it, but no less than this small script's, which the child starts as a copy of."""
    quiet = [(os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0),
             (os.POSIX_SPAWN_OPEN, 1, "stdout.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644),
             (os.POSIX_SPAWN_OPEN, 2, "stderr.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)]
    start = time.perf_counter()
    child = os.posix_spawn(command.argv[0], command.argv, os.environ, file_actions=quiet)
    _, status, usage = os.wait4(child, 0)
    seconds = time.perf_counter() - start
    code = os.waitstatus_to_exitcode(status)
    if code not in command.statuses:
        said = Path("stderr.log").read_text(errors="replace").strip().splitlines()
        raise Failed(f"status {code} from {' '.join(command.argv[1:])}: {(said or ['silent'])[0]}")
    return Cost(seconds, usage.ru_maxrss / 1024)


def measure(commands):
    """The median cost of each, run in turn so that all meet the same load."""
    first = [run_once(command) for command in commands]
    costs = [[cost] if cost.seconds > SLOW_S else [] for cost in first]
    turns, spent = 0, 0.0
    while turns < LEAST_RUNS or (spent < ENOUGH_S and turns < MOST_RUNS):
        for command, once, list_ in zip(commands, first, costs):
            if once.seconds <= SLOW_S:
                list_.append(run_once(command))
                spent += list_[-1].seconds
        turns += 1
    return [Cost(statistics.median(c.seconds for c in list_),
                 statistics.median(c.megabytes for c in list_)) for list_ in costs]


# ---- the benches

def start():
    script = write("empty.trn", [])
    return Bench("start", "an empty script", tranos("run", script, "-o", "output"),
                 seconds=0.015, megabytes=30)


def points():
    script = point_script("points.trn", 100_000)
    scad = write("points.scad", (f"translate([{x},{y},{z}]) square(1);"
                                 for x, y, z in places(100_000)))
    return Bench("points", "100 000 statements (peer: OpenSCAD)",
                 tranos("run", script, "--no-output"), seconds=0.4, megabytes=120,
                 peer=peer("openscad", "-o", "points.csg", scad))


def points_lua():
    script = point_script("points.trn", 100_000)
    lua = write("points.lua", chain(
        ["local points = {}",
         "local function point(x, y, z) points[#points + 1] = {x, y, z} end"],
        (f"point({x},{y},{z})" for x, y, z in places(100_000))))
    return Bench("points_lua", "100 000 statements (peer: Lua)",
                 tranos("run", script, "--no-output"), seconds=0.4, megabytes=120,
                 peer=peer("lua5.4", lua))


def points_glb():
    script = point_script("points.trn", 100_000)
    return Bench("points_glb", "100 000 statements to GLB", tranos("run", script, "-o", "output"),
                 seconds=3)


def loop():
    script = write("loop.trn", ["for i = 1 to 1000000 { let x = (i*i + 3*i)/7 - 0.5 }"])
    lua = write("loop.lua", ["for i = 1, 1000000 do local x = (i*i + 3*i)/7 - 0.5 end"])
    return Bench("loop", "a million turns of a loop (peer: Lua)",
                 tranos("run", script, "--no-output"), times_peer=3, peer=peer("lua5.4", lua))


def dome():
    script = without_picture("cruciform_dome.trn")
    return Bench("dome", "Fig. 6, from text to GLB", tranos("run", script, "-o", "output"),
                 seconds=0.03)


def picture():
    script = without_picture("cruciform_dome.trn", ["set view phong antialias | render all"])
    return Bench("picture", "Fig. 6 and its picture, 1280×960",
                 tranos("run", script, "-o", "output"), seconds=1)


def solid_bench(script, what, seconds, program, *, export=(), words=()):
    """One of the three models beside one peer, each from its text to a file of facets."""
    ours = without_picture(f"{script}.trn", export)
    peers = ROOT / "bench" / "peers"
    other = {
        "OpenSCAD": lambda: peer("openscad", "-o", "peer.stl", *words,
                                 str(peers / f"{script}.scad")),
        "FreeCAD": lambda: peer("freecadcmd", str(peers / "freecad_models.py"),
                                environment=[f"MODEL={script}"]),
        "Blender": lambda: peer("blender", "-b", "--factory-startup", "-P",
                                str(peers / "blender_models.py"), environment=[f"MODEL={script}"]),
    }[program]()
    return Bench(script, f"{what} (peer: {program})", tranos("run", ours, "-o", "output"),
                 seconds=seconds, peer=other)


# Measured once on two cores, OpenSCAD 2021.01, FreeCAD 0.20.2, Blender 3.4.1: M1 1.42, 0.89 and
# 1.30 s; M2 42.7, 1.60 and 2.68 s, Blender's with parts counted twice; M3 above 560, 3.28 and
# 3.09 s, and so OpenSCAD is asked for one of its columns.
def m1(program="OpenSCAD"):
    return solid_bench("parish_church", "M1, windows in a church", 0.1, program)


def m2(program="OpenSCAD"):
    return solid_bench("dome_on_drum", "M2, a dome on a drum", 1.0, program)


def m3():
    return solid_bench("colonnade", "M3, of the peer's columns one", 0.15, "OpenSCAD",
                       words=("-D", "count=1"))


def m3_stl(program="FreeCAD"):
    return solid_bench("colonnade", "M3 to STL", 0.5, program, export=['export "colonnade.stl"'])


EACH_WINDOW = "for i = 0 to 999 { let x = 0.2 + 0.8*floor(i/4); let z = 1 + 2.5*(i % 4); "


def windows():
    script = write("windows.trn", [
        EACH_WINDOW + "place shape xy=x,-0.25,z dl=0.4 dl=0,0,1 dl=-0.4 reset as windows }",
        "place wall thickness=0.5m height=12m openings=windows xy=0,0,0 xy=200,0,0 reset"])
    return Bench("windows", "1 000 windows in a wall", tranos("run", script, "-o", "output"),
                 seconds=0.2)


def window_solids():
    script = write("window_solids.trn", [
        "place slab length=200m width=0.5m height=12m xy=0,0,0 as wall",
        EACH_WINDOW + "place slab length=0.4m width=0.7m height=1m xy=x,-0.1,z as windows }",
        "construct solid difference of=wall by=windows"])
    return Bench("window_solids", "1 000 slabs cut from one", tranos("run", script, "-o", "output"),
                 seconds=0.2)


def cylinders():
    script = write("cylinders.trn", chain(
        ["place slab length=50m width=2m height=2m xy=0,0,0 as slab0"],
        (f"place cylinder radius=0.15m height=3m xy={0.25 + 0.5 * i},1,-0.5 as drill{i}; "
         f"construct solid difference of=slab{i} by=drill{i} as slab{i + 1}" for i in range(100))))
    return Bench("cylinders", "100 cylinders cut from a slab in turn",
                 tranos("run", script, "-o", "output"), seconds=2)


def church():
    shutil.copytree(ROOT / "scripts" / "elements", FOLDER / "elements", dirs_exist_ok=True)
    return Bench("church", "Aghios Nikolaos Tranos, from text to GLB",
                 tranos("run", without_picture("tranos_church.trn"), "-o", "output"), seconds=3)


def from_photo():
    return Bench("from_photo", "Aghios Nikolaos Tranos, from its photograph",
                 tranos("run", str(ROOT / "scripts" / "tranos_from_photo.trn"), "-o", "output"),
                 seconds=10)


def m1_freecad():
    return m1("FreeCAD")


def m1_blender():
    return m1("Blender")


def m2_freecad():
    return m2("FreeCAD")


def m2_blender():
    return m2("Blender")


def m3_stl_blender():
    return m3_stl("Blender")


def traces():
    script = traced_script("traces.trn")
    return Bench("traces", "200 traced lines, 10 unknowns",
                 tranos("run", script, "--no-output"), seconds=0.05)


def replay():
    journal = journal_of(point_script("replay.trn", 50_000), "replay.jsonl")
    return Bench("replay", "replay of 100 000 key-ins", tranos("replay", journal), seconds=1)


def diff():
    before = house_script("before.trn", 10_000, changed=False)
    after = house_script("after.trn", 10_000, changed=True)
    return Bench("diff", "diff of two models of 10 000 elements",
                 tranos("diff", before, after, statuses=(0, 1)), seconds=0.5)


BENCHES: dict[str, Callable[[], Bench]] = {
    make.__name__: make
    for make in (start, points, points_lua, points_glb, loop, dome, picture, m1, m1_freecad,
                 m1_blender, m2, m2_freecad, m2_blender, m3, m3_stl, m3_stl_blender, windows,
                 window_solids, cylinders, church, from_photo, traces, replay, diff)}


# ---- the table

def time_text(seconds):
    return f"{seconds * 1000:.1f} ms" if seconds < 0.1 else f"{seconds:.2f} s"


def row(*cells):
    widths = (40, 18, 18, 18, 7, 0)
    print("  ".join(cell.ljust(width) for cell, width in zip(cells, widths)).rstrip(), flush=True)


def targets_text(bench):
    parts = []
    if bench.seconds:
        parts.append(time_text(bench.seconds))
    if bench.megabytes:
        parts.append(f"{bench.megabytes:.0f} MB")
    if bench.times_peer:
        parts.append(f"{bench.times_peer:g} × peer")
    return "≤ " + ", ".join(parts)


def cost_text(cost):
    return f"{time_text(cost.seconds)}, {cost.megabytes:.0f} MB"


def verdict(bench, ours, theirs):
    missed = ((bench.seconds and ours.seconds > bench.seconds)
              or (bench.megabytes and ours.megabytes > bench.megabytes)
              or (bench.times_peer and theirs
                  and ours.seconds > bench.times_peer * theirs.seconds))
    if bench.times_peer and not theirs:
        return "no peer"
    return "MISSED" if missed else "ok"


def ratio_text(bench, ours, theirs):
    """Of our time to the peer's, or to the target where there is no peer."""
    other = theirs.seconds if theirs else bench.seconds
    return f"{ours.seconds / other:.2f}" if other else "-"


def report(make):
    bench = make()
    costs = measure([bench.ours] + ([bench.peer] if bench.peer else []))
    ours, theirs = costs[0], costs[1] if bench.peer else None
    row(bench.what, targets_text(bench), cost_text(ours), cost_text(theirs) if theirs else "-",
        ratio_text(bench, ours, theirs), verdict(bench, ours, theirs))


def main():
    names = sys.argv[1:] or list(BENCHES)
    unknown = [name for name in names if name not in BENCHES]
    if unknown:
        print(f"no bench {unknown[0]}; there are {' '.join(BENCHES)}", file=sys.stderr)
        return 2
    (FOLDER / "output").mkdir(parents=True, exist_ok=True)
    os.chdir(FOLDER)
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; medians of whole processes")
    row("figure", "target", "measured", "peer", "ratio", "")
    status = 0
    for name in names:
        try:
            report(BENCHES[name])
        except (Failed, OSError) as error:
            print(f"{name}: could not be measured: {error}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
