# SPDX-License-Identifier: GPL-3.0-or-later
"""`tranos run --json` and what goes to which stream."""

import math
import re
import shutil

import harness

MEMBERS = ["status", "model_hash", "elements", "outputs", "asserts", "cameras", "diagnostics"]
ELEMENT = ["id", "name", "type", "level", "evidence", "source", "parent", "bbox", "length", "area", "volume",
           "covariance", "hash"]


class Report(harness.ProgramTest):
    def test_members(self):
        report = self.report_of("place line xy=0,0 xy=3,4 as edge\nassert edge.length == 5m\n")
        self.assertEqual(list(report), MEMBERS)
        self.assertEqual(report["status"], 0)
        self.assertRegex(report["model_hash"], "^[0-9a-f]{32}$")
        [element] = report["elements"]
        self.assertEqual(list(element), ELEMENT)
        self.assertEqual(element, {
            "id": 0, "name": "edge", "type": "line", "level": "1", "evidence": None, "source": None, "parent": None,
            "bbox": {"min": [0, 0, 0], "max": [3, 4, 0]}, "length": 5, "area": None, "volume": None,
            "covariance": None, "hash": element["hash"]})
        self.assertEqual(report["cameras"], [])
        self.assertEqual(report["diagnostics"], [])
        [output] = report["outputs"]
        self.assertEqual(output, {"path": "out/script.glb", "bytes": (self.folder / "out/script.glb").stat().st_size})

    def test_asserts(self):
        report = self.report_of('assert 1 + 1 == 2\nassert 3m within 4m +- 10cm "nave"\n', status=4)
        self.assertEqual(report["status"], 4)
        first, second = report["asserts"]
        self.assertEqual(list(first), ["text", "message", "value", "expected", "passed", "span"])
        self.assertEqual([first["text"], first["message"], first["passed"]], ["1 + 1 == 2", None, True])
        self.assertEqual([second["value"], second["expected"], second["passed"]], ["3 m", "4 m ± 0.1 m", False])
        self.assertEqual(second["message"], "nave")
        self.assertEqual([second["span"][key] for key in ("path", "line", "column")], ["script.trn", 2, 8])
        text = (self.folder / "script.trn").read_bytes()
        self.assertEqual(text[second["span"]["begin"]:second["span"]["end"]], b"3m within 4m +- 10cm")

    def test_measures_are_in_metres_and_degrees(self):
        report = self.report_of("un=cm\nplace circle center radius=50 xy=100,0\n")
        [circle] = report["elements"]
        self.assertAlmostEqual(circle["length"], math.pi, 12)
        self.assertAlmostEqual(circle["area"], math.pi / 4, 12)
        self.assertEqual(circle["volume"], None)
        for found, expected in zip(circle["bbox"]["min"] + circle["bbox"]["max"], [0.5, -0.5, 0, 1.5, 0.5, 0]):
            self.assertAlmostEqual(found, expected, 12)

    def test_figure_6(self):
        shutil.copy(harness.ROOT / "scripts/cruciform_dome.trn", self.folder / "dome.trn")
        report = self.tranos("run", "dome.trn", "--json", "--no-output").report
        [dome] = report["elements"]
        self.assertEqual(dome["type"], "surface")
        self.assertLess(abs(dome["area"] - 1236.08668), 1e-5)
        self.assertEqual(dome["volume"], None)

    def test_consumed_parts_are_absent_and_members_have_parents(self):
        report = self.report_of("place line xy=0,0 xy=1,0 xy=1,1 as side\ncreate chain of=side as outline\n"
                                "group as wing { place point xy=5,5 as tip\ngroup as inner { place point xy=6,6 } }\n")
        elements = {element["id"]: element for element in report["elements"]}
        listed = [(element["type"], element["name"], elements[element["parent"]]["name"] if element["parent"] else None)
                  for element in report["elements"]]
        self.assertEqual(listed, [("chain", "outline", None), ("group", "wing", None), ("point", "tip", "wing"),
                                  ("group", "inner", "wing"), ("point", None, "inner")])
        self.assertEqual(len(elements), len(report["elements"]))

    def test_evidence_and_level(self):
        report = self.report_of('ev=excavation source="trench 4, \\"B\\""; lv="ground floor"\nplace point xy=0,0\n')
        [point] = report["elements"]
        self.assertEqual([point["evidence"], point["source"], point["level"]],
                         ["excavation", 'trench 4, "B"', "ground floor"])

    def test_hash_is_of_the_content(self):
        one = self.report_of("place point xy=1,2 as a\nplace point xy=3,4 as b\n")
        other = self.report_of("# moved about\nplace point xy=3,4 as b;place point xy=0.5*2,2 as a\n")
        self.assertEqual(one["model_hash"], other["model_hash"])
        self.assertNotEqual(one["model_hash"], self.report_of("place point xy=1,2 as a\n")["model_hash"])
        self.assertEqual({e["name"]: e["hash"] for e in one["elements"]},
                         {e["name"]: e["hash"] for e in other["elements"]})

    def test_wrong_script(self):
        report = self.report_of("place point xy=0,0\nassert 1 == 2\nrender\nlet x = nowhere\n", status=1)
        self.assertEqual(list(report), MEMBERS)
        self.assertEqual([report[name] for name in ("status", "model_hash", "elements", "outputs")], [1, None, [], []])
        [found] = report["diagnostics"]
        self.assertEqual([found[key] for key in ("severity", "code", "path", "line", "column", "end_column")],
                         ["error", "E0201", "script.trn", 4, 9, 16])

    def test_wrong_while_running(self):
        report = self.report_of("place point xy=0,0\nassert 1 == 2\nlet x = 1/0\n", status=1)
        self.assertEqual([report["model_hash"], report["elements"], report["outputs"]], [None, [], []])
        self.assertEqual(report["diagnostics"][0]["code"], "E0302")
        self.assertEqual([entry["passed"] for entry in report["asserts"]], [False])

    def test_refused_output(self):
        report = self.report_of('place point xy=0,0\nexport "../a.glb"\n', status=1)
        self.assertEqual([report["model_hash"], report["elements"], report["outputs"]], [None, [], []])
        [found] = report["diagnostics"]
        self.assertEqual([found["code"], found["line"], found["column"]], ["E0703", 2, 8])

    def test_undeclared_parameter(self):
        report = self.report_of("place point xy=0,0\n", "-D", "height=3", status=2)
        self.assertEqual([report["status"], report["elements"], report["outputs"]], [2, [], []])

    def test_script_that_is_not_there(self):
        ran = self.tranos("run", "nowhere.trn", "--json")
        self.assertEqual((ran.status, ran.report["status"], ran.report["elements"]), (3, 3, []))

    def test_warnings(self):
        report = self.report_of("unknown depth = 14m\nplace point xy=depth,0\n")
        [found] = report["diagnostics"]
        self.assertEqual((found["severity"], found["code"]), ("warning", "W0001"))

    def test_strange_names(self):
        name = 'a \\"b\\" \\\\ {{c}} \\n ☃ \U0001d11e éè </script>'
        report = self.report_of(f'lv="{name}"; source="{name}"; mt="{name}"\nplace point xy=0,0\n'
                                f'place text "{name}" xy=0,0 as Ναός\nassert 1 == 2 "{name}"\n', status=4)
        expected = 'a "b" \\ {c} \n ☃ \U0001d11e éè </script>'
        self.assertEqual({element["level"] for element in report["elements"]}, {expected})
        self.assertEqual(report["elements"][1]["name"], "Ναός")
        self.assertEqual(report["asserts"][0]["message"], expected)

    def test_strange_file_names(self):
        for name in (b"a\xff.trn", b'"quoted" \\ \x1b[31m.trn', "ναός.trn".encode()):
            with self.subTest(name=name):
                path = self.folder.as_posix().encode() + b"/" + name
                with open(path, "wb") as file:
                    file.write(b"let x = 1/0\nplace point\n")
                ended = self.tranos("run", name.decode(errors="surrogateescape"), "--json")
                self.assertEqual(ended.status, 1)
                self.assertEqual(len(ended.report["diagnostics"]), 1)
                self.assertNotIn("\x1b", ended.err)

    def test_numbers_are_numbers(self):
        report = self.report_of("place point xy=123456789.12345679,1/3\n", "--no-output")
        self.assertEqual(report["elements"][0]["bbox"]["max"], [123456789.12345679, 1 / 3, 0])

    def test_many_elements(self):
        report = self.report_of("for i = 1 to 20000 { place point xy=i,0 }\n", "--no-output")
        self.assertEqual([element["id"] for element in report["elements"]], list(range(20000)))


