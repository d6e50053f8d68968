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


# As torch declares them; its package has types of its own.
TORCH = {
    "__init__.pyi": """
from typing import Any
class Tensor:
    @property
    def shape(self) -> Any: ...
def from_numpy(ndarray: Any) -> Tensor: ...
""",
    "utils/__init__.pyi": "",
    "utils/data/__init__.pyi": """
from typing import Any, Generic, Iterator, Optional, TypeVar
T_co = TypeVar("T_co", covariant=True)
class Dataset(Generic[T_co]):
    def __getitem__(self, index: Any) -> T_co: ...
class DataLoader(Generic[T_co]):
    def __init__(self, dataset: Dataset[T_co], batch_size: Optional[int] = 1, *, num_workers: int = 0) -> None: ...
    def __iter__(self) -> Iterator[Any]: ...
""",
}


def strict(files, *more, path=()):
    package = Path(echocine.__file__).parent
    checked = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--scripts-are-modules", "--cache-dir", os.devnull, *more,
                              *sorted(map(str, files))], capture_output=True, text=True, timeout=280,
                             env={**os.environ, "MYPYPATH": os.pathsep.join(map(str, [*path, package.parent])), "PYTHONPATH": ""},
                             cwd="/")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_types_are_strict():
    """Of the examples, and of the whole package, which they import."""
    pytest.importorskip("mypy", reason="needs python3-mypy (.ci/test-packages.txt)")
    examples = [p for p in (SOURCE / "examples" / "python").glob("*.py") if p.name != "torch_dataset.py"]
    assert examples
    strict([*examples, *Path(echocine.__file__).parent.glob("*.py")])


@pytest.mark.parametrize("declared", [False, True], ids=["as_installed", "declared"])
def test_types_of_the_torch_example_are_strict(declared, tmp_path):
    """With torch and without: what it lacks then is a type that nobody knows."""
    pytest.importorskip("mypy", reason="needs python3-mypy (.ci/test-packages.txt)")
    for name, text in TORCH.items() if declared else ():
        (tmp_path / "torch" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "torch" / name).write_text(text)
    strict([SOURCE / "examples" / "python" / "torch_dataset.py"], "--ignore-missing-imports", "--allow-subclassing-any",
           path=[tmp_path])


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
