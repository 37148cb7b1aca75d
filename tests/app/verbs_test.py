# SPDX-License-Identifier: GPL-3.0-or-later
"""help, explain, check, fmt, docs and version."""

import json
import re

import harness


class Help(harness.ProgramTest):
    def help(self, *words):
        ran = self.tranos("help", *words)
        self.assertEqual((ran.status, ran.err), (0, ""))
        return ran.out

    def test_list(self):
        text = self.help()
        for word in ("place arc", "construct surface edge", "undo mark", "render all", "tranos help place arc"):
            self.assertIn(word, text)
        self.assertIn("not in this version yet: ", text)
        self.assertRegex(text, r"not in this version yet:[^.]*place\s+dimension")

    def test_lines_fit(self):
        for words in ([], ["place"], ["set", "view"], ["statements"], ["settings"], ["functions"], ["points"],
                      ["array", "rectangular"], ["create", "chain"]):
            for line in self.help(*words).splitlines():
                self.assertLessEqual(len(line), 100, line)

    def test_command(self):
        self.assertEqual(self.help("place", "arc"), """\
place arc
  A circular arc from its start through a point on it to its end.

  Asks for start, then point on the arc, then end; then begins anew.

    place arc xy=10,0,0 xy=15,0,5 xy=20,0,0
    # then last.bbox.max.z within 5m +- 0.000001m

  See also  place arc edge, place arc center, place arc tangent
""")
        self.assertEqual(self.help("place arc"), self.help("PLACE", "Arc"))

    def test_every_command_there_is(self):
        reference = (harness.ROOT / "docs/reference.md").read_text()
        commands = re.findall(r"^### (.*)$", reference, re.MULTILINE)
        self.assertGreater(len(commands), 100)
        # A process each is slow with sanitizers.
        for words in commands[::20 if harness.Options.sanitized else 1]:
            text = self.help(*words.split())
            self.assertTrue(text.startswith(words + "\n  "), text)
            self.assertNotIn("Asks for .", text)

    def test_keys_have_words_and_standards(self):
        text = self.help("array", "rectangular")
        self.assertRegex(text, r"\n  columns= +a count: how many.*; 1 if not given\n")

    def test_beginning(self):
        text = self.help("array")
        self.assertEqual(re.findall(r"^  (array \w+)", text, re.MULTILINE), ["array rectangular", "array polar",
                                                                           "array path"])

    def test_what_is_not_there_yet(self):
        self.assertIn("E0001", self.help("place", "dimension"))

    def test_words(self):
        self.assertIn("palette", self.help("co"))
        self.assertEqual(self.help("co="), self.help("co"))
        self.assertIn("square root", self.help("sqrt"))
        self.assertIn("for i = 0 to 7", self.help("for"))
        self.assertIn("data point", self.help("dl"))

    def test_unknown(self):
        ran = self.tranos("help", "plaec", "line")
        self.assertEqual((ran.status, ran.out), (2, ""))
        self.assertIn("did you mean `place line`?", ran.err)
        ran = self.tranos("help", "baluster")
        self.assertEqual(ran.status, 2)
        self.assertIn("construct surface revolution", ran.err)
        ran = self.tranos("help", "\x1b[31m")
        self.assertEqual(ran.status, 2)
        self.assertNotIn("\x1b", ran.err)

    def test_of_the_command_line(self):
        ran = self.tranos("--help")
        self.assertEqual((ran.status, ran.err), (0, ""))
        for verb in "run check inspect trace fmt replay diff help explain docs version".split():
            self.assertRegex(ran.out, rf"\n  {verb} +[A-Z].*\.\n")
            told = self.tranos(verb, "--help")
            self.assertEqual(told.status, 0)
            self.assertIn(f"tranos {verb}", told.out)
        self.assertIn("Exit status", ran.out)

    def test_version(self):
        ran = self.tranos("version")
        self.assertRegex(ran.out, r"^tranos \d+\.\d+\.\d+\n$")
        self.assertEqual(self.tranos("--version").out, ran.out)


class Explain(harness.ProgramTest):
    def test_every_code(self):
        table = (harness.ROOT / "interp/diagnostics.def").read_text()
        codes = re.findall(r'^TRANOS_DIAGNOSTIC\("([EW]\d{4})"', table, re.MULTILINE)
        self.assertGreater(len(codes), 50)
        for code in codes[::10 if harness.Options.sanitized else 1]:
            ran = self.tranos("explain", code.lower())
            self.assertEqual(ran.status, 0)
            head, empty, text = ran.out.split("\n", 2)
            self.assertTrue(head.startswith(code + ": "), ran.out)
            self.assertEqual(empty, "")
            self.assertGreater(len(text), 20)

    def test_unknown(self):
        for code in ("E9999", "", "\x1b", "E02033"):
            ran = self.tranos("explain", code)
            self.assertEqual((ran.status, ran.out), (2, ""))
            self.assertNotIn("\x1b", ran.err)


