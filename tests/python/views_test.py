"""Views of the whole scene: named sides, sheets of several by one scale, and orbits, against the program and closed forms."""
import os
import tempfile
import subprocess
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, PROGRAM, box, program_hash


def bar(up="y"):
    """A box of 6 x 2 x 2 along x."""
    scene = halflit.Scene(up=up)
    scene.add_mesh(CORNERS * (3, 1, 1), FACES)
    return scene


def extent(picture):
    """Width and height of what is not transparent."""
    rows, columns = np.nonzero(np.asarray(picture)[..., 3])
    return np.ptp(columns) + 1, np.ptp(rows) + 1


class Named(unittest.TestCase):
    def test_a_view_has_the_pixels_of_the_program(self):
        data = box()
        scene = halflit.Scene.load(data)
        for flags, options in (
            (["--view", "iso"], {"view": "iso"}),
            (["--view", "30,-20", "--ortho"], {"view": (30, -20), "orthographic": True}),
            (["--view", "top", "--fit", "5"], {"view": "top", "fit": 5}),
            (["--fit", "12"], {"fit": 12}),
            (["--view", "left", "--zoom", "2", "--fov", "20"], {"view": "left", "zoom": 2, "fov": 20}),
        ):
            with self.subTest(flags=flags):
                self.assertEqual(scene.render((96, 64), **options).pixel_hash, program_hash("-", "--size", "96x64", *flags, data=data))

    def test_sheets_have_the_pixels_of_the_program(self):
        names = ["front", "right", "top", "iso"]
        with tempfile.TemporaryDirectory() as folder:
            model = os.path.join(folder, "box.glb")
            with open(model, "wb") as file:
                file.write(box())
            command = [PROGRAM, "render", model, "--view", ",".join(names), "--size", "80x60", "--ortho", "--edges", "feature", "--edge-color",
                       "#ff0000", "-o", os.path.join(folder, "{view}.png"), "--report", "-", "--quiet"]  # fmt: skip
            lines = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.decode().splitlines()
            sheet = halflit.Scene.load(model).render_views(names, (80, 60), orthographic=True, edges="feature", edge_color="#ff0000")
        self.assertEqual(list(sheet), names)
        for name, line in zip(names, lines):
            self.assertIn(sheet[name].pixel_hash, line, name)

    def test_views_of_a_sheet_have_one_scale(self):
        sheet = bar().render_views(["front", "right", "top", (45, 0)], (300, 200), orthographic=True, fit=30, background="transparent")
        sizes = {name: extent(picture) for name, picture in sheet.items()}
        self.assertEqual(set(sizes), {"front", "right", "top", (45, 0)})
        # 6 units are as wide as the picture less the margins: 40 pixels a unit.
        # A pixel that is covered in part may come at each end.
        for name, (width, height) in {"front": (240, 80), "right": (80, 80), "top": (240, 80), (45, 0): (226, 80)}.items():
            self.assertLessEqual(abs(sizes[name][0] - width), 2, name)
            self.assertLessEqual(abs(sizes[name][1] - height), 2, name)

    def test_a_world_with_another_axis_up_has_the_same_views(self):
        upright, turned = bar(), halflit.Scene(up="z")
        turned.add_mesh((CORNERS * (3, 1, 1))[:, [0, 2, 1]] * (1, -1, 1), FACES)
        for view in ("front", "top", (20, 30)):
            self.assertEqual(upright.render(64, view=view, orthographic=True).pixel_hash,
                             turned.render(64, view=view, orthographic=True).pixel_hash)  # fmt: skip

    def test_edges_have_their_colour(self):
        picture = bar().render(64, view="front", orthographic=True, edges="all", edge_width=3, edge_color=(0, 0, 1))
        self.assertTrue((np.asarray(picture)[..., :3] == (0, 0, 255)).all(axis=2).any())
        self.assertEqual(picture.settings["edge_color"], (0, 0, 1))

    def test_what_contradicts_is_refused(self):
        scene = bar()
        for wrong in ({"view": "side"}, {"view": 3}, {"view": (1, 2, 3)}, {"view": (0, 91)}, {"view": "iso", "azimuth": 3}, {"fit": -1},
                      {"fit": "x"}, {"view": "iso", "camera": 0}, {"edge_color": (2, 0, 0)}, {"view": (float("nan"), 0)}):  # fmt: skip
            with self.subTest(wrong=wrong), self.assertRaises(halflit.UsageError):
                scene.render(32, **wrong)
        with self.assertRaises(TypeError):
            scene.render_views(["iso"], 32, azimuth=3)
        with self.assertRaises(halflit.UsageError):
            scene.render_views([], 32)


class Cameras(unittest.TestCase):
    def test_orbit_is_where_its_angles_say(self):
        for theta, phi, radius, target in ((30, 60, 5, (1, 2, 3)), (-170, 100, 0.5, (0, 0, 0)), (10, 0, 2, (0, 1, 0)), (5, 70, 3, (1e7, 0, 2))):
            t, p = np.radians((theta, phi))
            back = np.array([np.sin(p) * np.sin(t), np.cos(p), np.sin(p) * np.cos(t)])
            camera = halflit.Camera.orbit(theta, phi, radius, target, fov_y_rad=0.5)
            np.testing.assert_allclose(camera.matrix[:3, 3], target + radius * back, atol=1e-6)
            np.testing.assert_allclose(camera.matrix[:3, 2], back, atol=1e-6)
            np.testing.assert_allclose(camera.matrix[:3, 0], [np.cos(t), 0, -np.sin(t)], atol=1e-6)
            self.assertAlmostEqual(camera.fov_y_rad, 0.5, 6)
            # With z up, (x, y, z) of the upright world is (x, -z, y).
            turned = halflit.Camera.orbit(theta, phi, radius, up="z").matrix[:3, 2]
            np.testing.assert_allclose(turned, back[[0, 2, 1]] * (1, -1, 1), atol=1e-6)
        for wrong in ((0, 0, 0), (0, 0, -1), (0, 0, float("inf")), (float("nan"), 0, 1), ("a", 0, 1)):
            with self.assertRaises(halflit.UsageError):
                halflit.Camera.orbit(*wrong)

    def test_the_camera_of_a_view_draws_that_view(self):
        scene = halflit.Scene.load(box(translation=[5e5, 0, 0]))  # drawn near the origin
        for view in ("iso", (200, -30)):
            for options in ({}, {"orthographic": True, "fit": 4}):
                camera = halflit.Camera.view(scene, view, (64, 48), **options)
                self.assertEqual(scene.render((64, 48), camera=camera).pixel_hash, scene.render((64, 48), view=view, **options).pixel_hash)
        self.assertGreater(camera.matrix[0, 3], 4e5)


if __name__ == "__main__":
    unittest.main()
