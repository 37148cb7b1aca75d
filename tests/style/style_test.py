#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The style check must see each kind of breach, and nothing in a tree without any."""

import tempfile
import unittest
from pathlib import Path

import style

SPDX = "// SPDX-License-Identifier: GPL-3.0-or-later\n"
HEADER = SPDX + "#pragma once\n"
# Not written out, so that a search of the tree for such paths stays clean.
WORK, HOME, SCRATCH = "/" + "work/a", "/" + "home/a", "/" + "tmp/a"


class StyleTest(unittest.TestCase):
    def breaches(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return style.breaches(Path(folder))

    def assert_breach(self, name, text, what):
        self.assertEqual(self.breaches({name: text}), [f"{name}: {what}"])

    def test_sound_tree(self):
        self.assertEqual(self.breaches({
            "geom/curve.h": HEADER + "#include <vector>\n#include <Eigen/Core>\n",
            "geom/curve.cpp": SPDX + '#include "geom/curve.h"\n#include <CGAL/Surface_mesh.h>\n',
            "geom/CMakeLists.txt": "add_library(tranos_geom STATIC curve.cpp)\n",
            "session/journal.h": HEADER + '#include <nlohmann/json_fwd.hpp>\n',
            "session/journal.cpp": SPDX + '#include "interp/run.h"\n#include <fmt/core.h>\n',
            "app/main.cpp": SPDX + '#include "output/gltf.h"\n#include <CLI/CLI.hpp>\n',
            "tests/geom/curve_test.cpp": SPDX + f"#include <tiny_gltf.h>\n// {SCRATCH}\n",
            "dev": "#!/bin/sh\n# SPDX-License-Identifier: GPL-3.0-or-later\n",
            "build/x.cpp": "TODO\n",
        }), [])

    def test_arrows_run_downward(self):
        for room, target in [("geom", "camera"), ("geom", "model"), ("camera", "model"),
                             ("model", "interp"), ("interp", "session"), ("interp", "output"),
                             ("session", "output"), ("session", "app"), ("output", "interp"),
                             ("output", "session"), ("output", "app")]:
            self.assert_breach(f"{room}/a.cpp", SPDX + f'# include "{target}/b.h"\n',
                               f"{room} may not know {target}")

    def test_include_names_its_room(self):
        self.assert_breach("geom/a.cpp", SPDX + '#include "b.h"\n',
                           '"b.h" does not begin with a room')
        self.assert_breach("geom/a.cpp", SPDX + '#include "../interp/b.h"\n',
                           '"../interp/b.h" does not begin with a room')

    def test_doors(self):
        for name, included, doors in [
                ("geom/solid.h", "CGAL/Nef_3.h", "geom/*.cpp, geom/exact_corners.h"),
                ("model/a.cpp", "CGAL/Nef_3.h", "geom/*.cpp, geom/exact_corners.h"),
                ("output/obj.cpp", "tiny_gltf.h", "output/gltf.cpp, output/gltf_tables.h"),
                ("geom/a.cpp", "opencv2/core.hpp", "camera/*.cpp"),
                ("camera/pose.cpp", "ceres/ceres.h", "camera/refinement.cpp"),
                ("session/a.cpp", "xxhash.h", "model/hash.cpp"),
                ("session/a.h", "nlohmann/json.hpp", "*.cpp"),
                ("interp/a.cpp", "fstream", "app/*.cpp"),
                ("model/a.h", "fmt/core.h", "*.cpp")]:
            text = (HEADER if name.endswith(".h") else SPDX) + f"#include <{included}>\n"
            self.assert_breach(name, text, f"<{included}> belongs in {doors}")

    def test_unknown_library(self):
        self.assert_breach("geom/a.cpp", SPDX + "#include <boost/any.hpp>\n",
                           "<boost/any.hpp> has no door in tests/style/style.py")

    def test_licence_line(self):
        what = "does not start with the SPDX line"
        self.assert_breach("geom/a.cpp", "int a;\n" + SPDX, what)
        self.assert_breach("geom/a.def", "", what)
        self.assert_breach("bench/run.py", "#!/usr/bin/env python3\n", what)
        self.assert_breach("dev", "#!/bin/sh", what)

    def test_length(self):
        self.assertEqual(self.breaches({"geom/a.cpp": SPDX + "\n" * 698}), [])
        self.assert_breach("geom/a.cpp", SPDX + "\n" * 699, "has more than 700 lines")

    def test_words(self):
        self.assert_breach("README.md", "TODO: say more\n", "contains TODO")
        self.assert_breach("CMakeLists.txt", "# FIXME\n", "contains FIXME")
        self.assert_breach("docs/a.md", f"cd {WORK}\n", f"contains {WORK}")
        self.assert_breach("tests/geom/a.py", f"# {SPDX}# {HOME}\n", f"contains {HOME}")
        self.assert_breach("scripts/a.trn", f"export file={SCRATCH}\n", f"contains {SCRATCH}")

    def test_names(self):
        self.assert_breach("geom/string_utils.cpp", SPDX, "is named after no thing")

    def test_include_guard(self):
        self.assert_breach("geom/a.h", SPDX, "lacks #pragma once")

    def test_source_outside_the_build(self):
        self.assertEqual(self.breaches({
            "geom/CMakeLists.txt": "add_library(tranos_geom STATIC curve.cpp)\n",
            "geom/curves.cpp": SPDX,
        }), ["geom/curves.cpp: is not named in geom/CMakeLists.txt"])


if __name__ == "__main__":
    unittest.main()
