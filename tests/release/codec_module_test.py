"""A program whose OpenEXR and Draco lie in a module finds it beside itself and where an installation has it, and says so where it does not.
"""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["HALFLIT_PROGRAM"])
MODULE = PROGRAM.parent / "halflit_codecs.so"


def drawn(program, folder, name):
    words = [program, "sphere:100", "-o", name, "--size", "16"]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True)


class CodecModule(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def test_beside_the_program_and_through_a_link(self):
        bin_folder = self.folder / "bin"
        bin_folder.mkdir()
        for file in (PROGRAM, MODULE):
            shutil.copy(file, bin_folder)
        self.assertEqual(drawn(bin_folder / "halflit", self.folder, "a.exr").returncode, 0)
        os.symlink(bin_folder / "halflit", self.folder / "halflit")
        self.assertEqual(drawn(self.folder / "halflit", self.folder, "b.exr").returncode, 0)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_alone(self):
        shutil.copy(PROGRAM, self.folder)
        self.assertEqual(drawn(self.folder / "halflit", self.folder, "a.png").returncode, 0)
        lost = drawn(self.folder / "halflit", self.folder, "a.exr")
        self.assertEqual(lost.returncode, 4)
        self.assertRegex(lost.stderr, r"^halflit: error: .*need halflit_codecs\.so: [^\n]+\n$")

    def test_of_another_build(self):
        shutil.copy(PROGRAM, self.folder)
        bytes_of_module = MODULE.read_bytes()
        version = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout.split()[1].encode()
        at = bytes_of_module.rindex(version + b" ")
        (self.folder / MODULE.name).write_bytes(bytes_of_module[:at] + b"9" + bytes_of_module[at + 1 :])
        lost = drawn(self.folder / "halflit", self.folder, "a.exr")
        self.assertEqual(lost.returncode, 4)
        self.assertIn("another build", lost.stderr)


unittest.main()
