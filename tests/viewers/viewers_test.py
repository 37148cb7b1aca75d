# SPDX-License-Identifier: GPL-3.0-or-later
"""A textured model in other programs: Chromium with three.js and Blender render it through its own camera, and what they
show of the facade is held against the photograph. PROGRAM [--three FOLDER]; a program that is missing is skipped."""

import functools
import http.server
import math
import os
import shutil
import struct
import subprocess
import sys
import threading
import unittest
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "app"))
import harness  # noqa: E402

SIZE = WIDTH, HEIGHT = 484, 319
F_MM, FORMAT_MM = 33.33, (40.5, 40.5 * HEIGHT / WIDTH)
OMEGA, PHI, KAPPA = (math.radians(angle) for angle in (8, 20, 1.5))
POSITION = (9, -14, 2)
EDGES = [((0, 0, 0), (8, 0, 0)), ((0, 0, 5), (8, 0, 5)), ((0, 0, 0), (0, 0, 5)), ((8, 0, 0), (8, 0, 5)),
         ((8, 0, 0), (8, 6, 0)), ((8, 0, 5), (8, 6, 5)), ((8, 6, 0), (8, 6, 5))]


def dot_of(point):
    """Where the camera puts a point (docs/camera.md)."""
    cw, sw, cp, sp = math.cos(OMEGA), math.sin(OMEGA), math.cos(PHI), math.sin(PHI)
    ck, sk = math.cos(KAPPA), math.sin(KAPPA)
    away = [p - c for p, c in zip(point, POSITION)]
    along = [sum(a * b for a, b in zip(row, away)) for row in
             ((cp, sp, 0), (-sw * sp, sw * cp, -cw), (-cw * sp, cw * cp, sw))]
    x, y = ck * along[0] - sk * along[1], sk * along[0] + ck * along[1]
    return tuple(F_MM * v / along[2] / (mm / px) + (px - 1) / 2
                 for v, mm, px in zip((x, y), FORMAT_MM, SIZE))


def script():
    traces = "\n".join(
        "trace edge from=[{},{},{}] to=[{},{},{}] dot={:.9f},{:.9f} dot={:.9f},{:.9f}".format(*a, *b, *dot_of(a), *dot_of(b))
        for a, b in EDGES)
    return f"""
mt="brick"
place slab length=8m width=6m height=5m xy=0,0,0
place camera f={F_MM}mm format={FORMAT_MM[0]}mm,{FORMAT_MM[1]:.9f}mm size={WIDTH},{HEIGHT} omega=8deg phi=20deg kappa=1.5deg xy=9,-14,2 as paper
render photo camera=paper stains=0.5 seed=3 file="photo.png" as p
attach photo p format={FORMAT_MM[0]}mm,{FORMAT_MM[1]:.9f}mm as fire
{traces}
calibrate
construct facade front xy=0,0 xy=8,0
construct facade east xy=8,0 xy=8,6
construct orthophoto facade=front pixel=1cm photo=fire
construct orthophoto facade=east pixel=1cm photo=fire
delete of=paper
"""


def pixels_of(path):
    """Rows of (red, green, blue) of a PNG of 8 bits, with or without alpha."""
    data = Path(path).read_bytes()
    width, height, _, kind = struct.unpack(">IIBB", data[16:26])
    packed, at = b"", 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if name == b"IDAT" else b""
        at += length + 12
    raw, step = zlib.decompress(packed), {2: 3, 6: 4}[kind]
    rows, before = [], bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        rule, row = raw[start], bytearray(raw[start + 1:start + 1 + width * step])
        for i in range(len(row)):
            left, up, corner = row[i - step] if i >= step else 0, before[i], before[i - step] if i >= step else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda value: abs(guess - value))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[rule]) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, len(row), step)])
        before = row
    return rows


def inside(dot, corners, margin_px):
    """Whether a dot lies in a convex outline, this far from its border."""
    sides = []
    for a, b in zip(corners, corners[1:] + corners[:1]):
        length = math.dist(a, b)
        sides.append(((b[0] - a[0]) * (dot[1] - a[1]) - (b[1] - a[1]) * (dot[0] - a[0])) / length)
    return all(side > margin_px for side in sides) or all(side < -margin_px for side in sides)


