# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits: each that is reached is an error with its code and place, soon, and before the machine suffers."""

import os
import resource
import subprocess
import unittest

import harness


class Limits(harness.ProgramTest):
    def test_steps(self):
        for text in ("for i = 0 to 1e12 { let x = i }", "for i = 0 to 1e12 { }", "let a = map(range(0, 9999), i => i)",
                     "for i = 1 to 1e9 { place circle center radius=i xy=0,0 }",
                     "function f(n) = if n < 1 then 0 else f(n - 1) + f(n - 1)\nlet a = f(30)",
                     "for i = 1 to 1e9 { choose all }", "for i = 1 to 1e9 { co=3 }"):
            with self.subTest(text=text):
                self.assert_refused(text, "E0601", "--limit", "steps=5k")

    def test_a_run_just_within_its_steps(self):
        text = "for i = 1 to 1000 { place point xy=i,0 }"
        low, high = 0, 100_000
        while high - low > 1:
            middle = (low + high) // 2
            enough = self.run_script(text, "--no-output", "--limit", f"steps={middle}").status == 0
            low, high = (low, middle) if enough else (middle, high)
        # For each point: a turn, a command and a data point.
        self.assertLess(abs(high - 3000), 10)

    def test_elements(self):
        for text in ("for i = 0 to 1e9 { place point xy=i,0 }", "place point xy=0,0 as a\n"
                     "array rectangular of=a columns=1000 rows=1000 column_spacing=1m",
                     "define place a { place point xy=0,0 }\nfor i = 0 to 1e9 { place a xy=i,0 }",
                     "place point xy=0,0\nfor i = 0 to 40 { choose all; copy xy=0,0 xy=1,0 }"):
            with self.subTest(text=text):
                self.assert_refused(text, "E0602", "--limit", "elements=500")

    def test_elements_just_within(self):
        text = "for i = 1 to 500 { place point xy=i,0 }"
        self.assertEqual(self.run_script(text, "--limit", "elements=500").status, 0)
        self.assertEqual(self.run_script(text, "--limit", "elements=499").status, 1)

    MEMORY = {
        "a range": "let a = range(0, 1e9)",
        "a list that doubles": "function g(l, n) = if n == 0 then l else g(join(l, l), n - 1)\nlet a = g([1, 2], 60)",
        "a string that doubles": 'function g(s, n) = if n == 0 then s else g("{s}{s}", n - 1)\nlet a = g("dome", 60)',
        "points": "for i = 0 to 1e9 { place point xy=i,0 }",
        "names": 'for i = 0 to 1e9 { lv="level {i}"; place point xy=i,0 }',
        "a chain": "for i = 0 to 200000 { place line xy=i,0 xy=i+1,0 reset }\nchoose all; create chain",
        "undo": "for i = 0 to 1e9 { place point xy=i,0; undo }\n",
        "a text": 'function g(s, n) = if n == 0 then s else g("{s}{s}", n - 1)\nplace text text=g("dome", 24) xy=0,0',
        "lists in a list": "let a = map(range(0, 9999), i => range(0, 9999))",
    }

    def test_memory(self):
        for name, text in self.MEMORY.items():
            with self.subTest(name):
                ran = self.run_script(text, "--no-output", "--limit", "memory=64M,steps=3M")
                self.assertEqual(ran.status, 1, ran.err)
                self.assertIn(ran.codes()[0], ("E0601", "E0603"), ran.err)
                self.assertRegex(ran.err, r"--> script.trn:\d+:\d+")
        for name in ("a range", "a list that doubles", "a string that doubles", "lists in a list"):
            with self.subTest(name):
                self.assert_refused(self.MEMORY[name], "E0603", "--limit", "memory=64M")

    def test_memory_is_bounded_in_truth(self):
        if harness.Options.sanitized:
            self.skipTest("sanitizers take several times the memory")
        for name in ("points", "a list that doubles", "a string that doubles"):
            with self.subTest(name):
                self.write("script.trn", self.MEMORY[name])
                child = subprocess.Popen([harness.Options.program, "run", "script.trn", "--limit", "memory=100M"],
                                         cwd=self.folder, stderr=subprocess.PIPE)
                with child.stderr as told:
                    self.assertRegex(told.read().decode(), r"error\[E060[123]\]")
                _, status, used = os.wait4(child.pid, 0)
                child.returncode = 1
                self.assertEqual(status >> 8, 1)
                self.assertLess(used.ru_maxrss, 160_000)

    def test_memory_for_the_text_itself(self):
        text = "place point xy=0,0\n" * 200_000
        self.write("script.trn", text)
        ran = self.tranos("run", "script.trn", "--limit", "memory=5M")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0603"]), ran.err)
        ran = self.tranos("check", "script.trn", "--limit", "memory=5M")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0603"]), ran.err)

    def test_memory_of_outputs(self):
        text = "tol=1e-9\nfor i = 1 to 300 { place circle center radius=100 xy=i,0 }\n"
        self.assert_refused(text + 'render size=[64,48]\nexport "a.glb"\n', "E0603", "--limit", "memory=60M")

    def test_memory_for_a_picture_with_threads(self):
        text = "render size=[4000,4000]\n"
        self.assert_refused(text, "E0603", "--limit", "memory=20M", "--threads", "8", line=1)

    def test_depth(self):
        text = "function f(n) = if n == 0 then 0 else f(n - 1)\nlet x = f({})\n"
        self.assertEqual(self.run_script(text.format(150)).status, 0)
        self.assert_refused(text.format(300), "E0604")
        self.assertEqual(self.run_script(text.format(300), "--limit", "depth=400").status, 0)
        self.assert_refused(text.format(100), "E0604", "--limit", "depth=50")

    def test_depth_of_definitions_is_counted_by_itself(self):
        text = ("define place a\n n : number = 0\n{{ if n > 0 {{ place a n=n-1 xy=0,0 }} else {{ place point xy=0,0 }} }}\n"
                "function f(n) = if n == 0 then 0 else f(n - 1)\nplace a n={0} xy=f({0}),0\n")
        self.assertEqual(self.run_script(text.format(150)).status, 0)
        self.assert_refused(text.format(250), "E0604")

    def test_depth_of_syntax(self):
        text = "let x = " + "(" * 300 + "1" + ")" * 300
        self.assert_refused(text, "E0108", line=1)
        self.assertEqual(self.run_script(text, "--limit", "depth=400").status, 0)

    def test_greatest_depth_fits_the_stack(self):
        # The frames of a build with sanitizers are several times as large.
        depth = 300 if harness.Options.sanitized else 1000
        for text in ("function f(n) = f(n + 1)\nlet x = f(0)\n", "define place a { place a xy=0,0 }\nplace a xy=0,0\n",
                     "function f(l, n) = sum(map(l, i => f(l, n + 1)))\nlet x = f([1], 0)\n"):
            self.assert_refused(text, "E0604", "--limit", f"depth={depth}")
        for text in ("(" * 2000, "{\n" * 2000, "[" * 2000, "-" * 2000, "if true {\n" * 2000):
            self.assert_refused(("let x = " if text[0] in "([-" else "") + text, "E0108", "--limit", f"depth={depth}")
        nested = "let x = " + "(" * (depth - 10) + "1" + ")" * (depth - 10)
        self.assertEqual(self.run_script(nested, "--limit", f"depth={depth}").status, 0)

    def test_hungry_parameters(self):
        """What would take long or much though it is few steps."""
        for text in ("tol=1e-300\nplace circle center radius=1e9 xy=0,0\nrender\n",
                     "fn=1000000000\nplace circle center radius=1 xy=0,0\n",
                     "place point xy=0,0 as a\narray polar of=a count=1e9 xy=0,0\n",
                     "place point xy=0,0 as a\narray rectangular of=a columns=1e5 rows=1e5 layers=1e5\n",
                     'print "{1/3:999999999}"', "let x = 2^1e9", "let x = range(0, 1, 1e-12)",
                     "render size=[100000000,100000000]\n", "unit x = 1e300m\nunit y = 1e300x\nplace point xy=1y,0\n",
                     'let s = join(map(range(0, 999999), i => "{i:90}"), ",")\nplace text text=s xy=0,0\n'):
            with self.subTest(text=text):
                ran = self.run_script(text, timeout=30)
                self.assertEqual(ran.status, 1, text)
                self.assertTrue(ran.codes(), ran.err)


