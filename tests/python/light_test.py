"""Light, lobes, environments and budgets."""
import os
import pickle
import tempfile
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, box

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
WHITE = {"metallic": 0.0, "dielectric_reflectance": 0.0}
FRONT = {"dtype": np.float32, "studio": "never", "exposure": 1.0, "background": "transparent", "shadows": "off", "samples": 1}


def square(**light):
    """Light in the middle of a white square that faces +z, as floats."""
    scene = halflit.Scene()
    scene.add_mesh(*SQUARE, material=WHITE)
    if light:
        scene.add_light(**light)
    return scene


def middle(scene, **keywords):
    camera = halflit.Camera.look_at((0, 0, 3), (0, 0, 0))
    return scene.render(9, camera=camera, **{**FRONT, **keywords})[4, 4, :3]


class Lights(unittest.TestCase):
    def test_closed_forms(self):
        # A directional light of colour 1 makes a white surface that faces it exactly white: less what it mirrors, here nothing.
        self.assertTrue(np.allclose(middle(square(direction=(0, 0, -1))), 1, atol=2e-6))
        self.assertTrue(np.allclose(middle(square(direction=(0, -1, -1), color=(1, 0.5, 0))), [0.5**0.5, 0.5**1.5, 0], atol=2e-6))
        self.assertTrue(np.allclose(middle(square(light="point", position=(0, 0, 2))), 0.25, atol=1e-4))  # 1 / distance^2
        spot = {"light": "spot", "position": (0, 0, 2), "inner_cone_rad": 0.1, "outer_cone_rad": 0.2}
        self.assertTrue(np.allclose(middle(square(direction=(0, 0, -1), **spot)), 0.25, atol=1e-4))
        self.assertTrue(np.allclose(middle(square(direction=(0, -1, -1), **spot)), 0))

    def test_lobes(self):
        # From behind at 100 degrees: half-Lambert sees (1 + cos) / 2, Lambert nothing.
        angle = np.radians(100)
        behind = square(direction=(0, -np.sin(angle), -np.cos(angle)))
        self.assertTrue(np.allclose(middle(behind), 0))
        self.assertTrue(np.allclose(middle(behind, lobe="half-lambert"), (1 + np.cos(angle)) / 2, atol=2e-6))
        for wrap, power in ((1, 2), (0.5, 1.5)):
            expected = (max(0, np.cos(angle) + wrap) / (1 + wrap)) ** power
            self.assertTrue(np.allclose(middle(behind, lobe=halflit.Lobe(wrap, power)), expected, atol=2e-5))
        self.assertEqual(halflit.Lobe.named("sloan", 0.5).wrap, 0.5)
        with self.assertRaisesRegex(halflit.UsageError, "lobe"):
            halflit.Lobe.named("oren")

    def test_environment_of_one_colour(self):
        # Light of radiance 1 from everywhere makes white white; ambient light likewise.
        scene = square()
        scene.set_environment(np.full((8, 16, 3), 0.5, np.float32), calibrated=True)
        self.assertTrue(np.allclose(middle(scene), 0.5, atol=2e-3))
        scene.clear_lights()
        scene.set_ambient((0.25, 0.5, 0.75))
        self.assertTrue(np.allclose(middle(scene), (0.25, 0.5, 0.75), atol=1e-5))
        behind = square(direction=(0, 0, 1))  # a scene without any light would get some
        self.assertTrue(np.allclose(middle(behind, ambient=(0.25, 0.5, 0.75)), (0.25, 0.5, 0.75), atol=1e-5))
        with self.assertRaisesRegex(halflit.UsageError, "environment: expected an array"):
            scene.set_environment(np.zeros((4, 8)))

    def test_environment_of_a_file_is_that_of_the_array(self):
        image = np.random.default_rng(5).random((16, 32, 4), np.float32)
        image[:, :, 3] = 1
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sky.pfm")
            image.view(halflit.Picture).save(path)
            of_file = halflit.render(box(), 64, environment=path)
            of_array = halflit.render(box(), 64, environment=image[:, :, :3])
        self.assertEqual(of_file.pixel_hash, of_array.pixel_hash)
        self.assertNotEqual(of_file.pixel_hash, halflit.render(box(), 64, environment="sky").pixel_hash)

    def test_lights_are_read_and_replaced(self):
        scene = square(light="spot", position=(0, 0, 2), direction=(0, 0, -1))
        light = scene.light(0)
        self.assertEqual((light.type, light.position), ("spot", (0, 0, 2)))
        light.type, light.color = "point", (2, 2, 2)
        scene.set_light(0, light)
        self.assertEqual(scene.light(0), light)
        self.assertTrue(np.allclose(middle(scene), 0.5, atol=2e-4))
        self.assertEqual(repr(halflit.Light("point", range=3)), "Light(type='point', range=3.0)")
        with self.assertRaisesRegex(halflit.UsageError, "type: expected one of directional, point, spot"):
            halflit.Light("neon")

    def test_a_light_of_the_caller_leaves_a_share_of_the_studio(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        scene.add_light(direction=(1, 0, 0))  # from the left: the sides that are seen are dark
        dark = scene.render(64, studio="never")
        shared = scene.render(64)
        self.assertGreater(shared[:, :, :3].mean(), dark[:, :, :3].mean() + 1)


class Idle(unittest.TestCase):
    def refused(self, name, call):
        with self.assertRaisesRegex(halflit.UsageError, f"^{name}: "):
            call()

    def test_keywords_without_effect_change_nothing(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for whole, options in (
            ({"orthographic": True}, {"fov": 30}),
            ({"orthographic": True, "view": "iso"}, {"fov": 30}),
            ({}, {"edge_color": "red"}),
            ({}, {"hidden_edges": "dashed"}),
            ({"edges": "none"}, {"edge_width": 2}),
            ({"shadows": "off"}, {"shadow_size": 512}),
            ({"shadows": "off"}, {"shadow_fade": 2.0}),
        ):
            self.assertEqual(scene.render(16, **whole).pixel_hash, scene.render(16, **whole, **options).pixel_hash)
        found = scene.measure(64, "draft", shadows="off")
        scene.render(64, shadows="off", **found["settings"])

    def test_members_that_a_light_does_not_have_are_refused(self):
        scene = halflit.Scene()
        for name, type, members in (
            ("position", "directional", {"position": (1, 2, 3)}),
            ("range", "directional", {"range": 3}),
            ("direction", "point", {"direction": (1, 0, 0)}),
            ("outer_cone_rad", "point", {"outer_cone_rad": 0.3}),
            ("inner_cone_rad", "spot", {"inner_cone_rad": 2}),
        ):
            self.refused(name, lambda type=type, members=members: scene.add_light(type, **members))
            self.refused(name, lambda type=type, members=members: scene.add_light({"type": type, **members}))
        self.assertEqual(scene.counts["lights"], 0)
        index = scene.add_light("spot", position=(0, 3, 0), outer_cone_rad=0.5, inner_cone_rad=0.5)
        light = scene.light(index)
        light.inner_cone_rad = 0.6
        self.refused("inner_cone_rad", lambda: scene.set_light(index, light))
        light.type = "directional"  # what it keeps has no effect
        self.assertEqual(pickle.loads(pickle.dumps(light)), light)

    def test_lights_of_a_file_are_added_again(self):
        lights = [{"type": "point", "range": 7}, {"type": "spot", "spot": {"outerConeAngle": 0.4}}, {"type": "directional", "range": 7}]
        more = {"extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": lights}}}
        at = {"rotation": [0.6, 0, 0, 0.8], "translation": [1, 2, 3]}
        more["nodes"] = [{"mesh": 0}, *({"extensions": {"KHR_lights_punctual": {"light": i}}, **at} for i in range(3))]
        scene = halflit.Scene.load(box(more=more))
        self.assertEqual(scene.counts["lights"], 3)
        for i in range(3):
            scene.add_light(halflit.Light(**scene.light(i).to_dict()))

    def test_truths_and_angles_are_checked(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for wrong in ("no", None, 2):
            self.refused("visible", lambda wrong=wrong: scene.add_instance(0, visible=wrong))
        self.assertEqual(scene.counts["instances"], 1)
        self.assertFalse(scene.look(scene.add_instance(0, visible=False))["visible"])
        for wrong in (float("nan"), -1, 181):
            with self.assertRaisesRegex(halflit.UsageError, "^crease_deg is not from 0 to 180"):
                halflit.Scene.load(box(), crease_deg=wrong)
        with self.assertRaisesRegex(halflit.UsageError, "^time_limit_s is not 0 or more"):
            halflit.Scene.load(box(), time_limit_s=float("nan"))


class Budgets(unittest.TestCase):
    def test_the_report_has_the_bound(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES, normals="smooth", material={"roughness": 0.5, "metallic": 0})
        for i in range(12):
            scene.add_light("point", position=(3 * np.cos(i), 3, 3 * np.sin(i)), color=(0.5, 0.5, 0.5))
        fast = scene.render(96, max_error=1.0, studio="never")
        self.assertEqual(fast.report["error_budget"], 1.0)
        self.assertTrue(fast.report["error_within"])
        self.assertLessEqual(fast.report["error_codes"], 1.0)
        truth = scene.render(96, accuracy="reference", studio="never")
        error = np.abs(fast.astype(int) - truth)[:, :, :3]
        self.assertLessEqual(np.percentile(error, 99.9), 2)  # the budget, and rounding; edges of shadows are not in the bound
        self.assertIsInstance(fast.report["warnings"], list)
        self.assertEqual(fast.settings["max_error_codes"], 1.0)


if __name__ == "__main__":
    unittest.main()