class Viewers(harness.ProgramTest):
    three = ""

    def setUp(self):
        super().setUp()
        ran = self.run_script(script())
        self.assertEqual(ran.status, 0, ran.err)
        self.photo = pixels_of(self.folder / "out/photo.png")

    def compare(self, rendered, what):
        """The mean difference in levels of 255 over the facade, and the shift that makes it least."""
        self.assertEqual((len(rendered[0]), len(rendered)), SIZE)
        corners = [dot_of(p) for p in ((0, 0, 0), (8, 0, 0), (8, 0, 5), (0, 0, 5))]
        places = [(x, y) for y in range(3, HEIGHT - 3) for x in range(3, WIDTH - 3) if inside((x, y), corners, 4)]
        grey = [[sum(pixel) / 3 for pixel in row] for row in rendered]
        truth = [[sum(pixel) / 3 for pixel in row] for row in self.photo]

        def squares(dx, dy):
            return sum((grey[y + dy][x + dx] - truth[y][x]) ** 2 for x, y in places) / len(places)

        def vertex(before, here, after):
            return (before - after) / (2 * (before - 2 * here + after))

        here = squares(0, 0)
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            self.assertGreater(squares(dx, dy), here, f"{what}: the facade is shifted by a pixel")
        shift = (vertex(squares(-1, 0), here, squares(1, 0)), vertex(squares(0, -1), here, squares(0, 1)))
        mean = sum(abs(grey[y][x] - truth[y][x]) for x, y in places) / len(places)
        spread = (sum(truth[y][x] ** 2 for x, y in places) / len(places)
                  - (sum(truth[y][x] for x, y in places) / len(places)) ** 2) ** 0.5
        print(f"{what}: {mean:.2f} levels from the photograph in the mean over {len(places)} px of the facade "
              f"(whose own deviation is {spread:.1f}), shifted by {shift[0]:+.3f}, {shift[1]:+.3f} px")
        self.assertLess(mean, 0.5 * spread)
        self.assertLess(math.hypot(*shift), 0.25)

    def test_chromium_with_three(self):
        chromium = shutil.which("chromium")
        if not chromium or not (Path(self.three) / "build/three.module.js").is_file():
            self.skipTest("Chromium or three.js is missing")
        shutil.copy(HERE / "three.html", self.folder)
        os.symlink(Path(self.three).resolve(), self.folder / "three")
        handler = functools.partial(QuietHandler, directory=str(self.folder))
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            subprocess.run(
                [chromium, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                 "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-device-scale-factor=1",
                 f"--user-data-dir={self.folder / 'profile'}", f"--window-size={WIDTH},{HEIGHT + 200}",
                 "--virtual-time-budget=20000", f"--screenshot={self.folder / 'three.png'}",
                 f"http://127.0.0.1:{server.server_port}/three.html?file=out/script.glb&width={WIDTH}&height={HEIGHT}"],
                check=True, capture_output=True, timeout=180)
            server.shutdown()
        self.compare(pixels_of(self.folder / "three.png")[:HEIGHT], "Chromium with three.js")

    def test_blender(self):
        blender = shutil.which("blender")
        if not blender:
            self.skipTest("Blender is missing")
        ended = subprocess.run(
            [blender, "--background", "--factory-startup", "--python", HERE / "blender_render.py", "--",
             self.folder / "out/script.glb", self.folder / "blender.png", str(WIDTH), str(HEIGHT)],
            check=False, capture_output=True, timeout=300, env={"PATH": "/usr/bin:/bin", "HOME": str(self.folder)})
        self.assertTrue((self.folder / "blender.png").is_file(), ended.stdout[-2000:] + ended.stderr[-2000:])
        self.compare(pixels_of(self.folder / "blender.png"), "Blender")


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


if __name__ == "__main__":
    if "--three" in sys.argv:
        at = sys.argv.index("--three")
        Viewers.three = sys.argv[at + 1]
        del sys.argv[at:at + 2]
    harness.main()
