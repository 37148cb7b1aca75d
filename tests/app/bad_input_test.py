# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: a code, a place, status 1, nothing written."""

import harness


class BadText(harness.ProgramTest):
    def test_not_utf8(self):
        ran = self.assert_refused(b"place point xy=0,0\n# caf\xe9\n", "E0101", line=2)
        self.assertIn("byte 24", ran.err)

    def test_utf16(self):
        self.assert_refused("place point xy=0,0".encode("utf-16"), "E0101", line=1)

    def test_unclosed_brace_at_the_end_of_a_megabyte(self):
        comment = "# the nave stood on twelve columns of green marble\n"
        lines = 1_000_000 // len(comment)
        ran = self.assert_refused(comment * lines + "for i = 0 to 3 {\n  place point xy=i,0", "E0106")
        self.assertIn("opened here", ran.err)
        self.assertIn(f"script.trn:{lines + 1}:16", ran.err)

    def test_hundred_thousand_parentheses(self):
        self.assert_refused("let x = " + "(" * 100_000 + "1" + ")" * 100_000, "E0108", line=1)

    def test_hundred_thousand_brackets_braces_ifs_and_minuses(self):
        for text in ("let x = " + "[" * 100_000, "{" * 100_000, "let x = " + "-" * 100_000 + "1",
                     "let x = " + "if true then " * 100_000 + "1", "if true {\n" * 100_000,
                     "let x = " + "2^" * 100_000 + "2", "let x = " + "not " * 100_000 + "true"):
            with self.subTest(text=text[:20]):
                self.assert_refused(text, "E0108")

    def test_control_character_in_a_name(self):
        for character in "\x00\x07\x1b\x7f\x85\u202e":
            with self.subTest(character=repr(character)):
                ran = self.assert_refused(f"place point xy=0,0 as a{character}b\n", "E0102", line=1)
                self.assertNotIn(character, ran.err)

    def test_control_character_in_a_string(self):
        self.assert_refused('place text "a\x07b" xy=0,0\n', "E0102", line=1)

    def test_several_errors_are_told_at_once(self):
        ran = self.assert_refused("plaec line xy=0,0\nlet a = nowhere\n", "E0202")
        self.assertGreaterEqual(len(ran.codes()), 2, ran.err)
        self.assertIn("place line", ran.err)

    def test_a_hundred_thousand_errors_end(self):
        ran = self.assert_refused("let a = )\n" * 100_000, "E0107")
        self.assertLess(len(ran.err), 100_000)
        self.assertRegex(ran.err, r"and \d+ more errors")


class BadRun(harness.ProgramTest):
    def test_infinite_recursion_of_a_function(self):
        self.assert_refused("function f(n) = f(n + 1)\nlet x = f(0)\n", "E0604", line=1)

    def test_infinite_recursion_through_two_functions(self):
        self.assert_refused("function f(n) = g(n)\nfunction g(n) = f(n)\nlet x = f(0)\n", "E0604")

    def test_infinite_recursion_of_a_definition(self):
        self.assert_refused("define place a { place a xy=0,0 }\nplace a xy=0,0\n", "E0604", line=1)

    def test_infinite_recursion_from_a_default(self):
        self.assert_refused("define place a\n n : number = 0\n{ place a n=n+1 xy=0,0 }\nplace a xy=0,0\n", "E0604")

    def test_a_loop_to_1e12(self):
        self.assert_refused("for i = 0 to 1e12 { let x = i }\n", "E0601", "--limit", "steps=2M", line=1)

    def test_division_by_zero_in_a_point(self):
        self.assert_refused("place point xy=1/0,0,0\n", "E0302", line=1)

    def test_degenerate_shapes(self):
        for text in ("place arc edge xy=0,0 xy=1,0 xy=2,0", "place arc edge xy=0,0 xy=0,0 xy=0,0",
                     "place line xy=1,1 xy=1,1", "place circle center radius=0 xy=0,0",
                     "place shape xy=0,0 xy=1,0 xy=2,0 reset", "place block xy=0,0 xy=0,5"):
            with self.subTest(text=text):
                self.assert_refused("place point xy=9,9\n" + text, "E0501", line=2)

    def test_a_chain_of_parts_that_do_not_meet(self):
        self.assert_refused("place line xy=0,0 xy=1,0 reset as a\nplace line xy=5,0 xy=6,0 reset as b\n"
                            "create chain of=[a,b]\n", "E0502", line=3)

    def test_numbers_out_of_all_bounds(self):
        for text, code in (("place circle center radius=1e308*10 xy=0,0", "E0302"), ("let x = 1e999", "E0105"),
                           ("let x = 10^400", "E0302"), ("let x = sqrt(-1)", "E0302"), ("co=-1", "E0212")):
            with self.subTest(text=text):
                self.assert_refused(text, code, line=1)

    def test_what_ran_before_the_error_is_not_written(self):
        ran = self.assert_refused('place point xy=0,0\nrender\nexport "a.glb"\nprint "so far"\nlet x = 1/0\n', "E0302",
                                  line=5)
        self.assertEqual(ran.out, "so far\n")

    def test_a_failed_assertion_before_an_error_is_told_too(self):
        ran = self.assert_refused("assert 1 == 2\nlet x = 1/0\n", "E0302", line=2)
        self.assertIn("assertion failed", ran.err)


if __name__ == "__main__":
    harness.main()
