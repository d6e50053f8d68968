"""pip install ./src/python, of a module that is built already."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import echocine

SOURCE = Path(__file__).resolve().parents[2]
TRY = """
import echocine, os, sys
assert os.path.dirname(echocine.__file__).startswith(sys.argv[1]), echocine.__file__
print(echocine.__version__, echocine.render(echocine.heart(keyframes=4, look="paper"), frames=(0, 1)).images.shape[0])
"""


@pytest.fixture
def clone(tmp_path):
    """What of a clone an installation reads, so that it leaves nothing behind in this one."""
    shutil.copytree(SOURCE / "src" / "python", tmp_path / "clone" / "src" / "python")
    shutil.copy(SOURCE / "CMakeLists.txt", tmp_path / "clone")
    return tmp_path / "clone"


pytestmark = pytest.mark.skipif(any(importlib.util.find_spec(name) is None for name in ("pip", "setuptools", "wheel")),
                                reason="needs python3-pip, python3-setuptools and python3-wheel (.ci/test-packages.txt)")


def pip(clone, target, built):
    return subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index", "--quiet",
                           "--target", target, clone / "src" / "python"], capture_output=True, text=True, cwd="/",
                          env={**os.environ, "ECHOCINE_BUILT": str(built), "PYTHONPATH": ""})


def test_pip_installs_the_whole_package(clone, tmp_path):
    target, package = tmp_path / "site", Path(echocine.__file__).parent
    installed = pip(clone, target, package.parents[1])
    assert installed.returncode == 0, installed.stdout + installed.stderr
    assert {p.name for p in package.iterdir()} - {"__pycache__"} == {p.name for p in (target / "echocine").iterdir()} - {"__pycache__"}
    assert sorted(p.name for p in (clone / "src" / "python").iterdir()) == sorted(p.name for p in (SOURCE / "src" / "python").iterdir())
    ran = subprocess.run([sys.executable, "-c", TRY, str(target)], capture_output=True, text=True, cwd="/",
                         env={**os.environ, "PYTHONPATH": str(target)})
    assert ran.returncode == 0 and ran.stdout.split() == [echocine.__version__, "1"], ran.stdout + ran.stderr


def test_a_build_without_the_module_is_named(clone, tmp_path):
    refused = pip(clone, tmp_path / "site", tmp_path)
    assert refused.returncode != 0 and "has no Python module, accepted" in refused.stderr + refused.stdout
