#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The standard library as its users meet it.

Usage: library_test.py TRANOS [--sanitized].
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "app"))
import harness  # noqa: E402

FAMILIES = sorted(path.stem for path in (harness.ROOT / "stdlib").glob("*.trn"))
POLE = """define place pole
  "A pole."
  height : length = 2m in 0.1m..4m "half its height"
  lean : number = 0.5 in 0..1 "of its height"
  sides : count = 4 in 3, 4, 6 "not used"
  thick : boolean = false "not used, too"
  turn : angle = 10deg in 0deg..90deg "nor this"
  steps : list of length = [1m, height] in 0.1m..9m "nor these"
{
  place line xy=0,0,0 dl=lean*height,0,2*height
}
"""
SOLID = """define place beam
  "A beam along a path."
  size : length = 0.5m in 0.1m..0.6m "how thick"
{
  %s
  create chain of=sides as path
  place block xy=0,0,0 dl=size,size as profile
  construct solid sweep profile=profile path=path
}
"""
PLACED = "place dome cruciform bay=12m xy=0,0,0 as it\n"


class Lists(harness.ProgramTest):
    def test_all(self):
        ran = self.tranos("lib")
        self.assertEqual(ran.status, 0)
        self.assertEqual([line for line in ran.out.splitlines() if line and not line.startswith(" ")], FAMILIES)

    def test_one_family(self):
        ran = self.tranos("lib", "domes")
        self.assertEqual(ran.status, 0)
        self.assertRegex(ran.out, r"(?m)^  place dome cruciform +Two barrel")
        self.assertNotRegex(ran.out, r"(?m)^\S")

    def test_unknown(self):
        ran = self.tranos("lib", "dome")
        self.assertEqual(ran.status, 2)
        self.assertIn("did you mean `domes`?", ran.err)


class Help(harness.ProgramTest):
    def test_element(self):
        ran = self.tranos("help", "place", "dome", "cruciform")
        self.assertEqual(ran.status, 0)
        for part in ["side of the square bay", "in 1m..200m", "bay/3 if not given", "Interfaces", "springing (bay",
                     "Held to", "    place dome cruciform bay=9m xy=0,0,0"]:
            self.assertIn(part, ran.out)

    def test_beginning(self):
        ran = self.tranos("help", "place", "dome")
        self.assertEqual(ran.status, 0)
        self.assertIn("place dome cruciform", ran.out)

    def test_near_words(self):
        ran = self.tranos("help", "place", "dome", "cruziform")
        self.assertEqual(ran.status, 2)
        self.assertIn("did you mean `place dome cruciform`?", ran.err)


class Runs(harness.ProgramTest):
    def test_out_of_range(self):
        ran = self.run_script("place dome cruciform bay=300m xy=0,0,0")
        self.assertEqual(ran.status, 1)
        self.assertIn("script.trn:1:26", ran.err)
        self.assertIn("expected 1 m..200 m", ran.err)
        self.assertIn("stdlib/domes.trn:", ran.err)

    def test_from_another_folder(self):
        self.write("below/script.trn", "place dome cruciform span=1mm xy=0,0,0")
        ran = self.tranos("check", "below/script.trn")
        self.assertEqual(ran.status, 0)
        ran = self.tranos("run", "below/script.trn")
        self.assertIn("below/script.trn:1:", ran.err)
        self.assertIn(" stdlib/domes.trn:", ran.err)

    def test_formats(self):
        self.write("script.trn", PLACED)
        self.assertEqual(self.tranos("fmt", "--check", "script.trn").status, 0)

    def test_journal_replays(self):
        ran = self.run_script(PLACED, "--journal", "run.jsonl")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertIn('"path":"stdlib/domes.trn"', (self.folder / "run.jsonl").read_text())
        self.assertEqual(self.tranos("replay", "run.jsonl").status, 0)

    def test_differs(self):
        self.write("a.trn", PLACED)
        self.write("b.trn", PLACED.replace("12m", "14m"))
        self.assertIn("it", self.tranos("diff", "a.trn", "b.trn").out)