class Defaults(harness.ProgramTest):
    """The limits that nobody asked for."""

    def test_steps(self):
        if harness.Options.sanitized:
            self.skipTest("fifty million steps take a minute with sanitizers")
        ran = self.assert_refused("for i = 0 to 1e12 { let x = i }", "E0601", line=1)
        self.assertIn("50000000", ran.err)

    def test_elements(self):
        if harness.Options.sanitized:
            self.skipTest("a million elements take gigabytes with sanitizers")
        ran = self.assert_refused("for i = 0 to 1e12 { place point xy=i,0 }", "E0602", line=1)
        self.assertIn("1000000", ran.err)

    def test_memory(self):
        ran = self.assert_refused("let a = range(0, 1e9)", "E0603", line=1)
        self.assertIn("2000000000", ran.err)

    def test_depth(self):
        ran = self.assert_refused("function f(n) = f(n)\nlet x = f(0)", "E0604", line=1)
        self.assertIn("200", ran.err)


class Options(harness.ProgramTest):
    def test_spelling(self):
        for given in ("steps=1", "steps=100k", "memory=1G,steps=2M", "depth=1000", "elements=5"):
            with self.subTest(given=given):
                self.assertEqual(self.run_script("", "--limit", given).status, 0)
        for given in ("steps", "steps=", "steps=0", "steps=-1", "steps=1x", "stps=1", "depth=1001", "steps=1e9", "=", "",
                      "memory=99999999999999999999"):
            with self.subTest(given=given):
                ran = self.run_script("", "--limit", given)
                self.assertEqual(ran.status, 2, given)
                self.assertIn("--limit", ran.err)

    def test_given_twice(self):
        ran = self.run_script("for i = 1 to 9 { place point xy=i,0 }", "--limit", "steps=5", "--limit", "elements=5")
        self.assertEqual(ran.codes(), ["E0601"])


class Streams(harness.ProgramTest):
    @unittest.skipUnless(hasattr(resource, "RLIMIT_AS"), "Linux alone")
    def test_machine_gives_no_memory(self):
        if harness.Options.sanitized:
            self.skipTest("sanitizers reserve terabytes of addresses")
        self.write("script.trn", Limits.MEMORY["a string that doubles"])
        limit = 600_000_000
        ran = self.tranos("run", "script.trn", "--limit", "memory=100G",
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual((ran.status, ran.codes()), (1, ["E0603"]), ran.err)


if __name__ == "__main__":
    harness.main()
