"""A wheel is made, installed into a new environment, and draws there with the system's numpy and the libraries that it brought."""
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile

import support

LIBRARY = os.environ.get("HALFLIT_LIBRARY")
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "apps", "python", "build_wheel.py")

PROGRAM = """
import sys, halflit
picture = halflit.render("demo", (160, 90))
assert halflit.__file__.startswith(sys.argv[1]), halflit.__file__
print(picture.pixel_hash)
with open("/proc/self/maps") as maps:
    print(*sorted({line.split()[-1] for line in maps if ".so" in line}), sep="\\n")
"""


def has_venv():
    return all(importlib.util.find_spec(name) for name in ("venv", "ensurepip"))


@unittest.skipUnless(LIBRARY and shutil.which("patchelf") and shutil.which("readelf") and has_venv(), "no patchelf, binutils or venv")
class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.environment = {name: value for name, value in os.environ.items() if not name.startswith(("HALFLIT_", "PYTHON", "LD_"))}
        cls.name = cls.run_in(sys.executable, TOOL, LIBRARY, cls.folder.name).strip()
        cls.path = os.path.join(cls.folder.name, cls.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_in(cls, *command):
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        done = subprocess.run(command, cwd=cls.folder.name, env=cls.environment, check=False, **pipes)
        if done.returncode:
            raise AssertionError(f"{command}: {done.stdout.decode()}{done.stderr.decode()}")
        return done.stdout.decode()

    def test_it_draws_in_a_new_environment(self):
        place = os.path.join(self.folder.name, "venv")
        self.run_in(sys.executable, "-m", "venv", "--system-site-packages", place)  # numpy is the system's
        python = os.path.join(place, "bin", "python")
        self.run_in(python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", self.path)
        found, *maps = self.run_in(python, "-c", PROGRAM, os.path.realpath(place)).split()
        self.assertEqual(found, support.program_hash("demo", "--size", "160x90"))
        with zipfile.ZipFile(self.path) as archive:
            brought = {os.path.basename(name) for name in archive.namelist() if ".so" in name}
        loaded = {os.path.basename(path) for path in maps if path.startswith(os.path.realpath(place))}
        self.assertEqual(loaded, brought)  # each library that it brings is used, and no other copy in its place
        checked = subprocess.run([python, "-m", "pip", "check"], stdout=subprocess.PIPE, env=self.environment, check=False)
        self.assertNotIn(b"halflit", checked.stdout)  # packages of the system may lack others

    def test_its_contents(self):
        with zipfile.ZipFile(self.path) as archive:
            names = archive.namelist()
            self.assertIsNone(archive.testzip())
            info = next(name for name in names if name.endswith("/METADATA")).rpartition("/")[0]
            self.assertIn("Requires-Dist: numpy", archive.read(info + "/METADATA").decode())
            self.assertEqual(archive.read(info + "/RECORD").decode().count("\n"), len(names))
        self.assertIn("halflit/py.typed", names)
        self.assertIn("halflit/compat/pyrender/__init__.py", names)
        self.assertIn(info + "/licenses/LICENSE", names)
        self.assertRegex(self.name, r"^halflit-[0-9.]+-py3-none-(manylinux_2_\d+|linux)_\w+\.whl$")

    def test_it_needs_the_glibc_that_its_name_says(self):
        wanted = re.search(r"manylinux_2_(\d+)", self.name)
        if not wanted:
            self.skipTest("no manylinux tag")
        with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(self.path) as archive:
            libraries = [archive.extract(name, folder) for name in archive.namelist() if ".so" in name]
            for path in libraries:
                versions = [int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", self.run_in("readelf", "-V", path))]
                self.assertLessEqual(max([0, *versions]), int(wanted.group(1)), path)
                self.assertIn("[$ORIGIN]", self.run_in("readelf", "-d", path), path)
            shown = self.run_in("nm", "-D", "--defined-only", libraries[0] if "halflit_python" in libraries[0] else
                                next(path for path in libraries if "halflit_python" in path))  # fmt: skip
        self.assertEqual([line for line in shown.splitlines() if " halflit_" not in line], [])

    def test_the_same_library_makes_the_same_wheel(self):
        other = os.path.join(self.folder.name, "again")
        self.run_in(sys.executable, TOOL, LIBRARY, other)
        with open(self.path, "rb") as first, open(os.path.join(other, self.name), "rb") as second:
            self.assertTrue(first.read() == second.read())

    @unittest.skipUnless(shutil.which("git") and os.path.exists(os.path.join(ROOT, ".git")), "no git")
    def test_a_source_distribution_has_all_that_is_compiled_and_names_the_backend(self):
        command = "import sys, build_wheel; print(build_wheel.build_sdist(sys.argv[1]))"
        made = subprocess.run([sys.executable, "-c", command, self.folder.name], cwd=os.path.dirname(TOOL), stdout=subprocess.PIPE,
                              check=True)  # fmt: skip
        name = made.stdout.decode().strip()
        with tarfile.open(os.path.join(self.folder.name, name)) as archive:
            names = set(archive.getnames())
            stem = name[: -len(".tar.gz")]
            self.assertIn(b'backend-path = ["apps/python"]', archive.extractfile(stem + "/pyproject.toml").read())
        of_git = ["git", "-C", ROOT, "ls-files", "sh", "shading", "raster", "apps", "cmake"]
        listed = subprocess.run(of_git, stdout=subprocess.PIPE, check=True)
        self.assertEqual({f"{stem}/{file}" for file in listed.stdout.decode().splitlines()} - names, set())
        self.assertIn(stem + "/PKG-INFO", names)

    @unittest.skipUnless(importlib.util.find_spec("build") and importlib.util.find_spec("build.__main__"), "no build")
    def test_by_the_usual_frontend(self):
        other = os.path.join(self.folder.name, "frontend")
        setting = f"--config-setting=library={LIBRARY}"
        self.run_in(sys.executable, "-m", "build", "--wheel", "--no-isolation", setting, "--outdir", other, os.path.dirname(TOOL))
        self.assertEqual(os.listdir(other), [self.name])


if __name__ == "__main__":
    unittest.main()
