# SPDX-License-Identifier: GPL-3.0-or-later
"""The Khronos validator finds no error and no warning in any model that is written."""

import shutil
import subprocess

import harness

# By what each is about; together every command that makes something, and every kind of element.
MODELS = {
    "empty": "",
    "points": "for i = 0 to 9 { place point xy=i,0,i }",
    "lines": "place line xy=0,0 xy=1,0 xy=1,1 reset as side\nco=5 wt=3 lc=2\nplace line xy=5,5,5 dl=0,0,1",
    "short line": "place line xy=1000,1000,1000 dl=0,0,1e-6",
    "arcs": "place arc xy=0,0 xy=1,1 xy=2,0\nplace arc center xy=2,0 xy=0,0 xy=0,2\nfn=8\nplace arc xy=0,3 xy=1,4 xy=2,3",
    "circles": "place circle center radius=1 xy=0,0\nplace circle edge xy=0,0 xy=1,1 xy=2,0\nset plane front\n"
               "place circle xy=0,0 xy=3,0",
    "outlines": "place block xy=0,0 xy=3,2\nplace shape xy=0,0 xy=3,0 xy=3,3 xy=1,5 reset",
    "text": 'aa=30 as=2\nplace text "Nave Αψίς {1+1}" xy=1,2,3\nplace text " " xy=0,0',
    "chains": "place line xy=0,0 xy=1,0 reset as a\nplace arc xy=1,0 xy=2,1 xy=1,2 as b\ncreate chain of=[a,b]\n"
              "place line xy=9,0 xy=10,0 xy=10,1 xy=9,0 reset as c\ncreate shape of=c",
    "surfaces": "place arc xy=0,0,0 xy=5,0,5 xy=10,0,0 as p\nconstruct surface projection of=p keep=true direction=[0,9,0]\n"
                "construct surface revolution of=p keep=true from=[0,0,9] to=[9,0,9] angle=200deg\n"
                "place line xy=0,20,0 xy=10,20,4 reset as q\nconstruct surface ruled of=[p,q]",
    "edge surface": "place line xy=0,0,0 xy=4,0,1 xy=4,4,0 xy=0,4,1 xy=0,0,0 as sides\n"
                    "construct surface edge of=sides",
    "instances": "define place pier\n h : length = 3m\n{ place circle center radius=0.3 xy=0,0 as foot\n"
                 "place line xy=0,0,0 dl=0,0,h }\nfor i = 0 to 9 { aa=10*i; place pier xy=3*i,0 }\n"
                 "as=[1,2,3]; place pier h=4m xy=0,9\nplace pier xy=0,0 as p\nmirror of=p xy=-1,0 xy=-1,1",
    "groups": "group as wing { place point xy=0,0 as tip\ngroup as inner { place line xy=0,0 xy=1,1 } }\n"
              "place point xy=9,9 as a\nplace point xy=8,8 as b\ncreate group of=[a,b]",
    "names": 'lv="a \\"b\\" \\\\ {{c}} \\n ☃ \U0001d11e"\nplace point xy=0,0 as Ναός\nev=excavation source="№ 4 \\"x\\""\n'
             'mt="marble/green"\nplace line xy=0,0 xy=1,1',
    "colours": 'for i = 0 to 255 { co=i; place point xy=i,0 }\nco="#80ff00"\nplace block xy=0,0 xy=1,1',
    "far away": "place circle center radius=1 xy=1e8,1e8\nplace line xy=-1e8,0,0 xy=1e8,0,0",
    "transforms": "place line xy=0,0 xy=1,2 reset as a\ncopy of=a xy=0,0 xy=5,0 xy=9,0\naa=45; rotate copy of=a xy=0,0\n"
                  "as=2; scale of=a xy=0,0\nmirror copy of=a xy=0,0 xy=0,1\n"
                  "array rectangular of=a columns=4 rows=3 column_spacing=2m row_spacing=3m\n"
                  "array polar of=a count=5 xy=0,0,0",
    "poles": "place arc xy=0,0,0 xy=5,0,5 xy=10,0,0 as p\n"
                    "construct surface revolution of=p from=[0,0,0] to=[1,0,0]",
    "levels off": 'lv=2; place point xy=0,0\nlevel off 2\nlv=1; place point xy=1,1',
    "cameras": "place camera f=33.33mm format=40.5mm,26.7mm size=484,319 aspect=1.03 skew=89.07deg omega=15.96deg "
               "phi=35.28deg kappa=1.52deg xy=14.79m,-27.73m,-1.78m as paper\nset camera paper\n"
               "trace edge x dot=10,10 dot=200,15",
    "deleted": "place point xy=0,0 as a\nplace point xy=1,1\ndelete of=a",
    "exports": 'place point xy=0,0\nexport "before.glb"\nplace circle center radius=2 xy=0,0\nexport "more/after.glb"',
}


class Validator(harness.ProgramTest):
    def setUp(self):
        super().setUp()
        node = shutil.which("node")
        package = harness.ROOT / "build/npm/node_modules/gltf-validator"
        if not node or not package.exists():
            self.skipTest("gltf-validator is not installed; ./dev setup does it")

    def validate(self):
        files = sorted(self.folder.rglob("*.glb"))
        self.assertTrue(files)
        ended = subprocess.run(["node", harness.ROOT / "tests/output/validate_gltf.mjs", *files], capture_output=True,
                               text=True, timeout=120, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertEqual(ended.stdout.count(" 0 errors, 0 warnings"), len(files), ended.stdout)

    def test_every_kind_of_element(self):
        for name, text in MODELS.items():
            with self.subTest(name):
                stem = name.replace(" ", "_")
                self.write(f"{stem}.trn", text)
                ran = self.tranos("run", f"{stem}.trn", "-o", f"out/{stem}")
                self.assertEqual(ran.status, 0, ran.err)
        self.validate()

    def test_textures(self):
        """Orthophotos on faces and by themselves, and the photograph at its frame."""
        goldens = harness.ROOT / "tests/language/photograph"
        shutil.copy(goldens / "facade.png", self.folder)
        built = (goldens / "an_orthophoto_reaches_over_what_is_built.trn").read_text(encoding="utf-8").split("choose")[0]
        alone = (goldens / "an_orthophoto_is_to_scale.trn").read_text(encoding="utf-8")
        for name, text in {"built": built + "set view photo\n", "alone": alone}.items():
            self.write(f"{name}.trn", text)
            ran = self.tranos("run", f"{name}.trn", "-o", f"out/{name}")
            self.assertEqual(ran.status, 0, ran.err)
        self.validate()

    def test_scripts(self):
        if harness.Options.sanitized:
            self.skipTest("the bytes are those of the build without sanitizers")
        for script in sorted((harness.ROOT / "scripts").glob("*.trn")):
            with self.subTest(script=script.name):
                ran = self.tranos("run", script, "-o", self.folder / script.stem)
                self.assertEqual(ran.status, 0, ran.err)
        self.validate()


if __name__ == "__main__":
    harness.main()
