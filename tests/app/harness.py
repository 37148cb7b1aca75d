# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the program share: a folder for each test, runs, and the words of their claims."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Options:
    """From the command line of a test file: the program, and whether it has sanitizers."""

    program = ""
    sanitized = False


class Ran:
    """A run of the program that has ended."""

    def __init__(self, status, out, err):
        self.status = status
        self.out = out.decode("utf-8", "strict")
        self.err = err.decode("utf-8", "strict")

    @property
    def report(self):
        return json.loads(self.out, parse_constant=not_json)

    def codes(self):
        return re.findall(r"^error\[(E\d{4})\]", self.err, re.MULTILINE)


def not_json(word):
    raise ValueError(f"{word} is no JSON")


def run_program(*arguments, cwd=None, text=None, timeout=60, **keywords):
    ended = subprocess.run([Options.program, *map(str, arguments)], cwd=cwd, input=text, capture_output=True,
                           timeout=timeout, check=False, **keywords)
    return Ran(ended.returncode, ended.stdout, ended.stderr)


class ProgramTest(unittest.TestCase):
    """Each test starts in an empty folder of its own."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="tranos-test-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def tranos(self, *arguments, **keywords):
        """Runs the program in the test's folder."""
        keywords.setdefault("cwd", self.folder)
        ran = run_program(*arguments, **keywords)
        self.assertNotIn("Sanitizer", ran.err)
        self.assertNotIn("error: a fault of ours", ran.err)
        return ran

    def run_script(self, text, *options, **keywords):
        self.write("script.trn", text)
        return self.tranos("run", "script.trn", *options, **keywords)

    def report_of(self, text, *options, status=0):
        ran = self.run_script(text, "--json", *options)
        self.assertEqual(ran.status, status, ran.err)
        return ran.report

    def files(self):
        """All there is below the test's folder, with contents."""
        return {str(path.relative_to(self.folder)): path.read_bytes() if path.is_file() else None
                for path in sorted(self.folder.rglob("*"))}

    def assert_refused(self, text, code, *options, line=None, status=1, **keywords):
        """The script is refused with this code, at a place in its text, and nothing is written or harmed."""
        self.write("script.trn", text)
        older = self.write("out/script.glb", "older")
        before = self.files()
        ran = self.tranos("run", "script.trn", *options, **keywords)
        self.assertEqual(ran.status, status, ran.err)
        self.assertEqual(ran.codes()[:1], [code], ran.err)
        place = re.search(r"--> (\S+):(\d+):(\d+)$", ran.err, re.MULTILINE)
        self.assertTrue(place, ran.err)
        self.assertIn("^", ran.err)
        if line is not None:
            self.assertEqual(int(place[2]), line, ran.err)
        self.assertEqual(self.files(), before)
        self.assertEqual(older.read_bytes(), b"older")
        self.assertNotIn(".glb", ran.out)
        return ran


def main():
    """PROGRAM [--sanitized] [what unittest takes]"""
    Options.program = os.path.abspath(sys.argv.pop(1))
    if "--sanitized" in sys.argv:
        sys.argv.remove("--sanitized")
        Options.sanitized = True
    unittest.main(module="__main__")
