#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Made-up documents, each of which breaks one rule of documents.py.

Usage: documents_test.py TRANOS
"""

import sys
import tempfile
import unittest
from pathlib import Path

import documents

TRANOS = ""


def findings(text):
    """What is found in a document's examples."""
    return list(documents.check_examples(TRANOS, Path("made_up.md"), text))


def example(body, marks="trn"):
    return f"prose\n\n```{marks}\n{body}\n```\n"


class Examples(unittest.TestCase):
    def test_what_happens_as_announced_is_no_finding(self):
        self.assertEqual([], findings(example('print "a"  # expect: a\nassert true')))

    def test_prints_are_announced(self):
        self.assertEqual(["made_up.md:4: printed ['a'], expected []"], findings(example('print "a"')))
        self.assertEqual(["made_up.md:4: printed [], expected ['a']"], findings(example("# expect: a\nlet x = 1")))

    def test_errors_are_announced_with_their_line(self):
        self.assertEqual([], findings(example("let a = 3m + 1deg  # expect error E0301")))
        found = findings(example("let b = 1\nlet a = 3m + 1deg"))
        self.assertEqual(1, len(found))
        self.assertTrue(found[0].startswith("made_up.md:5: E0301"), found)
        self.assertEqual(2, len(findings(example("let b = 1  # expect error E0301\nlet a = 3m + 1deg"))))
        self.assertEqual(2, len(findings(example("let a = 3m + 1deg  # expect error E0203"))))

    def test_a_part_of_the_message_counts(self):
        self.assertEqual(2, len(findings(example("let a = 3m + 1deg  # expect error E0301: a giraffe"))))

    def test_a_comment_in_its_own_line_speaks_of_the_next(self):
        self.assertEqual([], findings(example("# expect error E0301\nlet a = 3m + 1deg")))

    def test_assertions_hold_unless_they_must_fail(self):
        self.assertEqual(["made_up.md:4: this assertion fails"], findings(example("assert 1 > 2")))
        self.assertEqual([], findings(example("assert 1 > 2  # expect failed")))
        self.assertEqual(["made_up.md:4: no assertion fails here"], findings(example("assert 2 > 1  # expect failed")))

    def test_an_expectation_is_understood(self):
        self.assertIn("made_up.md:4: what is expected here?", findings(example("let a = 1  # expect error")))

    def test_what_is_for_later_says_so(self):
        self.assertEqual([], findings(example("place dimension xy=0,0,0", "trn later")))
        found = findings(example("place point xy=0,0,0", "trn later"))
        self.assertEqual(["made_up.md:4: expected E0001 alone, got []"], found)

    def test_files_are_beside(self):
        text = example("let a = 5", "trn file=a.trn") + example('use "a.trn"\nassert a == 5')
        self.assertEqual([], findings(text))

    def test_what_is_said_is_said_to_the_letter(self):
        found = findings(example("let a = 3m + 1deg  # expect error E0301") + "```text says\nwell, well\n```\n")
        self.assertEqual(1, len(found))
        self.assertIn("error[E0301]", found[0])
        text = found[0].partition("\n")[2]
        self.assertEqual([], findings(example("let a = 3m + 1deg  # expect error E0301") + f"```text says\n{text}```\n"))

    def test_other_blocks_are_left_alone(self):
        self.assertEqual([], findings(example("rubbish", "text")))


class Links(unittest.TestCase):
    def found(self, text, other=""):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.md")
            path.write_text(text, encoding="utf-8")
            Path(folder, "b.md").write_text(other, encoding="utf-8")
            Path(folder, "large.png").write_bytes(bytes(documents.MAX_PICTURE_BYTES + 1))
            return [line.partition(": ")[2] for line in documents.check_links(path, text)]

    def test_files_exist(self):
        self.assertEqual([], self.found("[b](b.md) [out](https://example.org/c.md)"))
        self.assertEqual(["no file for c.md"], self.found("[c](c.md)"))

    def test_headings_exist(self):
        self.assertEqual([], self.found("[b](b.md#2-two-words)", "# 2. Two words\n"))
        self.assertEqual(["no heading for b.md#three"], self.found("[b](b.md#three)", "```\n# three\n```\n"))
        self.assertEqual([], self.found("[here](#here)\n\n## Here\n"))

    def test_pictures_are_small(self):
        self.assertEqual(1, len(self.found("![large](large.png)")))

    def test_blocks_hold_no_links(self):
        self.assertEqual([], self.found("```\n[c](c.md)\n```\n"))


class Scripts(unittest.TestCase):
    def found(self, text, name="hall.trn"):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder, name)
            script.write_text(text, encoding="utf-8")
            return [line.partition(": ")[2] for line in documents.check_script(TRANOS, script)]

    def test_a_script_runs_and_checks_itself(self):
        self.assertEqual([], self.found("let a = 1\nassert a == 1\n"))
        self.assertEqual(["asserts nothing"], self.found("let a = 1\n"))
        self.assertEqual(["this assertion fails"], self.found("assert 1 == 2\n"))
        self.assertTrue(any(line.startswith("E0202") for line in self.found("place\n")))

    def test_a_script_says_what_it_announces(self):
        self.assertEqual([], self.found('print "a"  # expect: a\nassert true\n'))
        self.assertEqual(["printed ['a'], expected []"], self.found('print "a"\nassert true\n'))
        self.assertEqual([], self.found("unknown a = 1m  # expect warning W0001\nassert true\n"))

    def test_a_script_holds_with_each_of_its_hypotheses(self):
        text = "hypothesis early {{ let a = 1 }}\nhypothesis late {{ let a = {} }}\nassert a < 3\n"
        self.assertEqual([], self.found(text.format(2)))
        self.assertEqual(["does not hold with the hypothesis late, status 4"], self.found(text.format(3)))

    def test_a_script_is_in_the_one_layout_and_short(self):
        self.assertEqual(["is not in the layout of tranos fmt"], self.found("assert   true\n"))
        self.assertEqual(["is longer than 400 lines"], self.found("assert true\n" * 401))

    def test_the_papers_script_stays(self):
        self.assertEqual([], self.found("place line;xy=0,0,0;dl=1\n", documents.VERBATIM))


if __name__ == "__main__":
    TRANOS = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
