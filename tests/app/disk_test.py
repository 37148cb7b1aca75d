# SPDX-License-Identifier: GPL-3.0-or-later
"""Disks that are full and folders that cannot be written: status 3, and older files as they were."""

import os
import resource
import signal
import subprocess
import unittest

import harness

DRAWING = "place line xy=0,0 xy=1,0 reset\n"
# Some hundred kilobytes of model.
LARGE = "for i = 0 to 999 { place circle center radius=1 xy=i,0 }\n"


def no_larger_than(size):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
    return limit


class Unwritable(harness.ProgramTest):
    def expect_failure(self, *arguments, **keywords):
        before = self.files()
        ran = self.tranos("run", "script.trn", *arguments, **keywords)
        self.assertEqual(ran.status, 3, ran.err)
        self.assertEqual(ran.codes(), ["E0702"], ran.err)
        self.assertEqual(self.files(), before)
        self.assertNotIn(".glb\n", ran.out)
        return ran

    def test_below_a_file(self):
        self.write("script.trn", DRAWING)
        self.write("file", "older")
        self.expect_failure("-o", "file")
        self.expect_failure("-o", "file/out")
        self.expect_failure("-o", "/proc/out")

    def test_a_folder_of_an_output_is_a_file(self):
        self.write("script.trn", DRAWING + 'export "plans/a.glb"\n')
        self.write("out/plans", "older")
        self.expect_failure()

    @unittest.skipIf(os.geteuid() == 0, "permissions do not bind the administrator")
    def test_folder_without_permission(self):
        self.write("script.trn", DRAWING)
        (self.folder / "out").mkdir(mode=0o555)
        self.expect_failure()

    def test_file_size_limit(self):
        self.write("script.trn", LARGE)
        self.write("out/script.glb", "older")
        self.expect_failure(preexec_fn=no_larger_than(4096))

    def test_second_file_does_not_fit(self):
        self.write("script.trn", DRAWING + 'render\nexport "a.glb"\n' + LARGE + 'export "b.glb"\n')
        self.write("out/a.glb", "older")
        self.expect_failure(preexec_fn=no_larger_than(30_000))

    def test_full_disk(self):
        self.write("script.trn", LARGE)
        out = self.folder / "out"
        out.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", out], capture_output=True,
                                 check=False)
        if mounted.returncode != 0:
            self.skipTest("a small disk needs the right to mount one")
        self.addCleanup(subprocess.run, ["umount", out], check=True)
        self.write("out/script.glb", "older")
        self.expect_failure()
        ran = self.run_script(DRAWING)
        self.assertEqual(ran.status, 0, ran.err)
        self.assertEqual((out / "script.glb").read_bytes()[:4], b"glTF")

    def test_read_only_disk(self):
        self.write("script.trn", DRAWING)
        out = self.folder / "out"
        out.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "ro,size=64k", "tmpfs", out], capture_output=True,
                                 check=False)
        if mounted.returncode != 0:
            self.skipTest("a read-only disk needs the right to mount one")
        self.addCleanup(subprocess.run, ["umount", out], check=True)
        self.expect_failure()

    def test_report_says_so(self):
        self.write("script.trn", DRAWING)
        self.write("file", "")
        ran = self.tranos("run", "script.trn", "--json", "-o", "file")
        self.assertEqual((ran.status, ran.report["status"], ran.report["outputs"]), (3, 3, []))
        self.assertEqual([found["code"] for found in ran.report["diagnostics"]], ["E0702"])

    def test_journal(self):
        self.write("script.trn", DRAWING)
        self.write("file", "older")
        for path in ("file/a.jsonl", "/proc/a.jsonl", "."):
            with self.subTest(path=path):
                ran = self.tranos("run", "script.trn", "--no-output", "--journal", path)
                self.assertEqual(ran.status, 3, ran.err)
                self.assertIn(path, ran.err)
        self.assertEqual((self.folder / "file").read_text(), "older")


class Streams(harness.ProgramTest):
    def run_into(self, out, *arguments):
        return subprocess.run([harness.Options.program, *arguments], stdout=out, stderr=subprocess.PIPE,
                              cwd=self.folder, check=False, timeout=60)

    def test_standard_output_is_full(self):
        self.write("script.trn", LARGE)
        with open("/dev/full", "wb") as full:
            for arguments in (["help"], ["run", "script.trn", "--json"], ["run", "script.trn"]):
                with self.subTest(arguments=arguments):
                    ran = self.run_into(full, *arguments)
                    self.assertEqual(ran.returncode, 3, ran.stderr)
                    self.assertIn(b"standard output", ran.stderr)

    def test_reader_goes_away(self):
        self.write("script.trn", LARGE + "for i = 0 to 9999 { print \"a line of some length, {i}\" }\n")
        reading, writing = os.pipe()
        os.close(reading)
        ran = self.run_into(writing, "run", "script.trn")
        os.close(writing)
        self.assertEqual((ran.returncode, ran.stderr), (3, b""))
        self.assertEqual([name for name, data in self.files().items() if data], ["out/script.glb", "script.trn"])


if __name__ == "__main__":
    harness.main()
