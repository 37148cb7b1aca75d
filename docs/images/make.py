#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the documents' pictures: runs scripts and halves what they render.

usage: docs/images/make.py TRANOS [SCRIPT.trn...]    (without scripts: those that have one)
"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
SCRIPTS = HERE.parent.parent / "scripts"
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


def halved(width, step, lines):
    """Each pixel the mean of four, as RGB."""
    for upper, lower in zip(lines[::2], lines[1::2]):
        line = bytearray()
        for x in range(0, width - 1, 2):
            for c in range(3):
                i = x * step + c
                line.append((upper[i] + upper[i + step] + lower[i] + lower[i + step] + 2) // 4)
        yield line


def write_png(lines):
    """The bytes of an RGB picture, each line as differences from the one above it."""
    above, data = bytearray(len(lines[0])), bytearray()
    for line in lines:
        data.append(2)
        data.extend((a - b) & 255 for a, b in zip(line, above))
        above = line

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", len(lines[0]) // 3, len(lines), 8, 2, 0, 0, 0)
    return SIGNATURE + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(data), 9)) + chunk(b"IEND", b"")


def main(tranos, *scripts):
    shown = [path for path in sorted(SCRIPTS.glob("*.trn")) if (HERE / (path.stem + ".png")).exists()]
    for script in map(pathlib.Path, scripts or shown):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([tranos, "run", script, "-o", folder], check=True, stdout=subprocess.DEVNULL)
            picture = pathlib.Path(folder, script.stem + "-1.png").read_bytes()
        (HERE / (script.stem + ".png")).write_bytes(write_png(list(halved(*read_png(picture)))))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