class Streams(harness.ProgramTest):
    def test_print(self):
        ran = self.run_script('print "one"\nprint "two {3m}"\n', "--no-output")
        self.assertEqual((ran.out, ran.err), ("one\ntwo 3 m\n", ""))
        ran = self.run_script('print "one"\nprint "two {3m}"\n', "--no-output", "--json")
        self.assertEqual(ran.err, "one\ntwo 3 m\n")
        self.assertEqual(ran.report["status"], 0)

    def test_print_of_control_characters(self):
        ran = self.run_script('print "a\\nb"\n', "--no-output")
        self.assertEqual(ran.out, "a\nb\n")

    def test_diagnostics_go_to_standard_error(self):
        for option in ([], ["--json"]):
            ran = self.run_script("let x = 1/0\n", *option)
            self.assertEqual(ran.codes(), ["E0302"])
            self.assertNotIn("error[", ran.out)

    def test_no_colour_where_there_is_no_terminal(self):
        self.assertNotIn("\x1b", self.run_script("let x = 1/0\nassert 1 == 2\n").err)

    def test_failed_assertion(self):
        ran = self.run_script('place line xy=0,0 xy=3,4 as wall\n'
                              'assert wall.length within 6m +- 10cm "length, from the excavation"\nassert wall.length > 9m\n')
        self.assertEqual(ran.status, 4)
        self.assertEqual(ran.out, "out/script.glb\n")
        self.assertEqual(ran.err, """\
assertion failed: length, from the excavation
 --> script.trn:2:8
  |
2 | assert wall.length within 6m +- 10cm "length, from the excavation"
  |        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ it is 5 m, expected 6 m ± 0.1 m
assertion failed: wall.length > 9m
 --> script.trn:3:8
  |
3 | assert wall.length > 9m
  |        ^^^^^^^^^^^^^^^^ it is 5 m, expected 9 m
""")

    def test_paths_are_seen_from_here(self):
        self.write("inner/deep/a.trn", 'use "b.trn"\n')
        self.write("inner/deep/b.trn", "let x = nowhere\n")
        ran = self.tranos("run", "inner/deep/a.trn")
        self.assertIn("--> inner/deep/b.trn:1:9", ran.err)
        ran = self.tranos("check", f"{self.folder}/inner/deep/a.trn")
        self.assertIn(f"--> {self.folder}/inner/deep/b.trn:1:9", ran.err)


