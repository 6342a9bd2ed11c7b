"""Builds the package's modules of C++ with CMake; all else is in pyproject.toml."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.resolve()


def version():
    """CMakeLists.txt is the only place that states it."""
    return re.search(r"project\(rollfix\s+VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    """Both modules in one build in build/python, which the next one goes on from."""

    def run(self):
        build = ROOT / "build" / "python"
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "CMAKE_UNITY_BUILD": "ON",
            "ROLLFIX_TOGETHER": "4",  # a compiler takes less than 700 MB
            "ROLLFIX_COMPILED_ALONE": "pair_filter",
            "Python_EXECUTABLE": sys.executable,
            "ROLLFIX_BUILD_PYTHON": "ON",
            "ROLLFIX_BUILD_CATALOG": "ON",
            "ROLLFIX_FMT_HEADER_ONLY": "ON",
            **{f"ROLLFIX_BUILD_{name}": "OFF" for name in ("APPS", "TESTS", "BENCH", "EXAMPLES")},
            "ROLLFIX_INSTALL": "OFF",
        }
        defines = [f"-D{name}={value}" for name, value in options.items()]
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", *defines], check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", str(build), "--target", "rollfix_python", "--parallel", jobs], check=True)
        for extension in self.extensions:
            target = pathlib.Path(self.get_ext_fullpath(extension.name))
            target.parent.mkdir(parents=True, exist_ok=True)
            self.copy_file(str(build / "python" / "rollfix" / target.name), str(target))


setup(
    version=version(),
    ext_modules=[Extension("rollfix._core", []), Extension("rollfix._draw", [])],
    cmdclass={"build_ext": CMakeBuild},
)
