# SPDX-License-Identifier: GPL-3.0-or-later
"""What a script may read and write: below its folder and the output folder, no links, no devices."""

import os
import socket
import unittest

import harness

LIBRARY = "let width = 3m\n"


class Reading(harness.ProgramTest):
    def refuse_use(self, path, code="E0703", *options, status=1):
        return self.assert_refused(f'use "{path}"\nplace point xy=0,0\n', code, *options, line=1, status=status)

    def test_below_the_folder(self):
        self.write("elements/local.trn", LIBRARY)
        self.assertEqual(self.run_script('use "elements/local.trn"\nplace point xy=width,0\n').status, 0)

    def test_from_another_folder(self):
        self.write("site/elements/local.trn", LIBRARY)
        self.write("site/a.trn", 'use "elements/local.trn"\nassert width == 3m\n')
        self.write("elsewhere/x", "")
        ran = self.tranos("run", "../site/a.trn", cwd=self.folder / "elsewhere")
        self.assertEqual(ran.status, 0, ran.err)

    def test_out_of_the_folder(self):
        self.write("local.trn", LIBRARY)
        (self.folder / "inner").mkdir()
        self.write("inner/a.trn", 'use "../local.trn"\n')
        ran = self.tranos("run", "inner/a.trn")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0703"]), ran.err)
        self.assertIn("inner/a.trn:1:5", ran.err)

    def test_out_and_in_again(self):
        self.write("local.trn", LIBRARY)
        self.refuse_use(f"../{self.folder.name}/local.trn")

    def test_absolute(self):
        self.refuse_use("/etc/passwd")
        self.refuse_use(str(self.write("local.trn", LIBRARY)))

    def test_through_a_link(self):
        outside = self.write("away/local.trn", LIBRARY)
        self.write("near/local.trn", LIBRARY)
        os.symlink(outside, self.folder / "link.trn")
        os.symlink("near/local.trn", self.folder / "near.trn")
        os.symlink("near", self.folder / "folder")
        for path in ("link.trn", "near.trn", "folder/local.trn"):
            with self.subTest(path=path):
                self.assertIn("link", self.refuse_use(path).err)

    def test_to_devices(self):
        os.symlink("/dev/zero", self.folder / "zero.trn")
        os.symlink("/proc/self/fd/0", self.folder / "magic.trn")
        os.mkfifo(self.folder / "fifo.trn")
        os.mkdir(self.folder / "folder.trn")
        there = ["zero.trn", "magic.trn", "fifo.trn", "folder.trn"]
        with socket.socket(socket.AF_UNIX) as end:
            end.bind(str(self.folder / "socket.trn"))
            there.append("socket.trn")
            try:
                os.mknod(self.folder / "device.trn", 0o20666, os.makedev(1, 5))
                there.append("device.trn")
            except PermissionError:
                pass  # for the administrator alone
            for path in there:
                with self.subTest(path=path):
                    self.write("script.trn", f'use "{path}"\n')
                    ran = self.tranos("run", "script.trn", timeout=10)
                    self.assertEqual((ran.status, ran.codes()), (1, ["E0703"]), ran.err)
                    self.assertIn("script.trn:1:5", ran.err)

    def test_missing(self):
        self.refuse_use("nowhere.trn", "E0701", status=3)

    def test_control_character_in_a_path(self):
        self.assert_refused('use "a\x07.trn"\n', "E0102", line=1)

    def test_allowed_folder(self):
        self.write("library/arches.trn", LIBRARY)
        self.write("site/a.trn", 'use "arches.trn"\nassert width == 3m\n')
        self.assertEqual(self.tranos("run", "site/a.trn").status, 3)
        self.assertEqual(self.tranos("run", "site/a.trn", "--allow", "library").status, 0)

    def test_allowed_folder_by_its_path(self):
        path = self.write("library/arches.trn", LIBRARY)
        self.write("site/a.trn", f'use "{path}"\nassert width == 3m\n')
        self.assertEqual(self.tranos("run", "site/a.trn").status, 1)
        self.assertEqual(self.tranos("run", "site/a.trn", "--allow", path.parent).status, 0)
        self.write("site/b.trn", f'use "{path.parent}/../site/a.trn"\n')
        self.assertEqual(self.tranos("run", "site/b.trn", "--allow", path.parent).status, 1)

    def test_allowed_folder_that_is_not_there(self):
        ran = self.run_script("place point xy=0,0\n", "--allow", "nowhere")
        self.assertEqual(ran.status, 2, ran.err)
        self.assertIn("nowhere", ran.err)


