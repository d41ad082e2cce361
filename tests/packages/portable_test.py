"""Packages of `./dev package --portable`: what they need of a system, and their pictures.   portable_test.py PACKAGES PROGRAM KNOT

PACKAGES: their folder; PROGRAM: halflit, whose pictures are the expected ones; KNOT: a model. Exits with 77, skipped, where there are none.
"""
import glob
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile

APPS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "apps")
GALLERY, INCLUDE = os.path.join(APPS, "examples", "gallery"), os.path.join(APPS, "c", "include")
sys.path.insert(0, GALLERY)
import picture_hash  # noqa: E402

OLDEST_GLIBC = 25
MOST_BYTES = 17_000_000
OF_SYSTEM = re.compile(r"^lib(c|m|dl|pthread|rt)\.so")
LINKED = ("draco", "expat", "fmtlib", "gcc-12-base", "giflib", "imath", "libdeflate", "libjpeg-turbo", "libspng", "libwebp", "libzstd",
          "meshoptimizer", "openexr", "zlib")  # fmt: skip
PACKAGES, PROGRAM, KNOT = sys.argv[1:] if len(sys.argv) == 4 else ("", "", "")
SCENES = (
    ("demo", "--size", "160x90"),
    ("lights:16", "--size", "96x54", "--lobe", "valve"),
    ("/knot.glb", "--size", "120x90", "--env", "studio", "--samples", "4"),
)
# A program that loads its cases as ctypes loads a library, and two cases: what a missing file tells, and a function of the caller that
# needs more of a thread's stack than musl gives.
HOST = """
#include <dlfcn.h>
#include <stdio.h>
int main(int count, char** arguments) {
    void* const library = count == 2 ? dlopen(arguments[1], RTLD_NOW) : NULL;
    int (*const run)(void) = library ? (int (*)(void))dlsym(library, "run") : NULL;
    return run ? run() : printf("%s", dlerror());
}
"""
MISSING = """
#include <halflit/halflit.h>
#include <stdio.h>
int run(void) {
    halflit_scene* scene;
    return halflit_scene_load("x.stl", NULL, &scene) == 0 || printf("%s", halflit_last_error()) < 0;
}
"""
DEEP = """
#include <halflit/halflit.h>
#include <stdio.h>
static unsigned char pixels[256 * 256 * 4];
static int32_t deep(void* user) {
    volatile char stack[1 << 20];
    for (int i = 0; i < 1 << 20; i += 4096) stack[i] = 1;
    (void)user;
    return stack[4096] - 1;
}
int run(void) {
    halflit_scene* scene;
    halflit_renderer* renderer;
    halflit_camera camera = {.size = sizeof camera};
    halflit_settings settings = {.size = sizeof settings};
    halflit_execution execution;
    halflit_target target;
    halflit_execution_init(&execution, sizeof execution), halflit_target_init(&target, sizeof target);
    execution.threads = 4, execution.cancelled = deep;
    target.width = 256, target.height = 256, target.pixels = pixels;
    return halflit_scene_create_demo(&scene) || halflit_renderer_create(&execution, &renderer) ||
           halflit_choose_picture(scene, NULL, NULL, &camera, &settings, NULL) ||
           halflit_render(renderer, scene, NULL, &camera, &settings, &target, NULL) || printf("drawn") < 0;
}
"""


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

    def written(self, name, text):
        """Writes a file. Returns its path."""
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

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
            minor = int(re.search(r"manylinux_2_(\d+)_|$", wheel).group(1) or 99)
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

    def test_a_wheel_draws_the_same_pixels_by_musl(self):
        wheels = glob.glob(os.path.join(PACKAGES, f"*manylinux_2_{OLDEST_GLIBC}_{os.uname().machine}*.whl"))
        for wheel in wheels:
            self.assertIn("musllinux_1_2", wheel)
        if not wheels or not shutil.which("musl-gcc"):
            self.skipTest("no wheel of this processor, or no musl-gcc")
        with zipfile.ZipFile(wheels[0]) as archive:
            (library,) = [archive.extract(name, self.folder) for name in archive.namelist() if ".so" in name]
        host = self.written("host.c", HOST)
        output("musl-gcc", host, "-o", host + ".run")
        self.assertIn("ld-musl", output("readelf", "-l", host + ".run"))

        def told(source):
            output("musl-gcc", "-shared", "-fPIC", "-Dmain=run", "-I", INCLUDE, source, library, "-Wl,-rpath," + os.path.dirname(library),
                   "-o", source + ".so")  # fmt: skip
            return output(host + ".run", source + ".so", cwd=self.folder)

        shutil.copy(os.path.join(GALLERY, "spiral.c"), self.folder)
        self.assertEqual(told(os.path.join(self.folder, "spiral.c")), "")
        with open(os.path.join(GALLERY, "table.txt"), encoding="utf-8") as table:
            (expected,) = [row.split()[2] for row in table if row.startswith("spiral.c ")]
        self.assertEqual(picture_hash.of_file(pathlib.Path(self.folder, "spiral.png")), expected)
        self.assertEqual(told(self.written("missing.c", MISSING)), "x.stl: cannot be opened: No such file or directory")
        self.assertEqual(told(self.written("deep.c", DEEP)), "drawn")


if __name__ == "__main__":
    if not PACKAGES:
        sys.exit(__doc__)
    if not glob.glob(os.path.join(PACKAGES, "halflit-*-linux-*.tar.gz")) or not shutil.which("readelf"):
        print("skipped: ./dev package --portable has made no package, or there is no readelf")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
