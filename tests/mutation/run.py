#!/usr/bin/env python3
"""Plants defects in a copy of the tree, one at a time, and says whether a test notices.

    tests/mutation/run.py [--only ROOM ...] [--sample N] [--again]
    tests/mutation/run.py --check       # only whether each defect still has its place in the sources

The list is mutations.txt. The copy and its build lie in build/mutation; results.tsv there keeps what is known, so a
run that was ended goes on. A defect whose file changed since is tried anew. Environment: ECHOCINE_MUTATION_PREFIX
stands before each command (such as `nice`).
"""

import argparse
import hashlib
import os
import re
import shutil
import shlex
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutation"
SOURCE, BUILD, RESULTS = WORK / "source", WORK / "build", WORK / "results.tsv"
PREFIX = shlex.split(os.environ.get("ECHOCINE_MUTATION_PREFIX", ""))
RUN_S = 600  # of the tests of one defect: one that makes them hang is noticed


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

    def key(self, text):
        """Of this defect in this very file."""
        return hashlib.sha256("\0".join([self.file, self.old, self.new, text]).encode()).hexdigest()[:16]


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


def run(command, **options):
    return subprocess.run([*PREFIX, *map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def copy_tree():
    """Files that differ, so that a build has little to do."""
    wanted = set()
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [f for f in folders if not (f in ("build", ".git") and Path(folder) == ROOT)]
        for name in files:
            file = (Path(folder) / name).relative_to(ROOT)
            wanted.add(file)
            there = SOURCE / file
            if there.is_file() and there.read_bytes() == (ROOT / file).read_bytes():
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, there)
            there.touch()
    for there in [p for p in SOURCE.rglob("*") if p.is_file() and p.relative_to(SOURCE) not in wanted]:
        there.unlink()


def prepare(mutations):
    """The copy as the tree is, and its build of the tests that the list names."""
    copy_tree()
    tests = sorted({t for m in mutations for t in m.tests})
    made = run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DECHOCINE_ARCH=x86-64-v3",
                f"-DECHOCINE_TEST_FILES={';'.join(tests)}"])
    made = made if made.returncode else build()
    if made.returncode:
        sys.exit(made.stdout[-4000:])
    seen = test_run(tests)
    if seen:
        sys.exit(f"without a defect a test fails: {seen}")


def build():
    return run(["cmake", "--build", BUILD, "-j", os.environ.get("ECHOCINE_MUTATION_JOBS", "1"), "--target", "echocine_tests"])


def suites(tests):
    names = set()
    for test in tests:
        names |= set(re.findall(r"^TEST(?:_F|_P)?\((\w+),", (ROOT / "tests" / test).read_text(), re.M))
    return sorted(names)


def test_run(tests):
    """The first test that fails, or what else ended the run; empty where all pass."""
    names = [pattern for s in suites(tests) for pattern in (f"{s}.*", f"*/{s}.*")]
    try:
        ran = run([BUILD / "echocine_tests", "--gtest_fail_fast", f"--gtest_filter={':'.join(names)}"], timeout=RUN_S, cwd=BUILD)
    except subprocess.TimeoutExpired:
        return "no end"
    if ran.returncode == 0:
        return ""
    failed = re.search(r"^\[  FAILED  \] (\S+)", ran.stdout, re.M)
    return failed.group(1).rstrip(",") if failed else f"code {ran.returncode}"


def verdict_of(mutation, everything):
    """Killed by its own tests, else by any of the list; survived; or not compiled."""
    file = SOURCE / mutation.file
    text = file.read_text()
    file.write_text(text.replace(mutation.old, mutation.new))
    try:
        if build().returncode:
            return "not compiled"
        seen = test_run(mutation.tests) or test_run(everything)
        return f"killed by {seen}" if seen else "SURVIVED"
    finally:
        file.write_text(text)


def known():
    if not RESULTS.is_file():
        return {}
    return dict(line.split("\t", 1) for line in RESULTS.read_text().splitlines())


def print_table(rows):
    print("\n| file | planted | instead of | result |\n|---|---|---|---|")
    for mutation, verdict in rows:
        cells = [mutation.file, f"`{mutation.new}`", f"`{mutation.old}`", verdict]
        print("| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |")
    killed = sum(v.startswith("killed") for _, v in rows)
    print(f"\n{killed} of {len(rows)} killed")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", nargs="+", metavar="ROOM", help="only defects in these rooms, such as trace")
    parser.add_argument("--sample", type=int, metavar="N", help="only N of them, evenly over the list")
    parser.add_argument("--again", action="store_true", help="forget what is known")
    parser.add_argument("--check", action="store_true", help="plant nothing: say which have no place in the sources")
    asked = parser.parse_args()
    mutations = [m for m in read_list() if not asked.only or m.room in asked.only]
    stale = [(m, fault) for m in mutations if (fault := fault_of(m))]
    for mutation, fault in stale:
        print(f"{mutation.file}: {mutation.old}: {fault}")
    if asked.check:
        print(f"{len(mutations) - len(stale)} of {len(mutations)} defects have their place")
        return 1 if stale else 0
    mutations = [m for m in mutations if not fault_of(m)]
    if asked.sample:
        mutations = mutations[::max(1, len(mutations) // asked.sample)][:asked.sample]
    if asked.again:
        RESULTS.unlink(missing_ok=True)
    results, rows = known(), []
    keys = [m.key((ROOT / m.file).read_text()) for m in mutations]
    if any(key not in results for key in keys):
        prepare(mutations)
    everything = sorted({t for m in mutations for t in m.tests})
    for mutation, key in zip(mutations, keys):
        if key not in results:
            start = time.monotonic()
            results[key] = verdict_of(mutation, everything)
            with RESULTS.open("a") as file:
                file.write(f"{key}\t{results[key]}\n")
            print(f"{mutation.file}: {results[key]} ({time.monotonic() - start:.0f} s)", flush=True)
        rows.append((mutation, results[key]))
    print_table(rows)
    return 0 if all(v.startswith("killed") for _, v in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
