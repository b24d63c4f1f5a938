"""Builds the Python package by CMake: pip install --no-build-isolation . or python3 -m build --wheel --no-isolation.

The compiled modules come from a build tree of their own, or from the one that ORCHARD_BUILD names, which has to be for
the same version of Python.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
VERSION_HEADER = ROOT / "runtime/include/orchard/runtime/version.h"
MODULES = ("_runtime", "_construction")


def version():
    numbers = re.findall(r"define ORCHARD_VERSION_(?:MAJOR|MINOR|PATCH) +(\d+)", VERSION_HEADER.read_text(encoding="utf-8"))
    return ".".join(numbers)


class BuildByCMake(build_ext):
    """Both modules, and the libraries that they link, in one build."""

    def run(self):
        tree = pathlib.Path(os.environ.get("ORCHARD_BUILD") or pathlib.Path(self.build_temp).resolve() / "orchard")
        new = [] if (tree / "CMakeCache.txt").exists() else [
            "-DCMAKE_BUILD_TYPE=Release", f"-DORCHARD_PYTHON_EXECUTABLE={sys.executable}", "-DORCHARD_UNITY=ON",
            "-DORCHARD_VIZ=OFF", "-DORCHARD_TESTS=OFF"]
        subprocess.run(["cmake", "-S", ROOT, "-B", tree, "-DORCHARD_PYTHON=ON", *new], check=True)
        subprocess.run(["cmake", "--build", tree, "--parallel", str(os.cpu_count() or 1), "--target", "orchard_python"],
                       check=True)
        for extension in self.extensions:
            target = pathlib.Path(self.get_ext_fullpath(extension.name))
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(tree / "python/orchard_geometry" / target.name, target)


setup(
    version=version(),
    package_dir={"": "python"},
    packages=["orchard_geometry"],
    package_data={"orchard_geometry": ["py.typed", "*.pyi"]},
    ext_modules=[Extension(f"orchard_geometry.{name}", []) for name in MODULES],
    cmdclass={"build_ext": BuildByCMake},
    zip_safe=False,
)