class Writing(harness.ProgramTest):
    DRAWING = "place line xy=0,0 xy=1,0 reset\n"

    def refuse_export(self, path, code="E0703", **keywords):
        return self.assert_refused(self.DRAWING + f'export "{path}"\n', code, line=2, **keywords)

    def test_what_is_written(self):
        ran = self.run_script(self.DRAWING + 'export "plans/a.glb"\nrender\nrender file="east.png" size=[64,48]\nrender\n')
        self.assertEqual(ran.status, 0, ran.err)
        written = ["out/script.glb", "out/plans/a.glb", "out/script-1.png", "out/east.png", "out/script-2.png"]
        self.assertEqual(ran.out.split(), written)
        self.assertEqual(sorted(name for name, data in self.files().items() if data), sorted(written + ["script.trn"]))
        for path in written:
            begin = (self.folder / path).read_bytes()[:4]
            self.assertEqual(begin, b"glTF" if path.endswith(".glb") else b"\x89PNG", path)

    def test_output_folder(self):
        self.assertEqual(self.run_script(self.DRAWING, "-o", "a/b/c").status, 0)
        self.assertTrue((self.folder / "a/b/c/script.glb").exists())
        other = self.folder / "d"
        self.assertEqual(self.run_script(self.DRAWING, f"--output={other}").status, 0)
        self.assertTrue((other / "script.glb").exists())

    def test_no_output(self):
        ran = self.run_script(self.DRAWING + 'render\nexport "a.glb"\n', "--no-output")
        self.assertEqual((ran.status, ran.out, ran.err), (0, "", ""))
        self.assertEqual(list(self.files()), ["script.trn"])

    def test_out_of_the_folder(self):
        for path in ("../a.glb", "b/../../a.glb", str(self.folder / "elsewhere/a.glb"), "..", "", ".glb/"):
            with self.subTest(path=path):
                code = "E0703" if path.endswith(".glb") else None
                if code:
                    self.refuse_export(path)
                else:
                    self.write("script.trn", self.DRAWING + f'export "{path}"\n')
                    ran = self.tranos("run", "script.trn")
                    self.assertEqual(ran.status, 1, ran.err)

    def test_no_folder_is_left_by_a_refused_run(self):
        ran = self.run_script(self.DRAWING + 'export "new/a.glb"\nexport "../a.glb"\n', "-o", "a/b")
        self.assertEqual(ran.status, 1)
        self.assertEqual(list(self.files()), ["script.trn"])

    def test_control_character_in_a_name(self):
        self.refuse_export("a\x1bb.glb", "E0102")
        ran = self.refuse_export("a\\nb.glb")
        self.assertIn("control character", ran.err)

    def test_over_a_script(self):
        self.write("out/plan.trn", "# mine\n")
        self.write("script.trn", self.DRAWING + 'export "plan.trn"\n')
        ran = self.tranos("run", "script.trn")
        self.assertEqual(ran.status, 1)
        self.assertIn(ran.codes()[0], ("E0704", "E0705"))
        self.assertEqual((self.folder / "out/plan.trn").read_text(), "# mine\n")

    def test_over_the_script_itself(self):
        # A script may have any name; one that ends as a model does must survive its own run.
        path = self.write("out/script.glb", self.DRAWING)
        before = path.read_bytes()
        ran = self.tranos("run", "out/script.glb")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0704"]), ran.err)
        self.assertEqual(path.read_bytes(), before)

    def test_over_a_file_that_was_read(self):
        self.write("a.glb", LIBRARY)
        self.write("script.trn", 'use "a.glb"\n' + self.DRAWING + 'export "a.glb"\n')
        ran = self.tranos("run", "script.trn", "-o", ".")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0704"]), ran.err)
        self.assertIn("script.trn:3:8", ran.err)
        self.assertEqual((self.folder / "a.glb").read_text(), LIBRARY)
        self.assertFalse((self.folder / "script.glb").exists())

    def test_over_a_file_read_under_another_name(self):
        self.write("a.trn", LIBRARY)
        os.link(self.folder / "a.trn", self.folder / "b.glb")
        self.write("script.trn", 'use "a.trn"\n' + self.DRAWING + 'export "b.glb"\n')
        ran = self.tranos("run", "script.trn", "-o", ".")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0704"]), ran.err)

    def test_through_links(self):
        target = self.write("away/a.glb", "older")
        self.write("out/x", "")
        os.symlink(target, self.folder / "out/a.glb")
        os.symlink(self.folder / "away", self.folder / "out/folder")
        for path in ("a.glb", "folder/a.glb", "folder/new.glb"):
            with self.subTest(path=path):
                ran = self.run_script(self.DRAWING + f'export "{path}"\n')
                self.assertEqual((ran.status, ran.codes()), (1, ["E0703"]), ran.err)
        self.assertEqual(target.read_text(), "older")
        self.assertEqual(os.listdir(self.folder / "away"), ["a.glb"])
        self.assertFalse((self.folder / "out/script.glb").exists())

    def test_model_through_a_link(self):
        target = self.write("away.glb", "older")
        self.write("out/x", "")
        os.symlink(target, self.folder / "out/script.glb")
        ran = self.run_script(self.DRAWING)
        self.assertEqual((ran.status, ran.codes()), (1, ["E0703"]), ran.err)
        self.assertEqual(target.read_text(), "older")

    def test_over_what_is_no_file(self):
        (self.folder / "out/a.glb").mkdir(parents=True)
        os.mkfifo(self.folder / "out/b.glb")
        for path in ("a.glb", "b.glb"):
            with self.subTest(path=path):
                ran = self.run_script(self.DRAWING + f'export "{path}"\n', timeout=10)
                self.assertEqual((ran.status, ran.codes()), (1, ["E0703"]), ran.err)

    def test_older_output_is_replaced(self):
        self.write("out/script.glb", "older")
        self.assertEqual(self.run_script(self.DRAWING).status, 0)
        self.assertEqual((self.folder / "out/script.glb").read_bytes()[:4], b"glTF")

    def test_a_name_that_another_output_has(self):
        exports = self.DRAWING + 'export "a.glb"\n'
        for again in ("a.glb", "./a.glb", "b/../a.glb"):
            with self.subTest(again=again):
                ran = self.assert_refused(exports + f'place line xy=5,5,0 dl=1\nexport "{again}"\n', "E0704", line=4)
                self.assertIn("another output of this run", ran.err)
                self.assertIn("script.trn:2:", ran.err)  # the output that has the name
        self.assertEqual(self.run_script(exports + 'export "b/a.glb"\n').status, 0)

    def test_a_picture_named_as_one_that_is_numbered(self):
        self.assert_refused(self.DRAWING + 'render\nrender file="script-1.png"\n', "E0704", line=3)

    def test_one_name_at_each_turn_of_a_loop(self):
        loop = self.DRAWING + "for i = 1 to 2 {\n  render size=20,20 file=%s\n}\n"
        ran = self.assert_refused(loop % '"a.png"', "E0704", line=3)
        self.assertIn("in a loop the name is to change", ran.err)
        self.assertEqual(self.run_script(loop % '"a{i}.png"').status, 0)

    def test_the_name_of_the_model(self):
        ran = self.assert_refused(self.DRAWING + 'export "script.glb"\n', "E0704", line=2)
        self.assertIn("the model, which every run writes", ran.err)

    def test_unknown_format(self):
        ran = self.refuse_export("a.dwg", "E0705")
        self.assertIn("glb", ran.err)

    @unittest.skipUnless(os.path.exists("/proc/self/environ"), "Linux alone")
    def test_environment_does_not_matter(self):
        self.write("script.trn", self.DRAWING)
        self.tranos("run", "script.trn", env={"PATH": "/nowhere", "LC_ALL": "tr_TR.UTF-8", "TZ": "Asia/Tokyo"})
        first = self.files()
        self.tranos("run", "script.trn", env={})
        self.assertEqual(self.files(), first)


if __name__ == "__main__":
    harness.main()
