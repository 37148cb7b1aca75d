#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the documents' pictures: runs scripts and makes what they render smaller.

usage: docs/images/make.py TRANOS [SCRIPT.trn...]    (without scripts: those that have one)
"""
import collections
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
SCRIPTS = HERE.parent.parent / "scripts"
MAX_BYTES = 200_000  # of a picture, as the documents' test has it
SIGNATURE = b"\x89PNG\r\n\x1a\n"


def chunks(png):
    """The (type, data) pairs of a PNG."""
    at = len(SIGNATURE)
    while at < len(png):
        (size,) = struct.unpack_from(">I", png, at)
        yield png[at + 4 : at + 8], png[at + 8 : at + 8 + size]
        at += size + 12


def paeth(left, up, corner):
    """The neighbour that is nearest to left + up - corner."""
    guess = left + up - corner
    return min((left, up, corner), key=lambda value: abs(guess - value))


def unfilter(kind, line, above, step):
    """Undoes one line's filter in place; `above` is the line before it."""
    if kind == 0:
        return
    for i, byte in enumerate(line):
        left = line[i - step] if i >= step else 0
        corner = above[i - step] if i >= step else 0
        guess = (0, left, above[i], (left + above[i]) // 2)[kind] if kind < 4 else paeth(left, above[i], corner)
        line[i] = (byte + guess) & 255


def read_png(png):
    """Width, channels and the lines of an 8-bit picture."""
    parts = list(chunks(png))
    width, height, depth, colour = struct.unpack_from(">IIBB", parts[0][1])
    assert depth == 8 and colour in (2, 6), "8 bits of RGB or RGBA"
    step = 3 if colour == 2 else 4
    data = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    lines, above, stride = [], bytearray(width * step), width * step + 1
    for y in range(height):
        line = bytearray(data[y * stride + 1 : (y + 1) * stride])
        unfilter(data[y * stride], line, above, step)
        lines.append(line)
        above = line
    return width, step, lines


# Pictures that are not a script's first numbered one: the script, the options that it is run with,
# the files that it writes, side by side, and how many of their pixels in x and in y become one.
NAMED = {
    "tranos_from_photo": ("tranos_from_photo", (), ["church.png"], 2),
    "tranos_photograph": ("tranos_from_photo", (), ["tranos_1917.png"], 1),
    "tranos_front": ("tranos_from_photo", (), ["front.png"], 1),
    "tranos_through_its_camera": ("tranos_from_photo", (), ["through_its_camera.png"], 1),
    "tranos_before_and_after": ("tranos_from_photo", (), ["tranos_1917.png", "through_its_camera.png"], 1),
    "one_facade": ("one_facade", ("--hypothesis", "usual_plate"), ["one_facade-1.png"], 2),
    "one_facade_photograph": ("one_facade", ("--hypothesis", "usual_plate"), ["one_facade.png"], 2),
    "kommandantur": ("kommandantur", (), ["kommandantur.png", "through_its_camera.png"], 2),
}


def reduced(width, step, lines, factor):
    """The means of factor × factor pixels, as RGB, on white where it is seen through."""
    for top in range(0, len(lines) - factor + 1, factor):
        line = bytearray()
        for left in range(0, width - factor + 1, factor):
            pixels = [row[x * step : x * step + step] for row in lines[top : top + factor] for x in range(left, left + factor)]
            for c in range(3):
                total = sum(p[c] if step == 3 else (p[c] * p[3] + 255 * (255 - p[3])) / 255 for p in pixels)
                line.append(int(total / len(pixels) + 0.5))
        yield line


def side_by_side(pictures, gap=8):
    """Pictures of RGB lines, of equal height, with white between them."""
    for lines in zip(*pictures):
        yield bytearray((b"\xff" * 3 * gap).join(lines))


def palette_of(lines, most):
    """The commonest colours, 5 bits of each channel told apart, and for each colour the nearest of them."""
    cells = collections.defaultdict(lambda: [0, 0, 0, 0])
    for line in lines:
        for i in range(0, len(line), 3):
            cell = cells[line[i] >> 3, line[i + 1] >> 3, line[i + 2] >> 3]
            for c in range(3):
                cell[c] += line[i + c]
            cell[3] += 1
    common = sorted(cells.values(), key=lambda cell: (-cell[3], cell))[:most]
    colours = [tuple(round(cell[c] / cell[3]) for c in range(3)) for cell in common]
    nearest = {}
    for key, cell in cells.items():
        mean = [cell[c] / cell[3] for c in range(3)]
        nearest[key] = min(range(len(colours)), key=lambda n: sum((a - b) ** 2 for a, b in zip(colours[n], mean)))
    return colours, nearest


def png_of(width, height, colour_type, data, palette=b""):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    parts = [chunk(b"IHDR", header), chunk(b"PLTE", palette) if palette else b""]
    return SIGNATURE + b"".join(parts) + chunk(b"IDAT", zlib.compress(bytes(data), 9)) + chunk(b"IEND", b"")


def write_png(lines):
    """The bytes of an RGB picture, each line as differences from the one above it; of fewer colours where that is too many bytes, as grain is."""
    above, data = bytearray(len(lines[0])), bytearray()
    for line in lines:
        data.append(2)
        data.extend((a - b) & 255 for a, b in zip(line, above))
        above = line
    width, height = len(lines[0]) // 3, len(lines)
    png = png_of(width, height, 2, data)
    most = 256
    while len(png) > MAX_BYTES and most >= 16:
        colours, nearest = palette_of(lines, most)
        data = bytearray()
        for line in lines:
            data.append(0)
            data.extend(nearest[line[i] >> 3, line[i + 1] >> 3, line[i + 2] >> 3] for i in range(0, len(line), 3))
        png = png_of(width, height, 3, data, bytes(sum(colours, ())))
        most //= 2
    return png


def main(tranos, *scripts):
    asked = {pathlib.Path(script).stem for script in scripts}
    rows = {path.stem: (path.stem, (), [path.stem + "-1.png"], 2) for path in sorted(SCRIPTS.glob("*.trn"))
            if (HERE / (path.stem + ".png")).exists() or path.stem in asked}
    rows.update(NAMED)
    runs = collections.defaultdict(list)
    for name, (script, options, files, factor) in rows.items():
        if not asked or script in asked:
            runs[script, options].append((name, files, factor))
    for (script, options), pictures in runs.items():
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([tranos, "run", SCRIPTS / (script + ".trn"), "-o", folder, *options], check=True, stdout=subprocess.DEVNULL)
            for name, files, factor in pictures:
                parts = [list(reduced(*read_png(pathlib.Path(folder, file).read_bytes()), factor)) for file in files]
                (HERE / (name + ".png")).write_bytes(write_png(list(side_by_side(parts))))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
