"""STEP files: the pictures of the program, and importers that are named."""
import os
import pathlib
import sys
import tempfile
import unittest

import halflit
from support import PROGRAM, program_hash

MACHINE = pathlib.Path(__file__).parents[1] / "cli" / "cad" / "machine.step"


class Importers(unittest.TestCase):
    @unittest.skipUnless(os.path.exists(os.path.join(os.path.dirname(PROGRAM), "halflit-import-cad")), "the importer was not built")
    def test_a_step_file_has_the_pixels_of_the_program(self):
        picture = halflit.render(MACHINE, size=(320, 240))
        self.assertEqual(picture.pixel_hash, program_hash(MACHINE, "--size", "320x240"))
        scene = halflit.Scene.load(MACHINE, detail_px=512)
        self.assertLess(scene.counts["triangles"], halflit.Scene.load(MACHINE).counts["triangles"])
        with self.assertRaisesRegex(halflit.UsageError, "detail_px is not from 1 to 1e6"):
            halflit.Scene.load(MACHINE, detail_px=0)
        # Measures of the surfaces, not of triangles
        self.assertEqual(halflit.measure(MACHINE)["measures"]["size"], [45.0, 40.0, 50.0])

    @unittest.skipIf(sys.platform == "win32", "there are no importers")
    def test_an_importer_can_be_named(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "importer")
            program.write_text("#!/bin/sh\necho the reason >&2\nexit 3\n")
            program.chmod(0o700)
            model = pathlib.Path(folder, "a.thing")
            model.write_text("thing")
            with self.assertRaisesRegex(halflit.BadInputError, "importer: the reason"):
                halflit.Scene.load(model, importers=f".thing={program}")
            with self.assertRaisesRegex(halflit.UsageError, "expected .EXTENSION=PROGRAM"):
                halflit.Scene.load(MACHINE, importers=["thing"])


if __name__ == "__main__":
    unittest.main()
