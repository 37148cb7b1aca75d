# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras for other programs: the files that a script gives, and what names can do in them."""

import ast
import json
import re
import shutil
import struct
import subprocess
import sys
import types
import unittest

import harness

GOLDENS = harness.ROOT / "tests/language/photograph"
CAMERA = ("place camera f=35mm format=36mm,24mm size=1600,1067 aspect=1.03 skew=89deg principal=1mm,-0.7mm"
          " omega=8deg phi=30deg kappa=2deg xy=10,-30,2 as hall\n")
PHOTOGRAPH = (GOLDENS / "an_unknown_is_found_with_the_camera.trn").read_text(encoding="utf-8")


def png_size(data):
    return struct.unpack(">II", data[16:24])


def product(rows, vector):
    return [sum(a * b for a, b in zip(row, vector)) for row in rows]


class Blender(types.ModuleType):
    """As much of bpy as a script that sets up a camera may touch; what it does is kept."""

    class Anything(types.SimpleNamespace):
        def __getattr__(self, name):
            made = Blender.Anything()
            setattr(self, name, made)
            return made

        def __iter__(self):
            return iter(())

        def __call__(self, *arguments):
            return self

    def __init__(self, loaded):
        super().__init__("bpy")
        anything = Blender.Anything
        self.context = anything()
        self.cameras = []
        self.data = anything()
        self.data.cameras = anything(new=self.made)
        self.data.images = anything(load=loaded.append)
        self.data.objects = anything(new=lambda name, data: anything(name=name, data=data))

    def made(self, name):
        self.cameras.append(Blender.Anything(name=name))
        return self.cameras[-1]


# Run by Blender after the script that sets up the camera: where points of the world lie in the picture, from the middle
# of the top left pixel, and the picture behind.
ASK_BLENDER = """
import bpy, bpy_extras, json, mathutils, sys
scene = bpy.context.scene
bpy.context.view_layer.update()
width, height = scene.render.resolution_x, scene.render.resolution_y
dots = []
for point in json.loads(sys.argv[-1]):
    seen = bpy_extras.object_utils.world_to_camera_view(scene, scene.camera, mathutils.Vector(point))
    dots.append([seen.x * width - 0.5, (1 - seen.y) * height - 0.5])
picture = scene.camera.data.background_images[0].image
print("ANSWER", json.dumps({"dots": dots, "size": list(picture.size)}))
"""


