# SPDX-License-Identifier: GPL-3.0-or-later
"""`tranos trace`: a photograph's edges as a script, which runs without the detector."""

import re
import shutil
import struct
import zlib

import harness

GOLDENS = harness.ROOT / "tests/language/photograph"


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, rows):
    """A grey PNG, whole or not, as `rows` says."""
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) +
            chunk(b"IEND", b""))


class Trace(harness.ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(GOLDENS / "house.png", self.folder)

    def trace(self, *arguments):
        return self.tranos("trace", *arguments)

    def test_writes_a_script_that_runs_and_gives_the_camera(self):
        ran = self.trace("house.png", "-o", "traces.trn")
        self.assertEqual((ran.status, ran.err), (0, ""))
        self.assertIn("traces.trn", ran.out)
        text = (self.folder / "traces.trn").read_text(encoding="utf-8")
        for axis in "xyz":
            self.assertGreater(len(re.findall(rf"^trace edge {axis} samples=\d+ ", text, re.MULTILINE)), 5)
        self.assertNotIn("detect", text)
        report = self.report_of(text)
        self.assertEqual(report["status"], 0)
        camera = report["cameras"][0]
        self.assertAlmostEqual(camera["f_mm"], 38, delta=1)
        self.assertAlmostEqual(camera["omega_deg"], 9, delta=0.3)
        self.assertAlmostEqual(camera["phi_deg"], 38, delta=0.6)

    def test_writes_what_the_commands_find(self):
        """The model is the same whether the edges are found or read."""
        self.trace("house.png")
        text = (self.folder / "house.trn").read_text(encoding="utf-8")
        found = self.report_of('attach photo "house.png" as picture\nprior default\nnoise=estimated\n'
                               "detect edges\ndetect vanishing points\n")
        nameless = re.sub(r"^(trace .*) as \w+$", r"\1", text.split("\ncalibrate")[0], flags=re.MULTILINE)
        read = self.report_of(nameless)
        self.assertEqual(found["model_hash"], read["model_hash"])
        self.assertGreater(len(found["elements"]), 50)

    def test_gives_the_same_bytes_each_time(self):
        self.trace("house.png", "-o", "a.trn")
        self.trace("house.png", "-o", "b.trn")
        self.assertEqual((self.folder / "a.trn").read_bytes(), (self.folder / "b.trn").read_bytes())

    def test_leaves_what_is_there_alone(self):
        self.write("house.trn", "# mine\n")
        ran = self.trace("house.png")
        self.assertEqual(ran.status, 3)
        self.assertIn("is there already", ran.err)
        self.assertEqual((self.folder / "house.trn").read_text(), "# mine\n")

    def test_refuses_a_place_from_which_the_photograph_cannot_be_read(self):
        (self.folder / "other").mkdir()
        ran = self.trace("house.png", "-o", "other/traces.trn")
        self.assertEqual(ran.status, 3)
        self.assertIn("in the photograph's folder or one above it", ran.err)
        self.assertIn("-o ./house.trn", ran.err)
        self.assertEqual(list((self.folder / "other").iterdir()), [])
        self.assertEqual(self.trace("house.png", "-o", "nowhere/traces.trn").status, 3)

    def test_names_a_photograph_from_the_scripts_folder(self):
        (self.folder / "sub").mkdir()
        shutil.copy(GOLDENS / "house.png", self.folder / "sub/h.png")
        (self.folder / "linked").symlink_to("sub")
        for photo, output, name in [("sub/h.png", "y.trn", "sub/h.png"),
                                    (self.folder / "house.png", "z.trn", "house.png"),
                                    ("./house.png", self.folder / "sub/../x.trn", "house.png"),
                                    ("linked/h.png", "l.trn", "sub/h.png"),
                                    ("sub/h.png", "linked/h.trn", "h.png")]:
            with self.subTest(photo=photo, output=output):
                ran = self.trace(photo, "-o", output)
                self.assertEqual((ran.status, ran.err), (0, ""))
                text = (self.folder / output).read_text(encoding="utf-8")
                self.assertIn(f'attach photo "{name}" as picture', text)
                self.assertEqual(self.tranos("run", output, "--no-output").status, 0)

    def test_names_a_photograph_as_it_is_called(self):
        shutil.copy(GOLDENS / "house.png", self.folder / 'a "{b}".png')
        ran = self.trace('a "{b}".png', "-o", "traces.trn")
        self.assertEqual((ran.status, ran.err), (0, ""))
        self.assertEqual(self.tranos("run", "traces.trn", "--no-output").status, 0)

    def test_refuses_what_is_no_picture_to_trace(self):
        whole = (GOLDENS / "house.png").read_bytes()
        for name, data, said in [("empty.png", b"", "no photograph"),
                                 ("cut.png", whole[:2000], "no photograph"),
                                 ("huge.png", png(100000, 100000, b""), "no photograph"),
                                 ("tiny.png", png(3, 3, b"\0aaa" * 3), "less than 16 pixels"),
                                 ("blank.png", png(200, 200, (b"\0" + b"a" * 200) * 200), "no straight edge")]:
            self.write(name, data)
            ran = self.trace(name)
            self.assertEqual(ran.status, 1, name)
            self.assertIn(said, ran.err)
            self.assertFalse((self.folder / name.replace("png", "trn")).exists())
        self.assertEqual(self.trace("missing.png").status, 3)

    def test_writes_edges_without_directions_too(self):
        """Bars that are all upright show one direction."""
        row = b"\0" + bytes(220 if x // 40 % 2 else 40 for x in range(400))
        self.write("bars.png", png(400, 300, row * 300))
        ran = self.trace("bars.png")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertIn("no two directions", ran.err)
        text = (self.folder / "bars.trn").read_text(encoding="utf-8")
        self.assertIn("trace line samples=", text)
        self.assertNotIn("calibrate", text.replace("by `calibrate`", ""))
        self.assertEqual(self.tranos("run", "bars.trn", "--no-output").status, 0)


if __name__ == "__main__":
    harness.main()
