"""halflit.render() has the pixels of the program, by their hashes."""
import glob
import os
import tempfile
import unittest

import halflit
import support
from support import CAMERA, LAMPS, TURN, box, program_hash


class OfCode(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "box.glb")

    def tearDown(self):
        self.folder.cleanup()

    def check(self, model, *flags, **keywords):
        """The model in a file and as bytes, with these keywords, and by the program with these flags."""
        with open(self.path, "wb") as file:
            file.write(model)
        expected = program_hash(self.path, *flags)
        picture = halflit.render(self.path, **keywords)
        self.assertEqual(picture.pixel_hash, expected, keywords)
        self.assertEqual(halflit.render(model, **keywords).pixel_hash, expected, keywords)
        self.assertGreater(len({tuple(p) for p in picture.reshape(-1, 4).tolist()}), 3)
        return picture

    def test_demo(self):
        self.assertEqual(halflit.render("demo").pixel_hash, program_hash("demo"))
        self.assertEqual(halflit.render("demo", (320, 200)).pixel_hash, program_hash("demo", "--size", "320x200"))

    def test_defaults(self):
        self.assertEqual(self.check(box()).shape, (720, 1280, 4))
        self.check(box(), "--size", "64", size=64)
        self.check(box(), "--size", "300x200", size=(300, 200))

    def test_camera_of_the_file(self):
        nodes = {"nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.2, 0.3, 5]}], **CAMERA}
        self.assertEqual(self.check(box(more=nodes)).shape, (720, 1080, 4))
        self.check(box(more=nodes), "--camera", "front", "--size", "99", camera="front", size=99)
        self.check(box(more=nodes), "--camera", "0", "--size", "99", camera=0, size=99)
        self.check(box(more=nodes), "--camera", "frame", "--size", "99", camera="frame", size=99)
        self.check(box(more=nodes), "--azimuth", "80", "--elevation", "-10", "--zoom", "1.5", "--fov", "50", azimuth=80, elevation=-10,
                   zoom=1.5, fov=50)  # fmt: skip

    def test_animation(self):
        model = box(more=TURN)
        at_0 = self.check(model, "--size", "90", size=90)
        at_1 = self.check(model, "--size", "90", "--time", "0.7", size=90, time=0.7)
        self.check(model, "--size", "90", "--animation", "none", size=90, animation="none")
        self.check(model, "--size", "90", "--animation", "turn", "--time", "2", size=90, animation="turn", time=2)
        self.assertNotEqual(at_0.pixel_hash, at_1.pixel_hash)
        # A scene that is posed, and one that is loaded so.
        scene = halflit.Scene.load(model, keep_animations=True)
        self.assertEqual(scene.animations, [{"name": "turn", "end_s": 2.0, "channels": 1}])
        self.assertEqual(scene.render(90).pixel_hash, at_0.pixel_hash)
        scene.pose(time=0.7)
        self.assertEqual(scene.render(90).pixel_hash, at_1.pixel_hash)

    def test_lamps_of_the_file(self):
        lamp = {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [3, 4, 2]}
        more = {"nodes": [{"mesh": 0}, lamp], **LAMPS}
        self.check(box(more=more), "--size", "120", size=120)
        self.check(box(more=more), "--size", "120", "--no-scene-lights", size=120, scene_lights=False)
        self.check(box(more=more), "--size", "120", "--exposure", "1", size=120, exposure=2)

    def test_far_and_tiny(self):
        # The program moves what is far from the origin to it, and lights it there; so does render().
        far = box(translation=[1e6, 0, 3e6])
        self.check(far, "--size", "100", size=100)
        light = {"type": "point", "position": (1e6 + 2, 2, 3e6 + 2), "color": (4, 4, 4)}
        self.check(far, "--size", "100", "--light", "point:pos=1000002,2,3000002:intensity=4", size=100, lights=[light])
        tiny = box(scale=[1e-5, 1e-5, 1e-5])
        self.check(tiny, "--size", "100", size=100)
        near = {"type": "point", "position": (2e-5, 2e-5, 2e-5), "color": (5e-10, 5e-10, 5e-10)}
        self.check(tiny, "--size", "100", "--light", "point:pos=2e-5,2e-5,2e-5:intensity=5e-10", size=100, lights=[near])

    def test_light_and_settings(self):
        model = box()
        self.check(model, "--size", "99", "--env", "sky", "--env-rotate", "30", size=99, environment="sky", environment_rotate=30)
        self.check(model, "--size", "99", "--env", "none", size=99, environment="none")
        self.check(model, "--size", "99", "--env", "studio", "--env-rotate", "45", size=99, environment="studio", environment_rotate=45)
        seen = {"environment": "sky", "background": "environment"}
        self.check(model, "--size", "99", "--env", "sky", "--background", "environment", size=99, **seen)
        self.check(model, "--size", "99", "--ambient", "0.2,0.3,0.4", size=99, ambient=(0.2, 0.3, 0.4))
        self.check(model, "--size", "99", "--ground", "--sky-shadows", "16", size=99, ground=True, sky_shadows=16)
        self.check(model, "--size", "99", "--light", "directional:dir=-1,-2,-1", size=99, lights=[halflit.Light(direction=(-1, -2, -1))])
        self.check(model, "--size", "99", "--lobe", "sloan", "--wrap", "0.6", size=99, lobe=("sloan", 0.6))
        self.check(model, "--size", "99", "--max-error", "0.5", size=99, max_error=0.5)
        self.check(model, "--size", "99", "--tonemap", "aces", "--samples", "8", size=99, tone_curve="aces", samples=8)
        self.check(model, "--size", "99", "--specular", "ggx", "--shading", "gouraud", size=99, specular="ggx", shading_rate="gouraud")
        self.check(model, "--size", "99", "--shadows", "hard", "--background", "#8899aa", size=99, shadows="hard", background="#8899aa")
        self.check(model, "--size", "99", "--background", "transparent", size=99, background="transparent")
        self.check(model, "--size", "99", "--accuracy", "reference", size=99, accuracy="reference")
        self.check(model, "--size", "99", "--region", "5,20,60,70", size=99, region=(5, 20, 60, 70))

    def test_ways_to_compute(self):
        expected = program_hash("demo", "--size", "160x90")
        for keywords in ({"isa": "scalar"}, {"threads": 1}, {"tile_size": 16}, {"threads": 3, "progress": lambda share: None}):
            self.assertEqual(halflit.render("demo", (160, 90), **keywords).pixel_hash, expected, keywords)


@unittest.skipUnless(support.ASSETS, "HALFLIT_ASSETS names no folder of models")
class OfAssets(unittest.TestCase):
    def test_models(self):
        names = "Duck FlightHelmet BoxAnimated RiggedSimple CesiumMilkTruck AnimatedMorphCube Cameras ShadowsDirectional".split()
        checked = 0
        for name in names:
            files = sorted(glob.glob(os.path.join(support.ASSETS, "models", name, "**", "*.gl*"), recursive=True))
            for file in files[:1]:
                self.assertEqual(halflit.render(file).pixel_hash, program_hash(file), file)
                flags = ("--size", "512", "--time", "0.4")
                self.assertEqual(halflit.render(file, (512, 512), time=0.4).pixel_hash, program_hash(file, *flags), file)
                checked += 1
        self.assertGreater(checked, 2)


if __name__ == "__main__":
    unittest.main()