class Soak(harness.ProgramTest):
    def soak(self, definition, facts="", *options):
        self.write("lib/poles.trn", definition)
        self.write("lib/facts/pole.trn", facts)
        return self.tranos("soak", "--library", "lib", "--settings", "30", "--crossings", *options)

    def test_good(self):
        ran = self.soak(POLE, "place pole xy=0,0,0 as it\nassert it.bbox.max.z within it.height*2 +- 1mm\n")
        self.assertEqual((ran.status, ran.out, ran.err), (0, "45 settings of 1 elements and details: 0 failed\n", ""))

    def test_fails_at_the_end_of_a_range(self):
        ran = self.soak(POLE.replace("0.1m..4m", "0m..4m"))
        self.assertEqual(ran.status, 1)
        self.assertIn("place pole height=0m", ran.err)
        self.assertIn("stdlib/poles.trn:10", ran.err)

    def test_facts_that_do_not_place_it(self):
        ran = self.soak(POLE, "place pole xy=0,0,0\nassert 1 < 2\n")
        self.assertEqual(ran.status, 1)
        self.assertIn("no line of its facts places it and ends with `as it`", ran.err)

    def test_another_family_does_not_matter(self):
        self.write("lib/wrecks.trn", "define place wreck {")
        self.assertEqual(self.soak(POLE, "", "poles").status, 0)
        self.assertEqual(self.soak(POLE, "").status, 1)

    def test_what_it_tells_can_be_run(self):
        ran = self.soak(POLE, "place pole xy=0,0,0 as it\nassert it.bbox.max.z < 6m \"low\"\n")
        self.assertEqual(ran.status, 1)
        self.assertIn("not so: low; it is ", ran.err)
        line = next(line for line in ran.err.splitlines() if line.startswith("place pole height="))
        ran = self.report_of(POLE + line + "\nassert it.bbox.max.z < 6m", status=4)

    def test_dependent_ranges(self):
        ran = self.soak(POLE.replace("0.5 in 0..1", "height/20m in 0..height/10m"))
        self.assertEqual(ran.status, 0, ran.err)
        ran = self.soak(POLE.replace("0.5 in 0..1", "0.5 in 1..height/9m"))
        self.assertEqual(ran.status, 1)
        self.assertIn("the range of `lean` is empty", ran.err)

    def test_default_out_of_its_range(self):
        ran = self.soak(POLE.replace("0.5 in 0..1", "0.1 in 0..height/10m"))
        self.assertEqual(ran.status, 1)
        self.assertIn("place pole height=0.1m", ran.err)
        self.assertIn("E0212", ran.err)

    def test_no_range(self):
        ran = self.soak(POLE.replace(" in 0..1", ""))
        self.assertEqual(ran.status, 1)
        self.assertIn("`place pole` declares no range for `lean`", ran.err)

    def test_plan_leaves_its_plane(self):
        ran = self.soak(POLE.replace("{", '  detail : word = shell in shell, plan "how much"\n{', 1))
        self.assertEqual(ran.status, 1)
        self.assertIn("the plan symbol leaves the plane z = 0", ran.err)

    def test_solid_that_crosses_itself(self):
        ran = self.soak(SOLID % "place line xy=0,0,2 xy=9,0,2 xy=9,6,2 xy=5,6,2 xy=5,-6,2 as sides")
        self.assertEqual(ran.status, 1)
        self.assertIn("a solid intersects itself", ran.err)
        self.assertEqual(ran.out, "35 settings of 1 elements and details: 1 failed\n")

    def test_sound_solid(self):
        ran = self.soak(SOLID % "place line xy=0,0,2 xy=9,0,2 xy=9,6,2 as sides")
        self.assertEqual(ran.status, 0, ran.err)

    def test_same_seed_same_settings(self):
        facts = "place pole xy=0,0,0 as it\nassert it.height < 1m\n"
        self.assertEqual(self.soak(POLE, facts).err, self.soak(POLE, facts).err)
        self.assertNotEqual(self.soak(POLE, facts).err, self.soak(POLE, facts, "--seed", "2").err)

    def test_one(self):
        ran = self.tranos("soak", "string_course", "--settings", "2")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertRegex(ran.out, r"^\d+ settings of \d+ elements and details: 0 failed$")

    def test_unknown(self):
        self.assertEqual(self.tranos("soak", "dome_cruziform").status, 2)


class Gallery(harness.ProgramTest):
    def test_makes_what_it_checks(self):
        ran = self.tranos("gallery", "-o", "here", "dome_cruciform", timeout=300)
        self.assertEqual(ran.status, 0, ran.err)
        self.assertTrue((self.folder / "here/gallery/dome_cruciform.png").read_bytes().startswith(b"\x89PNG"))
        page = self.folder / "here/gallery.md"
        self.assertIn("### place dome cruciform", page.read_text())
        for element in page.read_text().split("![place ")[1:]:  # the pictures that were not asked for
            picture = self.folder / "here" / element.split("](")[1].split(")")[0]
            picture.touch()
        self.assertEqual(self.tranos("gallery", "-o", "here", "--check", timeout=300).status, 0)
        page.write_text(page.read_text().replace("side of", "length of"))
        self.assertEqual(self.tranos("gallery", "-o", "here", "--check", timeout=300).status, 1)


if __name__ == "__main__":
    harness.main()
