"""pip install ./src/python: the module by the project's own CMake, in a build folder of its own."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent


def project():
    """The clone; pip must not copy this folder away from it."""
    root = HERE.parents[1]
    if not (root / "CMakeLists.txt").exists():
        raise SystemExit("echocine: build it from a clone: pip install ./src/python")
    return root


def version():
    found = re.search(r"project\(echocine VERSION ([0-9.]+)", (project() / "CMakeLists.txt").read_text())
    return found[1]


# Nothing is left in the sources, and a second installation compiles only what has changed.
BUILD = project() / "build" / "pip"
BUILD.mkdir(parents=True, exist_ok=True)


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        target = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        built = os.environ.get("ECHOCINE_BUILT")  # a build tree that has the module already
        cmake = Path(built).resolve() if built else BUILD / "cmake"
        if not built:
            self.compile(cmake)
        modules = list((cmake / "python" / "echocine").glob("_echocine*.so"))
        if not modules:
            raise SystemExit(f"echocine: {cmake}: has no Python module, accepted: a build tree with ECHOCINE_PYTHON_MODULE=ON")
        target.mkdir(parents=True, exist_ok=True)
        for module in modules:
            self.copy_file(str(module), str(target / module.name))

    def compile(self, cmake):
        # As the preset "release" has it, for the module alone.
        subprocess.run(["cmake", "-S", project(), "-B", cmake, *(["-G", "Ninja"] if shutil.which("ninja") else []),
                        "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=24",
                        "-DECHOCINE_TESTS=OFF", "-DECHOCINE_PYTHON_MODULE=ON", f"-DPython3_EXECUTABLE={sys.executable}",
                        *os.environ.get("CMAKE_ARGS", "").split()], check=True)
        subprocess.run(["cmake", "--build", cmake, "--parallel", "--target", "echocine_python"], check=True)


setup(version=version(), packages=["echocine"], package_data={"echocine": ["*.pyi", "py.typed"]},
      ext_modules=[Extension("echocine._echocine", [])], cmdclass={"build_ext": CMakeBuild},
      options={"build": {"build_base": str(BUILD)}, "egg_info": {"egg_base": str(BUILD)}})
