#!/usr/bin/env python3
"""Plants defects in a copy of the tree, one at a time, and says whether a test notices.

    tests/mutation/run.py [--only ROOM ...] [--sample N] [--again]
    tests/mutation/run.py --check       # only whether each defect still has its place in the sources

The list is mutations.txt. The copy and its build lie in build/mutation; results.tsv there keeps the results, so a
run that was ended goes on. A defect whose file or tests changed since is tried again. A whole run rewrites TABLE.md.
The build compiles each listed file alone, so one defect costs one file and a link. A defect in a header would cost
the whole tree: its tests are compiled alone instead, and need no library. Environment: ECHOCINE_MUTATION_PREFIX
stands before each command (such as `nice`), ECHOCINE_MUTATION_CMAKE adds options of CMake.
"""

import argparse
import datetime
import os
import re
import shutil
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

from planted import ROOT, fault_of, read_list

WORK = ROOT / "build" / "mutation"
SOURCE, RESULTS = WORK / "source", WORK / "results.tsv"
BUILD = SOURCE / "build" / "mutation"  # as deep as other builds, so that a compiler cache knows the tests
TABLE = ROOT / "tests" / "mutation" / "TABLE.md"
PREFIX = shlex.split(os.environ.get("ECHOCINE_MUTATION_PREFIX", ""))
SURVIVED = "SURVIVED"
RUN_S = 600  # of the tests of one defect: one that makes them hang is noticed


def run(command, timeout=None, **options):
    """A command and what it prints; after the timeout it ends with all its children."""
    with subprocess.Popen([*PREFIX, *map(str, command)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", start_new_session=True, **options) as child:
        try:
            out, _ = child.communicate(timeout=timeout)
        except BaseException:
            os.killpg(child.pid, signal.SIGKILL)
            raise
    return subprocess.CompletedProcess(command, child.returncode, out)


def copy_tree():
    """Files that differ, so that a build has little to do."""
    wanted = set()
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [f for f in folders if f not in ("build", ".git") or Path(folder) != ROOT]
        for name in files:
            file = (Path(folder) / name).relative_to(ROOT)
            wanted.add(file)
            there = SOURCE / file
            if there.is_file() and there.read_bytes() == (ROOT / file).read_bytes():
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, there)
            there.touch()
    for folder, folders, files in os.walk(SOURCE):
        folders[:] = [f for f in folders if Path(folder) != SOURCE or f != "build"]
        for name in files:
            if (Path(folder) / name).relative_to(SOURCE) not in wanted:
                (Path(folder) / name).unlink()


def write_alone(mutations):
    """What CMake reads before the project's own file: the listed sources outside unity builds, and a fast build."""
    lines = ["function(build_for_mutations)"]
    for file in sorted({m.file for m in mutations if not m.in_header}):
        folder = Path(file).parent
        while not (ROOT / folder / "CMakeLists.txt").is_file():
            folder = folder.parent
        lines.append(f"  set_source_files_properties({SOURCE / file} DIRECTORY {SOURCE / folder} "
                     "PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)")
    lines += ["  get_property(rooms GLOBAL PROPERTY ECHOCINE_ROOMS)",
              "  foreach(room IN LISTS rooms)",
              "    target_compile_options(echocine_${room} PRIVATE -O1 -w)",
              "  endforeach()", "endfunction()", "cmake_language(DEFER CALL build_for_mutations)"]
    (WORK / "alone.cmake").write_text("\n".join(lines) + "\n")


def configure():
    return run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                "-DCMAKE_UNITY_BUILD_BATCH_SIZE=24", f"-DCMAKE_PROJECT_echocine_INCLUDE={WORK / 'alone.cmake'}",
                *(["-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld"] if shutil.which("ld.lld") else []),
                *shlex.split(os.environ.get("ECHOCINE_MUTATION_CMAKE", ""))])


def prepare(mutations):
    """The copy as the tree is, and its build."""
    copy_tree()
    write_alone(mutations)
    made = configure()
    made = made if made.returncode else build()
    if made.returncode:
        sys.exit(made.stdout[-4000:])


def check_killers(mutations, verdicts):
    """Without a defect the tests that noticed one pass: else they prove nothing."""
    made = build()
    if made.returncode:
        sys.exit(made.stdout[-4000:])
    names = {v.removeprefix("killed by ") for v in verdicts if v.startswith("killed by ")}
    patterns = sorted(n for n in names if "." in n)
    seen = run_filter(patterns) if patterns else ""
    unnamed = [t for m, v in zip(mutations, verdicts) if v.startswith("killed by ") and "." not in v for t in m.tests]
    seen = seen or (test_run(unnamed) if unnamed else "")
    if seen:
        RESULTS.unlink(missing_ok=True)
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
    return run_filter([pattern for s in suites(tests) for pattern in (f"{s}.*", f"*/{s}.*")])


