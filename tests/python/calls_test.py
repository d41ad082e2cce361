"""Calls by name give what the program's commands give."""
import os
import tempfile
import unittest

from support import CORNERS, FACES, program_json, stl

import halflit

SIZE = "200x160"


def without_times(report):
    """The report without what differs between two runs."""
    if isinstance(report, dict):
        return {name: without_times(value) for name, value in report.items() if not name.endswith("ms")}
    return [without_times(value) for value in report] if isinstance(report, list) else report


class CallsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.box = os.path.join(cls.folder.name, "box.stl")
        cls.bar = os.path.join(cls.folder.name, "bar.stl")
        for path, corners in ((cls.box, CORNERS), (cls.bar, CORNERS * [2, 1, 1])):
            with open(path, "wb") as file:
                file.write(stl(corners))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def same(self, answer, *command):
        self.assertEqual(without_times(program_json(*command)), without_times(answer.report))

    def test_look_and_section(self):
        answer = halflit.look(self.box, size=SIZE, view=["front", "iso"])
        self.same(answer, "look", self.box, "--size", SIZE, "--view", "front,iso", "--json", "-")
        self.assertTrue(answer.good)
        self.assertEqual((4, True), (answer.picture.shape[2], answer.picture.shape[0] > 160))
        cut = halflit.section(self.box, "x=50%", size=SIZE)
        self.same(cut, "look", self.box, "--section", "x=50%", "--size", SIZE, "--json", "-")
        self.assertAlmostEqual(4, cut["sections"][0]["area"], places=5)  # half of a cube of side 2: 2 x 2

    def test_certify(self):
        self.same(halflit.certify(self.box), "look", self.box, "--certify", "1", "--json", "-")

    def test_info_and_measure(self):
        self.same(halflit.info(self.box), "info", self.box, "--json")
        measured = halflit.measure(self.bar)
        self.assertAlmostEqual(16, measured["measures"]["volume"], places=5)
        self.assertEqual(program_json("info", self.bar, "--json")["measures"], measured["measures"])

    def test_explain(self):
        answer = halflit.explain(self.box, [(100, 80), (0, 0)], size=SIZE)
        self.same(answer, "explain", self.box, "--pixel", "100,80", "--pixel", "0,0", "--size", SIZE, "--json")

    def test_compare(self):
        import json
        import subprocess

        from support import PROGRAM

        answer = halflit.compare(self.box, self.bar, size=SIZE)
        self.assertFalse(answer.good)
        done = subprocess.run([PROGRAM, "compare", self.box, self.bar, "--size", SIZE, "--json", "-"], stdout=subprocess.PIPE, check=False)
        self.assertEqual(1, done.returncode)
        self.assertEqual(without_times(json.loads(done.stdout)), without_times(answer.report))
        self.assertTrue(halflit.compare(self.box, self.box, size=SIZE).good)

    def test_render(self):
        answer = halflit.call("render", self.box, size=SIZE, edges="feature")
        self.assertEqual(halflit.render(self.box, (200, 160), edges="feature").pixel_hash, answer["pixel_hash"])
        self.assertEqual(answer["pixel_hash"], answer.picture.pixel_hash)

    def test_scenes_arrays_and_files_are_one(self):
        with halflit.Scene.load(self.box) as scene:
            self.assertEqual(halflit.measure(self.box)["measures"], halflit.measure(scene)["measures"])
        arrays = halflit.measure((CORNERS, FACES))
        self.assertAlmostEqual(8, arrays["measures"]["volume"], places=5)
        with halflit.Scene() as scene:
            scene.add_mesh(CORNERS, FACES)
            looked = halflit.look(scene, size=SIZE)
            scene.add_mesh(CORNERS + [4, 0, 0], FACES)
            self.assertEqual(1 + len(looked["parts"]), len(halflit.look(scene, size=SIZE)["parts"]))  # a call changes nothing

    def test_refusals(self):
        for wrong, words in (
            (lambda: halflit.call("lok", self.box), "did you mean look"),
            (lambda: halflit.look(self.box, sise=3), "did you mean size"),
            (lambda: halflit.look(self.box, size="x"), "size: expected"),
            (lambda: halflit.explain(self.box, (9999, 0), size=SIZE), "9999"),
            (lambda: halflit.look((CORNERS, FACES), path="x.stl"), "either a scene or the path"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, words):
                wrong()
        with self.assertRaises(halflit.FileError):
            halflit.measure("there_is_none.stl")


if __name__ == "__main__":
    unittest.main()