class Check(harness.ProgramTest):
    def test_good(self):
        self.write("a.trn", "place point xy=0,0\nrender\nassert 1 == 2\nprint \"never\"\n")
        ran = self.tranos("check", "a.trn")
        self.assertEqual((ran.status, ran.out, ran.err), (0, "", ""))
        self.assertEqual(list(self.files()), ["a.trn"])

    def test_runs_nothing(self):
        self.write("a.trn", "for i = 1 to 1e12 { let x = i }\nlet y = 1/0\n")
        self.assertEqual(self.tranos("check", "a.trn", timeout=10).status, 0)

    def test_bad(self):
        self.write("a.trn", "plaec line xy=0,0\nlet a = nowhere\nplace line colour=3 xy=0,0\n")
        ran = self.tranos("check", "a.trn")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0202", "E0201", "E0204"]))
        ran = self.tranos("check", "a.trn", "--json")
        self.assertEqual((ran.status, ran.err), (1, ""))
        self.assertEqual([(found["code"], found["line"]) for found in json.loads(ran.out)],
                         [("E0202", 1), ("E0201", 2), ("E0204", 3)])

    def test_json_of_a_good_one(self):
        self.write("a.trn", "place point xy=0,0\n")
        self.assertEqual(json.loads(self.tranos("check", "a.trn", "--json").out), [])

    def test_used_files(self):
        self.write("a.trn", 'use "b.trn"\n')
        self.assertEqual(self.tranos("check", "a.trn").status, 3)
        self.write("b.trn", "let x = nowhere\n")
        ran = self.tranos("check", "a.trn")
        self.assertEqual((ran.status, ran.codes()), (1, ["E0201"]))
        self.assertIn("b.trn:1:9", ran.err)

    def test_parameters(self):
        self.write("a.trn", "parameter n : count = 3\n")
        self.assertEqual(self.tranos("check", "a.trn", "-D", "n=4").status, 0)
        self.assertEqual(self.tranos("check", "a.trn", "-D", "m=4").status, 2)


class Fmt(harness.ProgramTest):
    ROUGH = "# the sill\nplace   line;xy=0,0,0 ; dl=10   # goes east\nfor i=0 to 3{place point xy=i,0}\n"

    def test_standard_input(self):
        ran = self.tranos("fmt", text=self.ROUGH.encode())
        self.assertEqual((ran.status, ran.err), (0, ""))
        self.assertIn("# goes east", ran.out)
        again = self.tranos("fmt", text=ran.out.encode())
        self.assertEqual(again.out, ran.out)

    def test_in_place(self):
        path = self.write("a.trn", self.ROUGH)
        path.chmod(0o640)
        self.assertEqual(self.tranos("fmt", "a.trn").status, 0)
        self.assertNotEqual(path.read_text(), self.ROUGH)
        self.assertEqual(path.stat().st_mode & 0o777, 0o640)
        self.assertEqual(list(self.files()), ["a.trn"])

    def test_through_a_link(self):
        path = self.write("a.trn", self.ROUGH)
        (self.folder / "link.trn").symlink_to("a.trn")
        self.assertEqual(self.tranos("fmt", "link.trn").status, 0)
        self.assertTrue((self.folder / "link.trn").is_symlink())
        self.assertNotEqual(path.read_text(), self.ROUGH)

    def test_check(self):
        path = self.write("a.trn", self.ROUGH)
        ran = self.tranos("fmt", "--check", "a.trn")
        self.assertEqual((ran.status, ran.out), (1, "a.trn would change\n"))
        self.assertEqual(path.read_text(), self.ROUGH)
        self.tranos("fmt", "a.trn")
        self.assertEqual(self.tranos("fmt", "--check", "a.trn").status, 0)

    def test_what_cannot_be_read_stays(self):
        for text in (b"place line xy=(0,0\n", b"# \xff\n", b"(" * 100_000):
            path = self.write("a.trn", text)
            ran = self.tranos("fmt", "a.trn")
            self.assertEqual(ran.status, 1)
            self.assertTrue(ran.codes())
            self.assertEqual(path.read_bytes(), text)

    def test_several(self):
        self.write("a.trn", self.ROUGH)
        self.write("b.trn", "(")
        self.assertEqual(self.tranos("fmt", "b.trn", "a.trn").status, 1)
        self.assertEqual(self.tranos("fmt", "--check", "a.trn").status, 0)

    def test_scripts_are_formatted(self):
        scripts = [path for path in (harness.ROOT / "scripts").glob("*.trn") if path.stem != "cruciform_dome"]
        ran = self.tranos("fmt", "--check", *scripts)
        self.assertEqual(ran.status, 0, ran.out)


class Docs(harness.ProgramTest):
    def test_reference_is_not_stale(self):
        ran = self.tranos("docs", "--check", "-o", harness.ROOT / "docs/reference.md")
        self.assertEqual(ran.status, 0, ran.err)

    def test_writes(self):
        (self.folder / "docs").mkdir()
        ran = self.tranos("docs")
        self.assertEqual((ran.status, ran.out), (0, "docs/reference.md\n"))
        text = (self.folder / "docs/reference.md").read_text()
        self.assertIn("### place arc\n", text)
        self.assertEqual(text.count("```") % 2, 0)
        self.assertEqual(self.tranos("docs", "--check").status, 0)
        self.write("docs/reference.md", text + " ")
        self.assertEqual(self.tranos("docs", "--check").status, 1)

    def test_cannot_write(self):
        self.assertEqual(self.tranos("docs", "-o", "nowhere/reference.md").status, 3)


if __name__ == "__main__":
    harness.main()
