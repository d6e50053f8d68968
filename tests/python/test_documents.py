"""What is public has help with shapes and units; stubs and types say what is true."""

import inspect
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import echocine

SOURCE = Path(__file__).resolve().parents[2]
UNITS = ("float32", "float64", "uint8", "uint32")


def public():
    for name in echocine.__all__:
        value = getattr(echocine, name)
        if name == "__version__":
            continue
        yield name, value
        if inspect.isclass(value) and not issubclass(value, Warning):
            for member, held in vars(value).items():
                if not member.startswith("_") and (callable(held) or isinstance(held, property)):
                    yield f"{name}.{member}", held


@pytest.mark.parametrize("name, value", list(public()), ids=lambda v: v if isinstance(v, str) else "")
def test_every_public_name_has_help(name, value):
    assert value.__doc__ and value.__doc__.strip(), name
    arrays = ("intensities", "greys", "images", "labels", "displacement", "velocity", "tracks", "strain", "times_s", "image")
    if name.rpartition(".")[2] in arrays:
        assert "(" in value.__doc__ and any(u in value.__doc__ for u in UNITS), name


def run_mypy(*arguments):
    pytest.importorskip("mypy", reason="needs python3-mypy (.ci/test-packages.txt)")
    package = str(Path(echocine.__file__).parent.parent)
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, timeout=280,
                          env={**os.environ, "MYPYPATH": package, "MYPY_CACHE_DIR": os.devnull})


def test_types_are_strict():
    examples = sorted(str(p) for p in (SOURCE / "examples" / "python").glob("*.py"))
    optional = ["scipy", "torch", "matplotlib"]
    assert examples
    checked = run_mypy("mypy", "--strict", "-p", "echocine", "--cache-dir", os.devnull)
    assert checked.returncode == 0, checked.stdout
    for example in examples:
        assert not any(f"import {m}" in Path(example).read_text() and "type: ignore" not in Path(example).read_text()
                       for m in optional), example
    checked = run_mypy("mypy", "--strict", "--scripts-are-modules", "--cache-dir", os.devnull, *examples)
    assert checked.returncode == 0, checked.stdout


def test_stubs_are_those_of_the_module():
    from echocine import _echocine
    pytest.importorskip("mypy", reason="needs python3-mypy (.ci/test-packages.txt)")
    from mypy import nodes
    from mypy.build import build
    from mypy.modulefinder import BuildSource
    from mypy.options import Options
    stub = Path(echocine.__file__).parent / "_echocine.pyi"
    options = Options()
    options.cache_dir = os.devnull
    tree = build([BuildSource(str(stub), "_stub", None)], options=options).files["_stub"]
    described = {n: s.node for n, s in tree.names.items()
                 if not s.module_hidden and isinstance(s.node, (nodes.TypeInfo, nodes.FuncDef)) and
                 s.node.fullname.startswith("_stub.")}
    module = {n: v for n, v in vars(_echocine).items() if not n.startswith("_")}
    assert set(described) == set(module)
    for name, node in described.items():
        if not isinstance(node, nodes.TypeInfo):
            assert [a.variable.name for a in node.arguments] == arguments_of(module[name]), name
            continue
        members = {m for m in node.names if not m.startswith("_")}
        assert members == {m for m in vars(module[name]) if not m.startswith("_")}, name


def arguments_of(function):
    """Of the signature that stands in the first line of the help."""
    signature = function.__doc__.split("\n")[0]
    inner = signature[signature.index("(") + 1:signature.rindex(") ->")]
    names, depth = [], 0
    word = ""
    for c in inner + ",":
        depth += c in "[("
        depth -= c in "])"
        if c == "," and depth == 0:
            names += [word.split(":")[0].strip()] if word.strip() else []
            word = ""
        else:
            word += c
    return names


def test_the_readmes_first_loop_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (SOURCE / "src" / "python" / "README.md").read_text()
    code = text.split("```python\n")[1].split("```")[0]
    assert len(code.strip().split("\n")) <= 10
    names = {}
    exec(compile(code, "README.md", "exec"), names)
    assert isinstance(names["loop"].images, np.ndarray)
