# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work shows how far it has come, on a terminal and only there."""

import functools
import os
import pty
import re
import select
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import harness

# A turn of the loop takes its time, on any machine.
BODY = "let x = " + " + ".join(["j/7*j"] * 40)
LONG = f"for j = 1 to 1e9 {{ {BODY} }}\n"


@functools.lru_cache
def steps_of_seconds():
    """A limit that LONG reaches well after the half second in which nothing is shown, on any machine."""
    with tempfile.TemporaryDirectory(prefix="tranos-test-") as folder:
        Path(folder, "long.trn").write_text(LONG)
        for thousands in (100 * 2**k for k in range(20)):
            limit = f"steps={thousands}k"
            begun = time.monotonic()
            ran = harness.run_program("run", "long.trn", "--limit", limit, cwd=folder)
            if time.monotonic() - begun > 1.2:
                return limit
            assert ran.codes() == ["E0601"], ran.err
    raise AssertionError("no limit takes a second")


class Progress(harness.ProgramTest):
    def run_on_terminal(self, *arguments, out=None, until=None):
        """All that the program writes to its terminal, and its status; with `until`, a test on what
        was written so far, the program is interrupted when it holds, so that no machine is too fast."""
        ours, theirs = pty.openpty()
        with subprocess.Popen([harness.Options.program, *arguments], cwd=self.folder, stdin=theirs,
                              stdout=out or theirs, stderr=theirs) as child:
            os.close(theirs)
            shown = b""
            end = time.monotonic() + 60
            while time.monotonic() < end:
                if select.select([ours], [], [], 0.1)[0]:
                    try:
                        shown += os.read(ours, 65536)
                    except OSError:  # the other end is closed
                        break
                elif child.poll() is not None:
                    break
                if until and until(shown.decode(errors="ignore")):
                    child.send_signal(signal.SIGKILL)
                    until = None
            os.close(ours)
            return child.wait(10), shown.decode()

    def screen(self, shown):
        """What is left to be seen of the lines that were written."""
        lines = []
        for line in shown.replace("\r\n", "\n").split("\n"):
            left = line.split("\r\x1b[K")[-1]
            lines.append(left)
        return "\n".join(lines)

    def test_long_run(self):
        self.write("long.trn", LONG)
        status, shown = self.run_on_terminal("run", "long.trn", "--limit", steps_of_seconds())
        self.assertEqual(status, 1)
        self.assertRegex(shown, r"\r\x1b\[K\d+ thousand steps")
        self.assertIn("E0601", shown)
        self.assertNotIn("thousand", self.screen(shown))

    def test_print_takes_the_line_away(self):
        turns = 8_000 if harness.Options.sanitized else 60_000
        self.write("long.trn", f"for i = 1 to 1e6 {{ for j = 1 to {turns} {{ {BODY} }}\n"
                               "print \"turn {i}\" }\n")

        def printed_after_progress(shown):
            return re.search(r"thousand steps.*turn \d+\r\n.*turn \d+\r\n", shown, re.S)

        _, shown = self.run_on_terminal("run", "long.trn", "--no-output", "--limit", "steps=900M",
                                        until=printed_after_progress)
        self.assertTrue(printed_after_progress(shown))
        printed = self.screen(shown).split("\n")[:-1]
        self.assertEqual(printed, [f"turn {i + 1}" for i in range(len(printed))])

    def test_long_picture(self):
        if harness.Options.sanitized:
            self.skipTest("the picture takes minutes under sanitizers")
        self.write("long.trn", "place arc xy=0,0,0 xy=5,0,5 xy=10,0,0 as p\n"
                               "construct surface revolution of=p from=[0,0,-1] to=[9,0,-1]\nset view phong antialias\n"
                               "render size=[2400,1800]\n")
        status, shown = self.run_on_terminal("run", "long.trn")
        self.assertEqual(status, 0)
        self.assertIn("writing long-1.png, 2 of 2", shown)
        self.assertEqual(self.screen(shown).split(), ["out/long.glb", "out/long-1.png"])

    def test_short_run_shows_nothing(self):
        self.write("short.trn", "place point xy=0,0\n")
        status, shown = self.run_on_terminal("run", "short.trn")
        self.assertEqual((status, shown), (0, "out/short.glb\r\n"))

    def test_no_terminal(self):
        ran = self.run_script(LONG, "--limit", steps_of_seconds())
        self.assertNotIn("thousand", ran.err)
        self.assertNotIn("\r", ran.err + ran.out)
        self.assertNotIn("\x1b", ran.err + ran.out)

    def test_report_on_a_file_and_progress_on_the_terminal(self):
        self.write("long.trn", LONG)
        with open(self.folder / "report", "wb") as report:
            status, shown = self.run_on_terminal("run", "long.trn", "--json", "--limit", steps_of_seconds(), out=report)
        self.assertEqual(status, 1)
        self.assertIn("thousand steps", shown)
        self.assertNotIn("thousand", (self.folder / "report").read_text())

    def test_colour_on_a_terminal(self):
        self.write("wrong.trn", "let x = 1/0\n")
        _, shown = self.run_on_terminal("run", "wrong.trn")
        self.assertIn("\x1b[1;31merror[E0302]", shown)


if __name__ == "__main__":
    harness.main()
