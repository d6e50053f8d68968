"""pip install ./src/python: the module by the project's own CMake, in a build folder of its own."""

import os
import re
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


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        target = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = Path(self.build_temp).resolve() / "cmake"
        subprocess.run(["cmake", "-S", project(), "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DECHOCINE_TESTS=OFF",
                        "-DECHOCINE_PYTHON_MODULE=ON", f"-DPython3_EXECUTABLE={sys.executable}",
                        *os.environ.get("CMAKE_ARGS", "").split()], check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", "--target", "echocine_python"], check=True)
        target.mkdir(parents=True, exist_ok=True)
        for module in (build / "python" / "echocine").glob("_echocine*.so"):
            self.copy_file(str(module), str(target / module.name))


setup(version=version(), packages=["echocine"], package_data={"echocine": ["*.pyi", "py.typed"]},
      ext_modules=[Extension("echocine._echocine", [])], cmdclass={"build_ext": CMakeBuild})
