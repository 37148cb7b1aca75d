# SPDX-License-Identifier: GPL-3.0-or-later
"""A photograph from text to camera: the report, the model's file, the journal, the comparison."""

import json
import pathlib
import shutil
import struct

import harness

GOLDENS = harness.ROOT / "tests/language/photograph"
SCRIPT = (GOLDENS / "an_unknown_is_found_with_the_camera.trn").read_text(encoding="utf-8")
NAMES = ["f_mm", "aspect", "principal_mm", "skew_deg", "omega_deg", "phi_deg", "kappa_deg"]


class Photograph(harness.ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(GOLDENS / "facade.png", self.folder)

    def camera(self, text=SCRIPT):
        return self.report_of(text)["cameras"][0]

    def test_report(self):
        camera = self.camera()
        self.assertEqual(camera["name"], "hall")
        for name, value in zip(NAMES, [35, 1, [0, 0], 89, 12, 25, 0.5]):
            pairs = zip(camera[name], value) if isinstance(value, list) else [(camera[name], value)]
            for found, expected in pairs:
                self.assertAlmostEqual(found, expected, places=3)
        for found, expected in zip(camera["position_m"], [22, -24, 2]):
            self.assertAlmostEqual(found, expected, places=3)
        self.assertEqual(set(camera["sigma"]), set(NAMES) | {"x_m", "y_m", "z_m"})
        self.assertTrue(all(camera["determined"][name] for name in ["f_mm", "skew_deg", "x_m"]))
        rows = camera["covariance"]
        self.assertEqual([len(row) for row in rows], [11] * 11)
        self.assertAlmostEqual(rows[0][0] ** 0.5, camera["sigma"]["f_mm"], places=12)
        self.assertAlmostEqual(rows[4][4] ** 0.5, camera["sigma"]["skew_deg"], places=12)
        self.assertAlmostEqual(camera["unknowns"]["height"]["value"], 7.5, places=3)
        self.assertGreater(camera["unknowns"]["height"]["sigma"], 0)
        self.assertEqual(camera["priors"], {})
        self.assertAlmostEqual(sum(camera["shares"]["f_mm"].values()), 1)

    def test_report_tells_priors_and_trials(self):
        text = SCRIPT.replace("unknown", "prior skew = 89deg +- 1deg\nunknown", 1)
        camera = self.camera(text.replace("calibrate", "calibrate trials=10", 1))
        self.assertAlmostEqual(camera["priors"]["alpha"]["sigma"], 1)
        self.assertGreater(camera["shares"]["skew_deg"]["priors"], 0)
        self.assertEqual(camera["trials"]["trials"], 10)
        self.assertEqual(len(camera["trials"]["mean"]), 11)
        printed = self.run_script(text + "\nreport camera hall\n").out
        self.assertRegex(printed, r"prior α 89 ± 1°, priors are \d+ % of the result")

    def test_estimated_noise_is_told(self):
        """What is left over, in pixels, for each degree of freedom."""
        shifted = SCRIPT.replace(",965.368611432", ",966.068611432", 1).split("assert")[0]
        shifted = shifted.replace("7m +- 20%", "7m in 1m..20m", 1)
        stated = self.camera("noise=1px\n" + shifted)
        camera = self.camera("noise=estimated\n" + shifted)
        self.assertTrue(camera["noise_is_estimated"])
        self.assertAlmostEqual(camera["noise_px"], (stated["chi2"] / stated["dof"]) ** 0.5, places=4)

    def test_what_is_not_determined_gets_no_number(self):
        text = (GOLDENS / "a_facade_alone_leaves_the_camera_open.trn").read_text(encoding="utf-8")
        camera = self.camera(text)
        self.assertIsNone(camera["skew_deg"])
        self.assertIsNone(camera["sigma"]["skew_deg"])
        self.assertFalse(camera["determined"]["skew_deg"])
        self.assertTrue(camera["undetermined"])
        self.assertEqual(len(camera["rectangles"][0]["homography"]), 3)

    def test_what_a_method_assumes_is_not_determined_by_it(self):
        text = (GOLDENS / "calibrate_by_dlt.trn").read_text(encoding="utf-8")
        camera = self.camera(text.partition("calibrate")[0] + "calibrate method=orthocentre")
        for name in ["aspect", "skew_deg"]:
            self.assertFalse(camera["determined"][name])
            self.assertTrue(camera["from_prior"][name])
        self.assertEqual(camera["aspect"], 1)
        self.assertTrue(camera["determined"]["f_mm"])

    def test_camera_in_the_model(self):
        self.run_script(SCRIPT)
        data = (self.folder / "out/script.glb").read_bytes()
        length = struct.unpack("<I", data[12:16])[0]
        model = json.loads(data[20:20 + length])
        (camera,) = model["cameras"]
        self.assertAlmostEqual(camera["extras"]["f"], 35, places=3)
        self.assertAlmostEqual(camera["extras"]["Y0"], -24, places=3)
        (node,) = [node for node in model["nodes"] if "camera" in node]
        for found, expected in zip(node["translation"], [22, -24, 2]):
            self.assertAlmostEqual(found, expected, places=3)
        # The exact matrix puts the hall's near corner where it was traced.
        matrix = camera["extras"]["dot_from_world"]
        u, v, w = (sum(a * b for a, b in zip(matrix[4 * row:4 * row + 4], [10, 0, 0, 1])) for row in range(3))
        self.assertAlmostEqual(u / w, 759.305603241, delta=0.01)
        self.assertAlmostEqual(v / w, 986.421140680, delta=0.01)
        self.assertFalse([node for node in model["nodes"] if "trace" in node.get("name", "")])

    def test_journal_needs_no_picture(self):
        ran = self.run_script(SCRIPT, "--no-output", "--journal", "journal.jsonl")
        self.assertEqual(ran.status, 0, ran.err)
        (self.folder / "facade.png").unlink()
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)
        steps = [json.loads(line) for line in (self.folder / "journal.jsonl").read_text().splitlines()]
        edits = [step["edit"] for step in steps if "edit" in step]
        calibrated = [edit for edit in edits if any("camera" in element["geometry"] for element in edit.get("replaced", []))]
        # The camera, the trace that stands on the unknown and what was built with it, in one edit.
        self.assertEqual(sorted(element["type"] for element in calibrated[0]["replaced"]),
                         ["line", "photograph", "trace edge"])

    def test_comparison_tells_the_camera_in_its_deviations(self):
        self.write("a.trn", SCRIPT)
        self.write("b.trn", SCRIPT.replace("dot=759.305603241,986.421140680", "dot=761.305603241,986.421140680"))
        compared = self.tranos("diff", "a.trn", "b.trn")
        self.assertRegex(compared.out, r"photograph `hall`: .*focal length .* mm, [0-9.]+ of its deviations\)")

    def compared(self, before, after):
        self.write("a.trn", before)
        self.write("b.trn", after)
        return self.tranos("diff", "a.trn", "b.trn").out

    def test_comparison_tells_what_was_assumed(self):
        stated = SCRIPT.replace("unknown", "prior aspect = 1 +- 3%; prior skew = 89deg +- 1deg\nunknown", 1)
        told = self.compared(stated, stated.replace("3%", "5%").replace("89deg +- 1deg", "89deg +- 2deg"))
        self.assertIn("prior aspect 1 +- 3 % -> 1 +- 5 %", told)
        self.assertIn("prior skew 89 +- 1° -> 89 +- 2°", told)
        self.assertIn("prior aspect none -> 1 +- 3 %", self.compared(SCRIPT, stated))

    def test_comparison_tells_noise_and_format(self):
        told = self.compared(SCRIPT, SCRIPT.replace("unknown", "noise=1px\nunknown", 1))
        self.assertIn("trace edge: noise 0.5 px -> 1 px", told)
        told = self.compared(SCRIPT, SCRIPT.replace("24.0075mm", "24mm"))
        self.assertIn("format 36 × 24.0075 mm -> 36 × 24 mm", told)
        self.assertNotIn("format [", told)

    def test_comparison_tells_no_rounding(self):
        told = self.compared(SCRIPT, SCRIPT.replace("unknown", "prior aspect = 1 +- 3%\nunknown", 1))
        self.assertNotRegex(told, r"e-1\d mm")

    def test_photograph_of_the_model(self):
        """The picture, the truth beside it, and a journal that needs neither."""
        text = (GOLDENS / "a_photograph_of_the_model_is_attached.trn").read_text(encoding="utf-8")
        text = text.replace("seed=7", 'seed=7 file="old/p.png"')
        ran = self.run_script(text, "--journal", "journal.jsonl", "--threads", "1")
        self.assertEqual(ran.status, 0, ran.err)
        picture = (self.folder / "out/old/p.png").read_bytes()
        truth = json.loads((self.folder / "out/old/p.json").read_text())
        self.assertEqual(struct.unpack(">II", picture[16:24]), (484, 319))
        self.assertEqual(truth["camera"]["photograph"], "old/p.png")
        self.assertEqual([truth["camera"][name] for name in ["f_mm", "skew_deg"]], [33.33, 88])
        self.assertEqual(truth["effects"]["grain"], 0.4)
        self.assertEqual(truth["seed"], 7)
        again = self.run_script(text, "--threads", "3")
        self.assertEqual(again.status, 0, again.err)
        self.assertEqual(picture, (self.folder / "out/old/p.png").read_bytes())
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)
        # What was written is a photograph like any other.
        shutil.copy(self.folder / "out/old/p.png", self.folder / "p.png")
        read = self.run_script('attach photo "p.png" format=40.5mm,26.7mm as p\nassert p.width == 484px\n')
        self.assertEqual(read.status, 0, read.err)

    def test_orthophoto(self):
        """The picture with what is known of it; the model bears it; other views; a journal that needs no pixels."""
        text = (GOLDENS / "an_orthophoto_reaches_over_what_is_built.trn").read_text(encoding="utf-8").split("choose")[0]
        text = text.replace("pixel=5cm", 'pixel=5cm file="front.png"')
        text += "set view textured photo\nrender size=160,120\nview camera hall\nrender size=160,107\n"
        ran = self.run_script(text, "--journal", "journal.jsonl", "--threads", "1")
        self.assertEqual(ran.status, 0, ran.err)
        about = json.loads((self.folder / "out/front.json").read_text())
        self.assertEqual([about["facade"], about["photograph"], about["size_px"]], ["front", "hall", [200, 150]])
        self.assertEqual([round(x, 6) for x in about["lower_left_m"]], [0, 0, 0])
        self.assertEqual(about["hidden"], 0)
        self.assertLess(about["outside"], 0.1)
        self.assertEqual((self.folder / "out/front.png").read_bytes()[25], 6)  # red, green, blue, alpha
        data = (self.folder / "out/script.glb").read_bytes()
        model = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
        self.assertEqual([image["mimeType"] for image in model["images"]], ["image/png"] * 2)
        borne = [primitive for mesh in model["meshes"] for primitive in mesh["primitives"]
                 if "TEXCOORD_0" in primitive["attributes"]]
        self.assertEqual(len(borne), 2)  # the front, and the photograph at its frame
        before = self.files()
        again = self.run_script(text, "--threads", "4")
        self.assertEqual(again.status, 0, again.err)
        after = self.files()
        self.assertEqual({name: data for name, data in before.items() if name.startswith("out")},
                         {name: data for name, data in after.items() if name.startswith("out")})
        (self.folder / "facade.png").unlink()
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)

    def test_folded_photograph_is_refused(self):
        ran = self.run_script("place camera f=35mm format=36mm,24mm size=48,32 xy=0,-20,2 as paper\n"
                              "render photo camera=paper distortion=[-0.3, -0.3] as p\n")
        self.assertEqual(ran.codes(), ["E0212"])
        self.assertIn("fold", ran.err)

    def test_a_photograph_that_is_cut_off_is_refused_at_once(self):
        photos = harness.ROOT / "tests/fuzz/photos"
        files = [photos / "turned.jpg", photos / "progressive.jpg", GOLDENS / "house.png"]
        for whole in map(pathlib.Path.read_bytes, files):
            for data in (whole, whole + b"\0" * 512):
                self.write("photo", data)
                self.assertEqual(self.run_script('attach photo "photo" as p\n', "--no-output").status, 0)
            for data in (whole[:len(whole) // 2], whole[:-2]):
                self.write("photo", data)
                ran = self.assert_refused('attach photo "photo" as p\n', "E0901", line=1)
                self.assertIn("cut off", ran.err)

    def test_edges_that_were_found_replay_without_pixels(self):
        """Those of a file, of another length and noise, and those of a photograph of the model."""
        shutil.copy(GOLDENS / "house.png", self.folder)
        text = ('attach photo "house.png" as house\n'
                "detect edges as all\nchoose element of=all; delete\n"
                "detect edges least=40 as long\nnoise=0.3px\ndetect edges least=33 as longer\n"
                "detect vanishing points\n"
                "place slab length=8m width=6m height=5m xy=0,0,0\n"
                "place camera f=33mm format=40mm,27mm size=484,319 omega=8deg phi=20deg xy=9,-14,2 as paper\n"
                "render photo camera=paper as p\nattach photo p format=40mm,27mm as rendered\n"
                "detect edges as edges\n"
                'print "{len(edges)}"\n')
        text = text.replace("choose element of=all; delete\n", "delete of=all\n")
        ran = self.run_script(text, "--journal", "journal.jsonl")
        self.assertEqual(ran.status, 0, ran.err)
        (self.folder / "house.png").unlink()
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)
        self.assertRegex(replayed.out, r"steps, equal\n")

    def test_a_photograph_of_what_is_solved_for_is_taken_once(self):
        """While `calibrate` tries heights it is asked for by nobody; what is written shows the height found."""
        at_once = SCRIPT.replace("calibrate", "render photo camera=paper size=48,32 file=\"p.png\"\ncalibrate", 1)
        at_once = "place camera f=33mm format=36mm,24mm size=48,32 phi=20deg xy=30,-24,2 as paper\n" + at_once
        at_once = at_once.replace("render photo", "place slab length=10m width=14m height=height xy=0,0,0\nrender photo", 1)
        ran = self.run_script(at_once)
        self.assertEqual(ran.status, 0, ran.err)
        before = (self.folder / "out/p.png").read_bytes()
        stated = self.run_script(
            "place camera f=33mm format=36mm,24mm size=48,32 phi=20deg xy=30,-24,2 as paper\n"
            "place slab length=10m width=14m height=7.5m xy=0,0,0\n"
            'render photo camera=paper size=48,32 file="q.png"\n')
        self.assertEqual(stated.status, 0, stated.err)
        self.assertEqual(len(before) // 100, len((self.folder / "out/q.png").read_bytes()) // 100)

    def test_runs_the_same_from_another_folder(self):
        first = self.report_of(SCRIPT, "--no-output")
        self.write("deep/er/script.trn", SCRIPT)
        shutil.copy(GOLDENS / "facade.png", self.folder / "deep/er")
        second = self.tranos("run", "deep/er/script.trn", "--json", "--no-output", "--threads", "8").report
        self.assertEqual(first["model_hash"], second["model_hash"])
        self.assertEqual(first["cameras"], second["cameras"])


if __name__ == "__main__":
    harness.main()
