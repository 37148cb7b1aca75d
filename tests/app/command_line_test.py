# SPDX-License-Identifier: GPL-3.0-or-later
"""Exit statuses, and what the command line sets in a script."""

import os

import harness


class Statuses(harness.ProgramTest):
    def test_fine(self):
        self.assertEqual(self.run_script("place point xy=0,0\n").status, 0)
        self.assertEqual(self.run_script("").status, 0)

    def test_script_is_wrong(self):
        self.assertEqual(self.run_script("plaec point xy=0,0\n").status, 1)
        self.assertEqual(self.run_script("let x = 1/0\n").status, 1)
        self.assertEqual(self.run_script('place point xy=0,0\nexport "../a.glb"\n').status, 1)

    def test_command_line_is_wrong(self):
        self.write("a.trn", "place point xy=0,0\n")
        before = self.files()
        for arguments in ([], ["rnu", "a.trn"], ["run"], ["run", "a.trn", "b.trn"], ["run", "a.trn", "--jsn"],
                          ["run", "a.trn", "--threads", "0"], ["run", "a.trn", "--threads", "many"],
                          ["run", "a.trn", "-D", "x"], ["run", "a.trn", "-D", "=3"], ["run", "a.trn", "-D", "x=3"],
                          ["run", "a.trn", "-o"], ["run", "a.trn", "--allow", "nowhere"], ["explain"],
                          ["explain", "E9999"], ["help", "plaec"], ["diff", "a.trn"], ["replay"], ["a.trn"]):
            with self.subTest(arguments=arguments):
                ran = self.tranos(*arguments)
                self.assertEqual(ran.status, 2, ran.err)
                self.assertEqual(ran.out, "")
                self.assertNotEqual(ran.err, "")
                self.assertEqual(self.files(), before)

    def test_file_cannot_be_read(self):
        os.mkdir(self.folder / "folder.trn")
        os.mkfifo(self.folder / "fifo.trn")
        for verb in ("run", "check", "inspect", "fmt"):
            for name in ("nowhere.trn", "folder.trn", "fifo.trn", "nowhere/a.trn"):
                with self.subTest(verb=verb, name=name):
                    ran = self.tranos(verb, name, timeout=10)
                    self.assertEqual(ran.status, 3, ran.err)
                    self.assertIn(name, ran.err)

    def test_assertion_failed(self):
        ran = self.run_script("place point xy=0,0\nassert 1 == 2\nplace point xy=1,1\nrender size=[64,64]\n")
        self.assertEqual(ran.status, 4)
        self.assertEqual(ran.out.split(), ["out/script.glb", "out/script-1.png"])
        self.assertEqual(len(self.report_of("assert 1 == 2\nplace point xy=0,0\n", status=4)["elements"]), 1)

    def test_error_after_a_failed_assertion(self):
        self.assertEqual(self.run_script("assert 1 == 2\nlet x = 1/0\n").status, 1)


class Parameters(harness.ProgramTest):
    SCRIPT = 'parameter height : length = 12m in 4m..40m "to the cornice"\nparameter bays : count = 3\n' \
             'parameter order : string = "doric"\nprint "{height} {bays} {order}"\n'

    def printed(self, *options, status=0):
        ran = self.run_script(self.SCRIPT, "--no-output", *options)
        self.assertEqual(ran.status, status, ran.err)
        return ran.out if status == 0 else ran

    def test_defaults(self):
        self.assertEqual(self.printed(), "12 m 3 doric\n")

    def test_given(self):
        self.assertEqual(self.printed("-D", "height=14m"), "14 m 3 doric\n")
        self.assertEqual(self.printed("-Dheight=1400cm", "-D", "bays=5"), "14 m 5 doric\n")
        self.assertEqual(self.printed("-D", "height=2*3m + 1m"), "7 m 3 doric\n")
        self.assertEqual(self.printed("-D", 'order="ionic"'), "12 m 3 ionic\n")

    def test_undeclared(self):
        ran = self.printed("-D", "hieght=14m", status=2)
        self.assertIn("`hieght`", ran.err)
        self.assertEqual(ran.out, "")

    def test_bad_values(self):
        for given, code in (("height=30deg", "E0203"), ("height=99m", "E0212"), ("bays=2.5", "E0203"),
                            ("height=", "E0107"), ("height=)", "E0107"), ("height=nowhere", "E0201"),
                            ("height=1m\nlet x = 2", None), ("height=\xff", None), ("height=1/0", "E0302")):
            with self.subTest(given=given):
                ran = self.printed("-D", given, status=1)
                self.assertTrue(ran.codes(), ran.err)
                if code:
                    self.assertEqual(ran.codes()[0], code, ran.err)
                self.assertIn("height" if given.startswith("height") else "bays", ran.err)
                self.assertRegex(ran.err, r"--> .*:1:\d+")

    def test_last_of_two_counts(self):
        self.assertEqual(self.printed("-D", "bays=4", "-D", "bays=5"), "12 m 5 doric\n")


class Hypotheses(harness.ProgramTest):
    def test_choice(self):
        script = 'hypothesis dome { print "dome" }\nhypothesis vault { print "vault" }\n'
        for options, expected in ((), "dome\n"), (("--hypothesis", "dome"), "dome\n"), (("--hypothesis", "vault"),
                                                                                        "vault\n"):
            ran = self.run_script(script, "--no-output", *options)
            self.assertEqual((ran.status, ran.out), (0, expected), ran.err)

    def test_unknown(self):
        ran = self.run_script('hypothesis dome { print "dome" }\n', "--no-output", "--hypothesis", "vualt")
        self.assertEqual(ran.codes(), ["E0219"])
        self.assertIn(ran.status, (1, 2))
        self.assertEqual(ran.out, "")

    def test_unknown_where_there_is_none(self):
        ran = self.run_script("place point xy=0,0\n", "--no-output", "--hypothesis", "vault")
        self.assertEqual(ran.codes(), ["E0219"])


if __name__ == "__main__":
    harness.main()