def run_filter(patterns, program="echocine_tests"):
    try:
        ran = run([BUILD / program, "--gtest_fail_fast", f"--gtest_filter={':'.join(patterns)}"], timeout=RUN_S, cwd=BUILD)
    except subprocess.TimeoutExpired:
        return "no end"
    if ran.returncode == 0:
        return ""
    failed = re.search(r"^\[  FAILED  \] (\S+)", ran.stdout, re.M)
    return failed.group(1).rstrip(",") if failed else f"code {ran.returncode}"


def try_alone(mutation):
    """The first failure of a header's tests, compiled without the project's libraries; None where they do not compile."""
    made = run(["c++", "-std=c++20", "-O1", "-I", SOURCE / "src", "-I", SOURCE, *[SOURCE / "tests" / t for t in mutation.tests],
                "-lgtest", "-lgtest_main", "-lfmt", "-o", BUILD / "alone"])
    return None if made.returncode else run_filter(["*"], "alone")


def header_verdict(mutation):
    file = SOURCE / mutation.file
    text = file.read_text()
    without = try_alone(mutation)
    if without != "":
        sys.exit(f"{mutation.file}: without a defect its tests do not pass alone: {without}")
    file.write_text(text.replace(mutation.old, mutation.new))
    try:
        seen = try_alone(mutation)
        return "not compiled" if seen is None else f"killed by {seen}" if seen else SURVIVED
    finally:
        file.write_text(text)


def verdict_of(mutation, tests):
    """Killed by one of the tests, survived, or not compiled."""
    file = SOURCE / mutation.file
    text = file.read_text()
    file.write_text(text.replace(mutation.old, mutation.new))
    try:
        if build().returncode:
            return "not compiled"
        seen = test_run(tests)
        return f"killed by {seen}" if seen else SURVIVED
    finally:
        file.write_text(text)


def known():
    if not RESULTS.is_file():
        return {}
    return dict(line.split("\t", 1) for line in RESULTS.read_text().splitlines())


def table_of(rows):
    out = ["| file | planted | instead of | result |", "|---|---|---|---|"]
    for mutation, verdict in rows:
        cells = [mutation.file, f"`{mutation.new}`", f"`{mutation.old}`", verdict]
        out.append("| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |")
    killed = sum(v.startswith("killed") for _, v in rows)
    return "\n".join([*out, "", f"{killed} of {len(rows)} killed"])


def write_table(rows):
    version = re.search(r"project\(echocine VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    head = f"# Planted defects and their killers\n\nVersion {version}, {datetime.date.today()}, by `tests/mutation/run.py`.\n\n"
    TABLE.write_text(head + table_of(rows) + "\n")


def note(mutation, key, verdict, start):
    with RESULTS.open("a") as file:
        file.write(f"{key}\t{verdict}\n")
    print(f"{mutation.file}: {verdict} ({time.monotonic() - start:.0f} s)", flush=True)


def try_headers(mutations, keys, results):
    for mutation in [m for m in mutations if keys[id(m)] not in results]:
        start, key = time.monotonic(), keys[id(mutation)]
        results[key] = header_verdict(mutation)
        note(mutation, key, results[key], start)


def try_all(mutations, keys, results):
    """Adds to `results` what is not yet known of the mutations: first by their own tests, then by all of the list."""
    missing = [m for m in mutations if keys[id(m)] not in results]
    everything = sorted({t for m in mutations for t in m.tests})
    verdicts = {}
    for last in (False, True):
        for mutation in missing:
            key = keys[id(mutation)]
            if verdicts.get(key, SURVIVED) != SURVIVED:
                continue
            start = time.monotonic()
            verdicts[key] = verdict_of(mutation, everything if last else mutation.tests)
            if last or verdicts[key] != SURVIVED:
                note(mutation, key, verdicts[key], start)
            else:
                print(f"{mutation.file}: not noticed by its own tests", flush=True)
        check_killers(missing, [verdicts[keys[id(m)]] for m in missing])
    results.update(verdicts)


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
    results = known()
    keys = {id(m): m.key() for m in mutations}
    if any(key not in results for key in keys.values()):
        prepare(mutations)
        try_headers([m for m in mutations if m.in_header], keys, results)
        try_all([m for m in mutations if not m.in_header], keys, results)
    rows = [(m, results[keys[id(m)]]) for m in mutations]
    print(table_of(rows))
    if not asked.only and not asked.sample and not stale:
        write_table(rows)
    return 0 if all(v.startswith("killed") for _, v in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