class Exchange(harness.ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(GOLDENS / "facade.png", self.folder)

    def out(self, name):
        return (self.folder / "out" / name).read_bytes()

    def exported(self, text):
        ran = self.run_script(text)
        self.assertEqual(ran.status, 0, ran.err)
        return ran

    def test_a_stated_camera_gives_the_texts_alone(self):
        self.exported(CAMERA + "".join(f"export {what} camera=hall\n" for what in [
            'fspy "f/hall.json"', '"hall.yaml"', '"hall.py"', 'colmap "c"', 'exact "e.json"']))
        made = sorted(name for name in self.files() if name.startswith("out/") and "." in name)
        self.assertEqual(made, ["out/c/cameras.txt", "out/c/hall.camera.json", "out/c/images.txt", "out/c/points3D.txt",
                                "out/e.json", "out/f/hall.camera.json", "out/f/hall.json", "out/hall.camera.json",
                                "out/hall.py", "out/hall.yaml", "out/script.glb"])
        self.assertEqual(self.out("e.json"), self.out("hall.camera.json"))

    def test_a_photograph_goes_along_without_skew(self):
        self.exported(PHOTOGRAPH + 'export "hall.yaml"\nexport "hall.py"\nexport "hall.fspy"\nexport colmap "c"\n')
        exact = json.loads(self.out("hall.camera.json"))
        self.assertAlmostEqual(exact["skew_deg"], 89, places=3)
        for picture, key in [("hall_unskewed.png", "unskewed"), ("hall_square.png", "square"),
                             ("c/images/hall_unskewed.png", "unskewed")]:
            self.assertEqual(list(png_size(self.out(picture))), exact[key]["size_px"])
        project = self.out("hall.fspy")
        word, version, settings, picture = struct.unpack("<4sIII", project[:16])
        self.assertEqual((word, version, 16 + settings + picture), (b"fspy", 1, len(project)))
        stored = json.loads(project[16:16 + settings])["cameraParameters"]
        self.assertEqual([stored["imageWidth"], stored["imageHeight"]], list(png_size(project[16 + settings:])))
        self.assertEqual(self.out("hall_square.png"), project[16 + settings:])
        self.assertIn(b" 1 hall_unskewed.png", self.out("c/images.txt"))

    def test_a_python_file_makes_the_camera_and_shows_the_picture(self):
        self.exported(PHOTOGRAPH + 'export "hall.py"\n')
        loaded = []
        bpy = Blender(loaded)
        mathutils = types.ModuleType("mathutils")
        mathutils.Matrix = list
        namespace = {"__name__": "__main__", "__file__": str(self.folder / "out/hall.py")}
        sys.modules["bpy"], sys.modules["mathutils"] = bpy, mathutils
        self.addCleanup(lambda: [sys.modules.pop(name) for name in ["bpy", "mathutils"]])
        exec(compile(self.out("hall.py"), "hall.py", "exec"), namespace)
        (camera,) = bpy.cameras
        self.assertEqual(camera.name, "hall")
        self.assertEqual(loaded, [str(self.folder / "out/hall_square.png")])
        self.assertTrue(camera.show_background_images)
        self.assertIs(bpy.context.scene.camera.data, camera)

    @unittest.skipUnless(shutil.which("blender"), "Blender is not installed")
    def test_blender_sees_points_where_the_exact_matrix_puts_them(self):
        self.exported(PHOTOGRAPH + 'export "hall.py"\n')
        self.write("ask.py", ASK_BLENDER)
        points = [[0, 0, 0], [10, 0, 0], [10, 14, 6], [-3, 2, 9]]
        scripts = ["--python", self.folder / "out/hall.py", "--python", self.folder / "ask.py"]
        ended = subprocess.run(["blender", "--background", "--factory-startup", *scripts, "--", json.dumps(points)],
                               capture_output=True, text=True, timeout=300, check=False)
        told = re.search(r"^ANSWER (.*)$", ended.stdout, re.MULTILINE)
        self.assertTrue(told, ended.stdout + ended.stderr)
        answer = json.loads(told[1])
        exact = json.loads(self.out("hall.camera.json"))
        self.assertEqual(answer["size"], exact["square"]["size_px"])
        for point, found in zip(points, answer["dots"]):
            expected = product(exact["square"]["new_dot_from_dot"], product(exact["P"], point + [1]))
            # Blender counts in single precision.
            for i in range(2):
                self.assertAlmostEqual(found[i], expected[i] / expected[2], delta=0.02)

    def test_no_name_becomes_code(self):
        """Files named as an attacker would: the syntax tree differs in one text alone."""
        def tree(stem):
            self.exported(PHOTOGRAPH + f'export blender "{stem}.py"\n')
            plain = stem.replace('\\"', '"').replace("\\\\", "\\")
            parsed = ast.parse(self.out(plain + ".py"))
            texts = [node for node in ast.walk(parsed) if isinstance(node, ast.Constant) and
                     isinstance(node.value, str) and '"sensor_mm"' in node.value]
            (text,) = texts
            data = json.loads(text.value)
            text.value = ""
            return ast.dump(parsed), data["picture"], plain

        harmless, _, _ = tree("hall")
        for stem in ["it's", "'); import os; os.system('touch pwned')#", '\\"\\"\\"', "\\\\'", "a\\\\"]:
            dumped, picture, plain = tree(stem)
            self.assertEqual(dumped, harmless)
            self.assertEqual(picture, plain.rpartition("/")[2] + "_square.png")
        self.assert_refused(PHOTOGRAPH + 'export "a\\nimport os.py"\n', "E0703")

    def test_an_fspy_project_comes_back_with_its_camera(self):
        """The square picture's camera: of the exported one as it would be if it had been taken without skew."""
        self.exported(PHOTOGRAPH + 'export "hall.fspy"\nexport fspy "hall.json"\n')
        exact = json.loads(self.out("hall.camera.json"))
        for name in ["hall.fspy", "hall_square.png", "hall.json"]:
            shutil.copy(self.folder / "out" / name, self.folder)
        for attach in ['attach photo "hall.fspy" as hall', 'attach photo "hall_square.png" camera="hall.json" as hall',
                       'attach photo "hall_square.png" camera="hall.fspy" as hall']:
            (camera,) = self.report_of(attach, "--no-output")["cameras"]
            f_px = camera["f_mm"] / 36 * exact["square"]["size_px"][0]
            self.assertAlmostEqual(f_px, exact["square"]["K"][0][0], places=6)
            for name in ["omega_deg", "phi_deg", "kappa_deg"]:
                self.assertAlmostEqual(camera[name], exact[name], places=9)
            for found, expected in zip(camera["position_m"], exact["position_m"]):
                self.assertAlmostEqual(found, expected, places=9)
            self.assertAlmostEqual(camera["skew_deg"], 90, places=9)

    def test_a_camera_from_a_file_is_replayed_without_it(self):
        self.exported(PHOTOGRAPH + 'export "hall.fspy"\nexport exact "exact.json"\n')
        for name in ["hall.fspy", "exact.json"]:
            shutil.copy(self.folder / "out" / name, self.folder)
        text = ('attach photo "hall.fspy" as a\nattach photo "facade.png" camera="exact.json" as b\n'
                'attach photo "facade.png" camera="exact.json" format=40mm,26.675mm as c\nexport "c.yaml"\n')
        ran = self.run_script(text, "--no-output", "--journal", "journal.jsonl")
        self.assertEqual(ran.status, 0, ran.err)
        for name in ["hall.fspy", "exact.json", "facade.png"]:
            (self.folder / name).unlink()
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)
        self.assertNotIn("W0004", replayed.err)

    def test_projects_that_are_none_are_refused(self):
        """Cut off, of huge lengths, of another version, with no JSON, with no picture, with a camera that is none."""
        self.exported(PHOTOGRAPH + 'export "hall.fspy"\n')
        whole = self.out("hall.fspy")
        settings = struct.unpack("<I", whole[8:12])[0]
        stored = json.loads(whole[16:16 + settings])

        def project(text, picture=whole[16 + settings:]):
            return struct.pack("<4sIII", b"fspy", 1, len(text), len(picture)) + text + picture

        def with_camera(**changes):
            changed = dict(stored, cameraParameters=dict(stored["cameraParameters"], **changes))
            return project(json.dumps(changed).encode())

        huge = b"\xff\xff\xff\xff"
        cases = {
            "E0901": [b"fspy", whole[:15], whole[:-1], whole[:16 + settings], whole[:8] + huge + whole[12:],
                      whole[:12] + huge + whole[16:], whole[:4] + b"\x99" + whole[5:], b"FSPY" + whole[4:],
                      project(json.dumps(stored).encode(), b""), project(json.dumps(stored).encode(), b"no picture")],
            "E0911": [project(b"{"), project(b"no JSON"), project(b""), project(b"[" * 100_000), project(b"[]"),
                      with_camera(imageWidth=10), with_camera(imageWidth="wide"), with_camera(relativeFocalLength=-1),
                      with_camera(relativeFocalLength=1e300), with_camera(cameraTransform={"rows": [[0] * 4] * 4}),
                      with_camera(relativeFocalLength=1e6), with_camera(cameraTransform=None), with_camera(principalPoint={"x": 0})],
        }
        for code, files in cases.items():
            for file in files:
                self.write("bad.fspy", file)
                self.assert_refused('attach photo "bad.fspy" as bad\n', code, line=1)
        self.write("open.fspy", project(json.dumps(dict(stored, cameraParameters=None)).encode()))
        self.assertEqual(self.report_of('attach photo "open.fspy" as hall', "--no-output")["cameras"], [])
        self.assert_refused('attach photo "facade.png" camera="open.fspy"\n', "E0911")

    def test_two_cameras_are_not_written_into_one_file(self):
        other = CAMERA.replace("as hall", "as other")
        self.exported(PHOTOGRAPH + 'export "a.yaml"; export "a.py"\n')
        self.assert_refused(PHOTOGRAPH + 'export "a.yaml"\n' + other + 'export "a.py" camera=other\n', "E0704")

    def test_two_cameras_or_two_forms_of_one_have_two_names(self):
        other = CAMERA.replace("as hall", "as other")
        exact = CAMERA + 'export exact "x.json" camera=hall\n'
        ran = self.assert_refused(exact + other + 'export exact "x.json" camera=other\n', "E0704")
        self.assertIn("another output of this run", ran.err)
        self.assert_refused(exact + 'export "x.json" camera=hall\n', "E0704")
        self.assert_refused(CAMERA + 'export colmap "x" camera=hall\n' + other + 'export colmap "x" camera=other\n', "E0704")

    def test_an_export_is_replayed_without_the_picture(self):
        ran = self.run_script(PHOTOGRAPH + 'export "hall.yaml"\nexport "hall.fspy"\n', "--journal", "journal.jsonl")
        self.assertEqual(ran.status, 0, ran.err)
        (self.folder / "facade.png").unlink()
        replayed = self.tranos("replay", "journal.jsonl")
        self.assertEqual(replayed.status, 0, replayed.err)

    def test_the_same_bytes_with_one_thread_and_eight(self):
        written = []
        for threads in ["1", "8"]:
            self.run_script(PHOTOGRAPH + 'export "hall.fspy"\nexport "hall.py"\n', "--threads", threads)
            written.append({name: data for name, data in self.files().items() if name.startswith("out/")})
        self.assertEqual(written[0], written[1])


if __name__ == "__main__":
    harness.main()
