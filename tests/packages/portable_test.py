"""Packages of `./dev package --portable`: what they need of a system, and their pictures.   portable_test.py PACKAGES PROGRAM KNOT

PACKAGES: their folder; PROGRAM: halflit, whose pictures are the expected ones; KNOT: a model. Exits with 77, skipped, where there are none.
"""
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile

OLDEST_GLIBC = 25
MOST_BYTES = 17_000_000
OF_SYSTEM = re.compile(r"^(lib(c|m|dl|pthread|rt)\.so|ld-linux)")
LINKED = ("draco", "expat", "fmtlib", "gcc-12-base", "giflib", "imath", "libdeflate", "libjpeg-turbo", "libspng", "libwebp",
          "meshoptimizer", "openexr", "zlib")  # fmt: skip
PACKAGES, PROGRAM, KNOT = sys.argv[1:] if len(sys.argv) == 4 else ("", "", "")
SCENES = (
    ("demo", "--size", "160x90"),
    ("lights:16", "--size", "96x54", "--lobe", "valve"),
    ("/knot.glb", "--size", "120x90", "--env", "studio", "--samples", "4"),
)


def output(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{command}: {done.stderr.decode()}")
    return done.stdout.decode(errors="replace")


def newest_glibc(path):
    return max([0, *(int(minor) for minor in re.findall(r"Name: GLIBC_2\.(\d+)", output("readelf", "-V", path)))])


def needed(path):
    return re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-d", path))


class Packages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name

    def program(self, archive):
        """Unpacks an archive into a folder of its own. Returns the folder of the program."""
        with tarfile.open(archive) as tar:
            tar.extractall(self.folder)
        return os.path.join(self.folder, os.path.basename(archive)[: -len(".tar.gz")])

    def test_a_program_needs_no_file_of_the_system(self):
        for archive in glob.glob(os.path.join(PACKAGES, "halflit-*-linux-*.tar.gz")):
            with self.subTest(archive):
                folder = self.program(archive)
                program = os.path.join(folder, "halflit")
                self.assertEqual(needed(program), [])
                self.assertNotIn("INTERP", output("readelf", "-l", program))
                self.assertLess(os.path.getsize(program), MOST_BYTES)
                brought = {os.path.splitext(name)[0] for name in os.listdir(os.path.join(folder, "licences"))}
                self.assertEqual(set(LINKED) - brought, set())

    def test_a_program_draws_the_same_pixels_alone(self):
        for archive in glob.glob(os.path.join(PACKAGES, "halflit-*-linux-*.tar.gz")):
            folder = self.program(archive)
            shutil.copy(KNOT, os.path.join(folder, "knot.glb"))
            alone = ["chroot", folder] if os.geteuid() == 0 else []
            machine = re.search(r"linux-(\w+)\.tar", archive).group(1)
            if machine != os.uname().machine:  # under qemu, and not in a folder without it
                emulator = shutil.which(f"qemu-{machine}-static") or shutil.which(f"qemu-{machine}")
                if not emulator:
                    continue
                alone = [emulator]
            inside = "/" if alone and alone[0] == "chroot" else folder + "/"
            self.assertEqual(output(*alone, inside + "halflit", "--version"), output(PROGRAM, "--version"))
            for scene in SCENES:
                with self.subTest(archive=archive, scene=scene):
                    command = [*alone, inside + "halflit", "render", scene[0].replace("/", inside), *scene[1:]]
                    output(*command, "-o", inside + "x.png", "--report", inside + "x.json")
                    expected = [PROGRAM, "render", scene[0].replace("/", folder + "/"), *scene[1:]]
                    output(*expected, "-o", os.path.join(folder, "y.png"), "--report", os.path.join(folder, "y.json"))
                    reports = []
                    for name in ("x.json", "y.json"):
                        with open(os.path.join(folder, name), encoding="utf-8") as file:
                            reports.append(json.load(file)["pixel_hash"])
                    self.assertEqual(*reports)

    def test_a_wheel_needs_an_old_glibc_alone(self):
        found = 0
        for wheel in glob.glob(os.path.join(PACKAGES, "*.whl")):
            minor = int(re.search(r"manylinux_2_(\d+)_", wheel).group(1))
            if minor > OLDEST_GLIBC:
                continue  # of ./dev package --python
            found += 1
            with self.subTest(wheel), zipfile.ZipFile(wheel) as archive:
                (library,) = [name for name in archive.namelist() if ".so" in name]
                path = archive.extract(library, self.folder)
                self.assertLessEqual(newest_glibc(path), minor)
                self.assertEqual([name for name in needed(path) if not OF_SYSTEM.match(name)], [])
                shown = output("readelf", "--dyn-syms", "-W", path).splitlines()
                shown = [line.split()[-1] for line in shown if re.search(r"(GLOBAL|WEAK|UNIQUE) +DEFAULT +\d+ ", line)]
                self.assertTrue(shown)
                self.assertEqual([name for name in shown if not name.startswith("halflit_")], [])
                brought = {os.path.splitext(os.path.basename(name))[0] for name in archive.namelist() if "/licenses/" in name}
                self.assertEqual(set(LINKED) - brought, set())
        self.assertGreater(found, 0)


if __name__ == "__main__":
    if not PACKAGES:
        sys.exit(__doc__)
    if not glob.glob(os.path.join(PACKAGES, "halflit-*-linux-*.tar.gz")) or not shutil.which("readelf"):
        print("skipped: ./dev package --portable has made no package, or there is no readelf")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
