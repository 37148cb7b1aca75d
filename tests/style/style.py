#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the tree to what docs/architecture.md says of its rooms.

Usage: style.py ROOT. Prints a line for each breach; the status is 1 if there is one.
"""

import re
import sys
from fnmatch import fnmatchcase
from pathlib import Path

# Which rooms a room may include, besides itself. An arrow never runs upward.
ROOMS = {
    "stdlib": set(),
    "geom": set(),
    "camera": {"geom"},
    "model": {"geom", "camera"},
    "interp": {"model", "camera", "geom", "stdlib"},
    "session": {"interp", "model", "camera", "geom"},
    "output": {"model", "camera", "geom"},
    "app": {"geom", "camera", "model", "interp", "session", "output", "stdlib"},
}

# Beginnings of included names and the files that are their doors; the first that fits counts.
# In the rooms every include is either the standard library's or listed here.
DOORS = [
    ("Eigen/", ["*"]),
    ("tl/expected.hpp", ["*"]),
    ("CGAL/", ["geom/*.cpp", "geom/exact_corners.h"]),
    ("hersheyfont.h", ["geom/stroke_font.cpp"]),
    ("opencv2/", ["camera/*.cpp"]),
    ("ceres/", ["camera/refinement.cpp"]),
    ("glog/", ["camera/refinement.cpp"]),
    ("xxhash.h", ["model/hash.cpp"]),
    ("utf8proc.h", ["interp/*.cpp"]),
    ("tiny_gltf.h", ["output/gltf.cpp", "output/gltf_tables.h"]),
    ("embree3/", ["output/ray_scene.cpp"]),
    ("tbb/", ["output/*.cpp"]),
    ("png.h", ["output/png.cpp", "camera/photo.cpp"]),
    ("jpeglib.h", ["camera/photo.cpp"]),
    ("tiffio.h", ["camera/photo.cpp"]),
    ("libexif/", ["camera/photo.cpp"]),
    ("fmt/", ["*.cpp"]),
    ("nlohmann/json_fwd.hpp", ["camera/json_text.h", "output/*", "session/*", "app/*", "*.cpp"]),
    ("nlohmann/", ["*.cpp"]),
    ("CLI/", ["app/*.cpp"]),
    # Effects are the program's alone: the rooms below reach outward through the Host.
    ("sys/", ["app/*.cpp"]),
    ("linux/", ["app/*.cpp"]),
    ("fcntl.h", ["app/*.cpp"]),
    ("unistd.h", ["app/*.cpp"]),
    ("dirent.h", ["app/*.cpp"]),
    ("malloc.h", ["app/memory_limit.cpp"]),
    ("filesystem", ["app/*"]),
    ("fstream", ["app/*.cpp"]),
    ("iostream", ["app/*.cpp"]),
    ("chrono", ["app/*.cpp"]),
    ("random", ["app/*.cpp"]),
]

SOURCES = {".h", ".cpp", ".def", ".py", ".mjs", ".js", ".ts"}
TEXTS = SOURCES | {".md", ".txt", ".cmake", ".json", ".trn", ".yaml", ".yml", ".html", ".css", ""}
SKIPPED_FOLDERS = {".git", "build", "out", "node_modules", "__pycache__"}
MAX_LINES = 700
LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"
UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX)\b")
MACHINE_PATH = re.compile(r"(?<![\w.])/(work|home|root)/\w")
SCRATCH_PATH = re.compile(r"(?<![\w.])/tmp/\w")
EMPTY_NAMES = re.compile(r"(^|_)(utils?|helpers?|common|manager|misc)(_|$)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def files_below(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if path.is_file() and not SKIPPED_FOLDERS.intersection(parts):
            yield path.relative_to(root)


def check_layer(room, quoted):
    target = quoted.split("/")[0]
    if target not in ROOMS or "/" not in quoted:
        return f'"{quoted}" does not begin with a room'
    if target != room and target not in ROOMS[room]:
        return f"{room} may not know {target}"
    return None


def check_door(name, included):
    for prefix, doors in DOORS:
        if included == prefix or (prefix.endswith("/") and included.startswith(prefix)):
            if any(fnmatchcase(name, door) for door in doors):
                return None
            return f"<{included}> belongs in {', '.join(doors)}"
    if "/" in included or "." in included:
        return f"<{included}> has no door in tests/style/style.py"
    return None


def check_includes(name, text):
    room = name.split("/")[0]
    if room not in ROOMS:
        return
    for mark, included in INCLUDE.findall(text):
        yield check_layer(room, included) if mark == '"' else check_door(name, included)


def check_source(path, text):
    lines = text.split("\n")
    first = 1 if lines[0].startswith("#!") else 0
    if len(lines) <= first or LICENCE not in lines[first]:
        yield "does not start with the SPDX line"
    if len(lines) > MAX_LINES:
        yield f"has more than {MAX_LINES} lines"
    if EMPTY_NAMES.search(path.stem):
        yield "is named after no thing"
    if path.suffix == ".h" and "#pragma once" not in text:
        yield "lacks #pragma once"


def check_words(name, text):
    patterns = [UNFINISHED, MACHINE_PATH]
    if not name.startswith("tests/"):
        patterns.append(SCRATCH_PATH)
    for pattern in patterns:
        found = pattern.search(text)
        if found:
            yield f"contains {found.group()}"


def check_built(root, path):
    """A source that no list names would rot unseen."""
    for folder in path.parents:
        lists = root / folder / "CMakeLists.txt"
        if lists.exists() and folder != Path("."):
            if not re.search(rf"\b{re.escape(path.stem)}\b", lists.read_text()):
                yield f"is not named in {folder}/CMakeLists.txt"
            return


def check_file(root, path):
    name = path.as_posix()
    text = (root / path).read_bytes().decode("utf-8", errors="replace")
    if path.suffix in SOURCES or text.startswith("#!"):
        yield from check_source(path, text)
    if path.suffix in {".h", ".cpp", ".def"}:
        yield from check_includes(name, text)
    if path.suffix == ".cpp":
        yield from check_built(root, path)
    if path.suffix in TEXTS and not name.startswith("tests/style/") and name != "LICENSE":
        yield from check_words(name, text)


def breaches(root):
    """Every breach in the tree, as "file: what"."""
    return [f"{path.as_posix()}: {breach}" for path in files_below(root)
            for breach in check_file(root, path) if breach]


def main():
    found = breaches(Path(sys.argv[1]))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
