# SPDX-License-Identifier: GPL-3.0-or-later
"""The same text gives the same bytes: again, with any number of threads, from another folder."""

import shutil

import harness

# Everything that could depend on an order: shared instances, groups, curved surfaces seen through one another.
SCENE = """
define place pier
  width : length = 1m
{
  place block xy=0,0 dl=width,width
  place circle center radius=width/3 xy=width/2,width/2
  place line xy=0,0,0 dl=0,0,3m
}
for i = 0 to 5 { for j = 0 to 3 { place pier xy=3*i,3*j } }
as=2; place pier width=0.5m xy=-4,0
group as vault {
  place line xy=0,0,0 dl=0,12,0 as axis
  set plane front
  place arc xy=0,0,0 xy=5,0,5 xy=10,0,0 as profile
  construct surface projection of=profile direction=[0,12,0]
}
co=3; fn=24
place circle center radius=4 xy=5,6,3 as ring
place text "nave & aisles" xy=0,-3,0
set view phong antialias
render all size=[320,240]
set view hidden
view front
render file="front.png" size=[200,100]
set view wireframe
view top
render file="top.png" size=[200,100]
"""


class Determinism(harness.ProgramTest):
    def bytes_of(self, path, out, *options, **keywords):
        ran = self.tranos("run", path, "-o", self.folder / out, *options, **keywords)
        self.assertIn(ran.status, (0, 4), ran.err)
        found = {file.name: file.read_bytes() for file in (self.folder / out).rglob("*") if file.is_file()}
        self.assertTrue(found)
        return found

    def compare(self, path, journal=False):
        first = self.bytes_of(path, "first")
        self.assertEqual(self.bytes_of(path, "again"), first)
        self.assertEqual(self.bytes_of(path, "one", "--threads", "1"), first)
        self.assertEqual(self.bytes_of(path, "eight", "--threads", "8"), first)
        elsewhere = self.folder / "some where/else"
        elsewhere.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, elsewhere / path.name)
        self.assertEqual(self.bytes_of(path.name, "elsewhere", cwd=elsewhere), first)
        self.assertEqual(self.bytes_of(elsewhere / path.name, "far", cwd="/"), first)
        return first

    def test_scene(self):
        made = self.compare(self.write("scene.trn", SCENE))
        self.assertEqual(sorted(made), ["front.png", "scene-1.png", "scene.glb", "top.png"])
        self.assertEqual(len(set(made.values())), 4)

    def test_journal(self):
        path = self.write("scene.trn", SCENE)
        first = self.folder / "a.jsonl"
        other = self.folder / "b/b.jsonl"
        other.parent.mkdir()
        self.bytes_of(path, "first", "--journal", first, "--threads", "1")
        self.bytes_of("scene.trn", "again", "--journal", other, "--threads", "8", cwd=self.folder)
        self.assertEqual(first.read_bytes(), other.read_bytes())
        self.assertEqual(self.tranos("replay", first, cwd="/").status, 0)

    def test_reports(self):
        path = self.write("scene.trn", SCENE)
        reports = [self.tranos("run", path, "--json", "--no-output", "--threads", threads).out
                   for threads in (1, 8, 3)]
        self.assertEqual(len(set(reports)), 1)
        self.assertEqual(self.tranos("run", path, "--no-output").status, 0)
        moved = self.write("elsewhere/scene.trn", SCENE)
        there = self.tranos("run", moved, "--json", "--no-output").report
        here = self.tranos("run", path, "--json", "--no-output").report
        self.assertEqual(there, here)

    def test_formatted(self):
        path = self.write("scene.trn", SCENE)
        before = self.tranos("run", path, "--json", "--no-output").report["model_hash"]
        self.assertEqual(self.tranos("fmt", path).status, 0)
        self.assertNotEqual(path.read_text(), SCENE)
        self.assertEqual(self.tranos("run", path, "--json", "--no-output").report["model_hash"], before)

    def test_scripts(self):
        scripts = sorted((harness.ROOT / "scripts").glob("*.trn"))
        self.assertTrue(scripts)
        for script in scripts:
            if harness.Options.sanitized and script.stem != "cruciform_dome":
                continue
            with self.subTest(script=script.name):
                journal = self.folder / (script.stem + ".jsonl")
                first = self.bytes_of(script, script.stem + "/first", "--threads", "1", "--journal", journal)
                self.assertEqual(self.tranos("replay", journal).status, 0)
                self.assertEqual(self.bytes_of(script.name, script.stem + "/again", "--threads", "8",
                                               cwd=script.parent), first)


if __name__ == "__main__":
    harness.main()
