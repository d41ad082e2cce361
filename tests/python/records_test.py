"""Materials, lights and cameras as objects: what they begin with, copies, and what is told of them."""
import copy
import pickle
import unittest
import warnings

import numpy as np

import halflit
from halflit import _options
from support import CORNERS, FACES


def light_of(material, faces=FACES):
    """Mean code of a cube's pixels, seen from in front."""
    scene = halflit.Scene()
    scene.add_mesh(CORNERS, faces, material=material)
    picture = scene.render((80, 60), background="transparent")
    return float(picture[picture[:, :, 3] == 255][:, :3].mean())


class Records(unittest.TestCase):
    def test_copies_are_equal_and_have_their_own_values(self):
        use = halflit.TextureUse(2, wrap_u="clamp")
        material = halflit.Material(name="a name of some length", base_color=(1, 0.5, 0.25), base_color_texture=use, lobe=("sloan", 0.5))
        light = halflit.Light("spot", position=(1, 2, 3), outer_cone_rad=0.5)
        camera = halflit.Camera.look_at((1, 2, 3), (0, 0, 0), fov_y_rad=0.5)
        for record in (use, material, light, camera, halflit.Lobe(0.5, 2, True)):
            for made in (copy.copy(record), copy.deepcopy(record), pickle.loads(pickle.dumps(record))):
                self.assertEqual(made, record)
                self.assertIs(type(made), type(record))
        made = copy.copy(material)
        made.base_color, made.name, made.lobe.wrap = (0, 0, 0), "other", 0.25
        self.assertEqual(material.base_color, (1, 0.5, 0.25, 1))
        self.assertEqual((material.name, material.lobe.wrap), ("a name of some length", 0.5))
        self.assertEqual(halflit.Material(base_color_texture={"texture": 2, "wrap_u": "clamp"}).base_color_texture, use)

    def test_a_material_is_matt_unless_it_is_asked_to_be_metal(self):
        self.assertEqual(halflit.Material().metallic, 0)
        self.assertEqual(halflit.Material(metallic=0.5).metallic, 0.5)
        self.assertEqual(halflit.Material(metallic_roughness_texture=0).metallic, 1)  # a factor of the texture
        white = {"base_color": (0.8, 0.8, 0.8)}
        self.assertEqual(light_of(white), light_of({**white, "metallic": 0}))
        self.assertNotEqual(light_of(white), light_of({**white, "metallic": 1}))

    def test_a_mesh_without_a_material_is_seen_from_both_sides(self):
        # Made for people who do not know which way round their faces are.
        self.assertEqual(light_of(None), light_of({"roughness": 0.6, "double_sided": True}))
        self.assertEqual(light_of(None), light_of(None, FACES[:, ::-1]))

    def test_each_member_is_explained(self):
        for kind in (halflit.Material, halflit.Light, halflit.Camera, halflit.Lobe, halflit.TextureUse):
            for name in set(kind._members()) - {"world_from_camera"}:
                self.assertRegex(kind.__doc__, rf"(?m)^        {name}: \S", kind)
        self.assertTrue(_options.KNOWN)
        for name in _options.KNOWN:
            self.assertRegex(halflit.PictureOptions.__doc__, rf"(?m)^        {name}: \S")
        self.assertEqual(set(halflit.PictureOptions.__annotations__), _options.KNOWN)


class Refused(unittest.TestCase):
    def test_numbers_that_are_none(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        nan, inf = float("nan"), float("inf")
        for keywords, words in (
            ({"fov": 500}, "fov_y_deg is not above 0 and below 180"),
            ({"fov": nan}, "fov_y_deg"),
            ({"zoom": nan}, "zoom"),
            ({"zoom": 0}, "zoom"),
            ({"azimuth": inf}, "azimuth_deg"),
            ({"ambient": (nan, 0, 0)}, "ambient: a number is not finite"),
            ({"background": (nan, 0, 0)}, "background: expected linear light"),
            ({"exposure": nan}, "exposure"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, words):
                scene.render(8, **keywords)
        for members in ({"color": (nan, 1, 1)}, {"position": (0, inf, 0)}, {"shadow_radius": nan}, {"direction": (0, nan, 0)}):
            with self.assertRaisesRegex(halflit.UsageError, "is not finite"):
                halflit.Scene().add_light("point", **members)
        with self.assertRaisesRegex(halflit.UsageError, "zoom"):
            scene.frame(zoom=nan)

    def test_codes_in_the_place_of_light(self):
        scene = halflit.Scene()
        for colors in (np.full((8, 3), 255.0), np.full((8, 3), 200), np.full((8, 4), 2, np.uint16)):
            with self.assertRaisesRegex(halflit.UsageError, "colors: expected uint8 sRGB codes, or linear light"):
                scene.add_mesh(CORNERS, FACES, colors=colors)
        for colors in (np.full((8, 3), 2.0), np.ones((8, 3), int), [[1, 0, 1]] * 8, np.full((8, 3), 200, np.uint8)):
            scene.add_mesh(CORNERS, FACES, colors=colors)

    def test_a_path_with_nul(self):
        with self.assertRaisesRegex(halflit.UsageError, "without NUL"):
            halflit.Scene.load("model.glb\0.txt")
        with self.assertRaisesRegex(halflit.UsageError, "without NUL"):
            halflit.render("demo", 8).save("x.png\0")


class Warnings(unittest.TestCase):
    def test_an_empty_picture_is_told_once(self):
        corners = [[x, y, 0] for x, y in ((0, 0), (0, 1), (1, 0))]  # clockwise from in front
        scene = halflit.Scene()
        scene.add_mesh(corners, [[0, 1, 2]], material={})
        with self.assertWarnsRegex(UserWarning, "nothing to draw: all triangles face away") as told:
            picture = scene.render(8, azimuth=0, elevation=0)
        self.assertEqual(told.filename, __file__)  # the line of the caller
        self.assertEqual(len(picture.report["warnings"]), 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            scene.render(8, azimuth=0, elevation=0)


if __name__ == "__main__":
    unittest.main()