class Table(harness.ProgramTest):
    def test_inspect(self):
        self.write("a.trn", 'lv="a level with quite a long name"; place line xy=0,0 xy=3,4 as edge\n'
                            "group as wing { place circle center radius=1 xy=0,0 as ναός }\nprint \"said\"\n")
        ran = self.tranos("inspect", "a.trn")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertEqual(list(self.files()), ["a.trn"])
        head, edge, wing, circle, last = ran.out.splitlines()
        self.assertEqual(head.split(), ["id", "name", "type", "level", "evidence", "length", "area", "volume"])
        self.assertRegex(edge, r"^ +0  edge +line +a level …  +5\.0000 m *$")
        self.assertRegex(wing, r"wing +group")
        self.assertRegex(circle, r"· ναός +circle +.* 6\.2832 m +3\.1416 m2 *$")
        self.assertEqual(len({len(line) for line in (head, edge, wing, circle)}), 1)
        report = self.tranos("run", "a.trn", "--json", "--no-output").report
        self.assertEqual(last, f"2 elements, model hash {report['model_hash']}")
        self.assertEqual(ran.err, "said\n")

    def test_wrong_script(self):
        self.write("a.trn", "place point xy=0,0\nlet x = 1/0\n")
        ran = self.tranos("inspect", "a.trn")
        self.assertEqual((ran.status, ran.out), (1, ""))
        self.assertTrue(re.search(r"error\[E0302\]", ran.err))


if __name__ == "__main__":
    harness.main()
