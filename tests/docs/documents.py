#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the examples of the documents and the scripts, and follows links.

Usage: documents.py TRANOS ROOT [--short]. Scripts of more than a page are not run with --short. Prints a line for each breach; the status is 1 if there is one.
"""

import json
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

DOCUMENTS = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "*/README.md", "tests/*/README.md"]
GENERATED = "reference.md"  # its examples are run by the command table's own test
MAX_PICTURE_BYTES = 200_000
SHORT_SCRIPT_LINES = 60
MAX_SCRIPT_LINES = 400  # a whole church; an example is read at a glance and far shorter
VERBATIM = "cruciform_dome.trn"
ROOT = Path(__file__).parent.parent.parent
PHOTOGRAPHS = [ROOT / "tests/language/photograph" / name for name in ("facade.png", "facade.camera.json", "house.png")]
PHOTOGRAPHS.append(ROOT / "docs/images/tranos_photograph.png")
SECONDS = 60

FENCE = re.compile(r"^```(.*)$")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
EXPECT = re.compile(r"#\s*expect(?:\s+(error|warning|failed)\b\s*([EW]\d{4})?)?\s*(?::\s*(.*))?$")
RUN = re.compile(r"#\s*run:\s*(.*)$")
HYPOTHESIS = re.compile(r"^hypothesis (\w+)", re.MULTILINE)


@dataclass
class Block:
    path: Path
    line: int  # of its first line of text
    marks: list
    text: str
    says: str = None  # what the program must say of it, to the letter

    def place(self, line=1):
        return f"{self.path}:{self.line + line - 1}"


@dataclass
class Expected:
    prints: list = field(default_factory=list)
    diagnostics: list = field(default_factory=list)  # (line, code, part of the text)
    failed: list = field(default_factory=list)  # lines
    arguments: list = field(default_factory=list)
    mistakes: list = field(default_factory=list)


def blocks_of(path, text):
    """The fenced blocks of a document whose first mark is trn; `text says` blocks belong to the one before."""
    found, inside = [], None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence and inside is None:
            inside = Block(path, number + 1, fence.group(1).split(), "")
        elif fence:
            if inside.marks[:1] == ["trn"]:
                found.append(inside)
            elif inside.marks == ["text", "says"] and found:
                found[-1].says = inside.text
            inside = None
        elif inside is not None:
            inside.text += line + "\n"
    return found


def spoken_of(lines, at):
    """The number of the line that a comment in line `at` (from 0) speaks of."""
    if not lines[at].lstrip().startswith("#"):
        return at + 1
    for later in range(at + 1, len(lines)):
        if lines[later].strip() and not lines[later].lstrip().startswith("#"):
            return later + 1
    return at + 1


def expected_of(block):
    """What the comments of a block announce."""
    expected, lines = Expected(), block.text.splitlines()
    if "later" in block.marks:
        return expected
    for at, line in enumerate(lines):
        if run := RUN.search(line):
            expected.arguments += shlex.split(run.group(1))
        elif expect := EXPECT.search(line):
            kind, code, text = expect.groups()
            if kind == "failed":
                expected.failed.append(spoken_of(lines, at))
            elif kind and code:
                expected.diagnostics.append((spoken_of(lines, at), code, (text or "").strip()))
            elif not kind and text is not None:
                expected.prints.append(text.strip())
            else:
                expected.mistakes.append(f"{block.place(at + 1)}: what is expected here?")
    return expected


def run(tranos, script, arguments):
    """What the script printed, what was said of it, and its report."""

    def call(*options):
        command = [tranos, "run", script.name, "--no-output", *options, *arguments]
        return subprocess.run(command, cwd=script.parent, capture_output=True, text=True, timeout=SECONDS, check=False)

    plain, report = call(), call("--json")
    told = json.loads(report.stdout) if report.stdout else {"status": report.returncode}
    return plain.stdout.splitlines(), plain.stderr, told


def matches(given, line, code, part):
    text = " ".join([given["message"], given["label"], given["help"]])
    return given["code"] == code and given["line"] == line and part in text


def differences(block, expected, printed, report):
    """What happened and was not announced, and the other way round."""
    if "diagnostics" not in report:
        return [f"{block.place()}: no report, status {report['status']}"]
    found = list(expected.mistakes)
    if printed != expected.prints:
        found.append(f"{block.place()}: printed {printed}, expected {expected.prints}")
    given = list(report["diagnostics"])
    for line, code, part in expected.diagnostics:
        hit = next((one for one in given if matches(one, line, code, part)), None)
        if hit is None:
            found.append(f"{block.place(line)}: expected {code} {part}".rstrip())
        else:
            given.remove(hit)
    found += [f"{block.place(one['line'])}: {one['code']} {one['message']}" for one in given]
    failed = [one["span"]["line"] for one in report["asserts"] if not one["passed"]]
    found += [f"{block.place(line)}: this assertion fails" for line in failed if line not in expected.failed]
    found += [f"{block.place(line)}: no assertion fails here" for line in expected.failed if line not in failed]
    return found


def later_differences(block, report):
    """A block of what is not there yet must say so, and nothing else."""
    codes = {one["code"] for one in report.get("diagnostics", [])}
    return [] if codes == {"E0001"} else [f"{block.place()}: expected E0001 alone, got {sorted(codes)}"]


def check_block(tranos, block, beside):
    expected = expected_of(block)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in beside.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        for photograph in PHOTOGRAPHS:
            if photograph.name in block.text:
                shutil.copy(photograph, folder)
        script = Path(folder, "example.trn")
        script.write_text(block.text, encoding="utf-8")
        printed, said, report = run(tranos, script, expected.arguments)
    if "later" in block.marks:
        return later_differences(block, report)
    found = differences(block, expected, printed, report)
    if block.says is not None and block.says != said:
        found.append(f"{block.place()}: the program says\n{said}")
    return found


def check_examples(tranos, path, text):
    blocks = blocks_of(path, text)
    beside = {}
    for block in blocks:
        for mark in block.marks:
            if mark.startswith("file="):
                beside[mark[5:]] = block.text
    with ThreadPoolExecutor() as pool:
        for found in pool.map(lambda block: check_block(tranos, block, beside), blocks):
            yield from found


def slug(heading):
    """The anchor of a heading."""
    plain = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return plain.replace(" ", "-")


def prose_of(text):
    """The lines outside fenced blocks."""
    outside = True
    for line in text.splitlines():
        if FENCE.match(line):
            outside = not outside
        elif outside:
            yield line


def anchors_of(path):
    lines = prose_of(path.read_text(encoding="utf-8"))
    return {slug(line.lstrip("#")) for line in lines if line.startswith("#")}


def check_links(path, text):
    for target in LINK.findall("\n".join(prose_of(text))):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (path.parent / name) if name else path
        if not file.exists():
            yield f"{path}: no file for {target}"
        elif file.suffix == ".png" and file.stat().st_size > MAX_PICTURE_BYTES:
            yield f"{path}: {target} is larger than {MAX_PICTURE_BYTES} bytes"
        elif anchor and anchor not in anchors_of(file):
            yield f"{path}: no heading for {target}"


def check_readme(root):
    """The README's script is the one in scripts/."""
    script = (root / "scripts/round_temple.trn").read_text(encoding="utf-8")
    if script not in [block.text for block in blocks_of("README.md", (root / "README.md").read_text(encoding="utf-8"))]:
        yield "README.md: its script is not scripts/round_temple.trn"


