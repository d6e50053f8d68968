"""The list of planted defects, mutations.txt."""

import hashlib
import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Mutation:
    file: str
    old: str
    new: str
    tests: list  # test sources, which the filter of suites is made of

    @property
    def room(self):
        parts = Path(self.file).parts
        return parts[1] if parts[0] == "src" else parts[0]

    @property
    def in_header(self):
        return self.file.endswith(".h")

    def key(self):
        """Of this defect in this file with these tests."""
        texts = [(ROOT / f).read_text() for f in [self.file, *[f"tests/{t}" for t in self.tests]]]
        return hashlib.sha256("\0".join([self.file, self.old, self.new, *texts]).encode()).hexdigest()[:16]


def read_list():
    """Blocks between empty lines: FILE, `- old`, `+ new`, `= tests`; old and new are parts of one line."""
    mutations = []
    text = (ROOT / "tests" / "mutation" / "mutations.txt").read_text()
    for block in re.split(r"\n\s*\n", text):
        lines = [line for line in block.split("\n") if line and not line.startswith("#")]
        if not lines:
            continue
        if len(lines) != 4 or [line[:2] for line in lines[1:]] != ["- ", "+ ", "= "]:
            sys.exit(f"mutations.txt: a block is not FILE, - OLD, + NEW, = TESTS: {block!r}")
        mutations.append(Mutation(lines[0], lines[1][2:], lines[2][2:], lines[3][2:].split()))
    return mutations


def fault_of(mutation):
    """Why a defect cannot be planted; empty where it can."""
    file = ROOT / mutation.file
    if not file.is_file():
        return "no such file"
    count = file.read_text().count(mutation.old)
    if count != 1:
        return f"{count} places, accepted: one"
    missing = [t for t in mutation.tests if not (ROOT / "tests" / t).is_file()]
    return f"no test {missing[0]}" if missing else ""
