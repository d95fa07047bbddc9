"""Builds the package with CMake, in the build folder that setuptools gives.

RUNSTONE_BUILD names a folder to use instead, which is kept. If CMake has configured it already, with
RUNSTONE_PYTHON=ON, its settings stay as they are.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def version():
    """Returns the version, whose one place is project() of the main CMakeLists.txt."""
    return re.search(r"project\(runstone VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        folder = Path(os.environ.get("RUNSTONE_BUILD") or Path(self.build_temp).resolve() / "cmake")
        if not (folder / "build.ninja").exists():
            subprocess.run(
                ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                 "-DCMAKE_UNITY_BUILD_BATCH_SIZE=20", "-DRUNSTONE_PYTHON=ON", "-DRUNSTONE_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "runstone_python"], check=True)
        built = list((folder / "python/runstone").glob("_runstone.*.so"))
        if len(built) != 1:
            sys.exit(f"setup.py: {folder}/python/runstone must hold one module, but holds {built}")
        if built[0].name != target.name:
            sys.exit(f"setup.py: {folder} builds {built[0].name}, which is for another Python than {sys.executable}, which "
                     f"needs {target.name}. Give RUNSTONE_BUILD another folder")
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built[0]), str(target))


setup(version=version(), packages=["runstone"], package_data={"runstone": ["py.typed", "*.pyi"]},
      ext_modules=[Extension("runstone._runstone", [])], cmdclass={"build_ext": CMakeBuild}, zip_safe=False)