def check_script(tranos, script):
    """A script is in the one layout, says what it announces, and checks itself; each of its hypotheses holds, too. The paper's stays as it was printed."""
    text = script.read_text(encoding="utf-8")
    block = Block(script, 1, [], text)
    expected = expected_of(block)
    printed, _, report = run(tranos, script, expected.arguments)
    yield from differences(block, expected, printed, report)
    for other in HYPOTHESIS.findall(text):
        _, _, told = run(tranos, script, ["--hypothesis", other])
        if told["status"] != 0:
            yield f"{script}: does not hold with the hypothesis {other}, status {told['status']}"
    if script.name == VERBATIM:
        return
    if not report.get("asserts"):
        yield f"{script}: asserts nothing"
    if subprocess.run([tranos, "fmt", "--check", script], capture_output=True, check=False).returncode != 0:
        yield f"{script}: is not in the layout of tranos fmt"
    if len(text.splitlines()) > MAX_SCRIPT_LINES:
        yield f"{script}: is longer than {MAX_SCRIPT_LINES} lines"


def check_scripts(tranos, folder, short):
    """Each script holds, and stands in the folder's README with its picture."""
    listed = (folder / "README.md").read_text(encoding="utf-8")
    for script in sorted(folder.glob("*.trn")):
        if not short or len(script.read_text(encoding="utf-8").splitlines()) <= SHORT_SCRIPT_LINES:
            yield from check_script(tranos, script)
        if f"({script.name})" not in listed:
            yield f"{folder}/README.md: {script.name} is not listed"
        if not (folder.parent / "docs/images" / f"{script.stem}.png").exists():
            yield f"docs/images: no picture of {script.name}"


def check(tranos, root, short=False):
    documents = sorted({path for pattern in DOCUMENTS for path in root.glob(pattern)})
    if not documents:
        yield f"{root}: no documents"
    for path in documents:
        text = path.read_text(encoding="utf-8")
        yield from check_links(path, text)
        if path.name != GENERATED:
            yield from check_examples(tranos, path, text)
    yield from check_readme(root)
    yield from check_scripts(tranos, root / "scripts", short)


def main(tranos, root, *options):
    found = list(check(str(Path(tranos).resolve()), Path(root), "--short" in options))
    print("\n".join(found) if found else "the documents hold")
    return 1 if found else 0


if __name__ == "__main__":
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
