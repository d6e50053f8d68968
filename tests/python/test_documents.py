"""What is public has help with shapes and units; stubs and types say what is true."""

import ast
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


def test_types_are_strict():
    """Of the examples, and of the whole package, which they import."""
    pytest.importorskip("mypy", reason="needs python3-mypy (.ci/test-packages.txt)")
    examples = sorted(str(p) for p in (SOURCE / "examples" / "python").glob("*.py"))
    assert examples
    package = Path(echocine.__file__).parent
    modules = sorted(str(p) for p in package.glob("*.py"))
    checked = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--scripts-are-modules", "--cache-dir", os.devnull, *examples,
                              *modules], capture_output=True, text=True, timeout=280,
                             env={**os.environ, "MYPYPATH": str(package.parent), "PYTHONPATH": ""}, cwd="/")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_stubs_are_those_of_the_module():
    from echocine import _echocine
    stub = ast.parse((Path(echocine.__file__).parent / "_echocine.pyi").read_text())
    described = {n.name: n for n in stub.body if isinstance(n, (ast.ClassDef, ast.FunctionDef))}
    module = {n: v for n, v in vars(_echocine).items() if not n.startswith("_")}
    assert set(described) == set(module)
    for name, node in described.items():
        if isinstance(node, ast.FunctionDef):
            assert [a.arg for a in node.args.args] == arguments_of(module[name]), name
            continue
        members = {m.name: m for m in node.body if isinstance(m, ast.FunctionDef) and not m.name.startswith("_")}
        held = {m: v for m, v in vars(module[name]).items() if not m.startswith("_")}
        assert set(members) == set(held), name
        for member, function in members.items():
            if not isinstance(held[member], property):
                assert [a.arg for a in function.args.args] == arguments_of(held[member]), f"{name}.{member}"


def arguments_of(function):
    """Of the signature that stands in the first line of the help."""
    signature = function.__doc__.split("\n")[0]
    inner = signature[signature.index("(") + 1:signature.rindex(") ->")]
    names, word, depth = [], "", 0
    for c in inner + ",":
        depth += (c in "[(") - (c in "])")
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
