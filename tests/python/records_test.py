"""Materials, lights and cameras as objects: what they begin with, copies, and what is told of them."""
import copy
import multiprocessing
import os
import pickle
import tempfile
import unittest
import warnings
from concurrent.futures import ProcessPoolExecutor
from typing import get_args

import numpy as np

import halflit
from halflit import _mesh, _options, _types
from support import CAMERA, CORNERS, FACES, TURN, box, moved


def light_of(material, faces=FACES):
    """Mean code of a cube's pixels, seen from in front."""
    scene = halflit.Scene()
    scene.add_mesh(CORNERS, faces, material=material)
    picture = scene.render((80, 60), background="transparent")
    return float(picture[picture[:, :, 3] == 255][:, :3].mean())


def hash_of(scene):
    return scene.render(32).pixel_hash


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

    def test_copies_of_scenes_are_scenes_of_their_own(self):
        scene = halflit.Scene.load(box(scale=[1e-5] * 3, more={**TURN, **CAMERA}), keep_animations=True)  # which is drawn larger
        texture = scene.add_texture(np.arange(48, dtype=np.uint8).reshape(4, 4, 3) * 5)
        looks = {"material": scene.add_material(base_color=(0.2, 0.5, 0.9), base_color_texture=texture), "uv": CORNERS[:, :2]}
        mesh = scene.add_mesh(CORNERS * 1e-5, FACES, normals="smooth", name="mine", matrix=moved(3e-5), **looks)
        scene.set_instance(mesh.instance, color=(0.5, 1, 1), name="placed")
        scene.remove_instance(scene.add_instance(mesh))
        scene.add_light("point", position=(2e-5, 3e-5, 4e-5), color=(1e-9, 1e-9, 1e-9))
        scene.set_environment(np.random.default_rng(5).random((8, 16, 3), np.float32), rotate=40)
        scene.set_vertices(mesh, CORNERS * 1.5e-5)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            expected = scene.render(48, aovs=["id", "depth"])
            for made in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
                found = made.render(48, aovs=["id", "depth"])
                self.assertEqual(found.pixel_hash, expected.pixel_hash)
                self.assertTrue(np.array_equal(found.aovs["depth"], expected.aovs["depth"]))
                self.assertEqual((made.counts, made.nodes, made.up), (scene.counts, scene.nodes, scene.up))
                self.assertEqual((made.name("mesh", mesh), made.name("instance", mesh.instance)), ("mine", "placed"))
                self.assertEqual(made.add_instance(mesh), scene.counts["instances"] - 1)  # the place that is free
                made.pose(time=1)
                made.set_vertices(mesh, CORNERS * 1e-5)
                self.assertNotEqual(made.render(48).pixel_hash, expected.pixel_hash)
            self.assertEqual(scene.render(48).pixel_hash, expected.pixel_hash)
        damaged = bytearray(scene.__reduce_ex__(2)[1][1])
        damaged[len(damaged) // 2] ^= 1
        with self.assertRaisesRegex(halflit.BadInputError, "expected the bytes of a scene"):
            halflit.Scene()._change("scene_restore", bytes(damaged), len(damaged))

    def test_the_types_of_names_have_the_names_that_there_are(self):
        self.assertEqual(sorted(get_args(_types.Aov)), sorted(_options.AOVS))
        self.assertEqual(get_args(_types.Topology), tuple(_mesh.CORNERS))
        with self.assertRaises(halflit.UsageError) as refused:
            halflit.Lobe.named("x")
        expected = str(refused.exception).split("expected ")[1].replace(" or ", ", ")
        self.assertEqual(", ".join(get_args(_types.LobeName)), expected)
        with self.assertRaises(halflit.UsageError) as refused:
            halflit.Scene.demo().render(8, isa="x")
        here = str(refused.exception).split("expected auto, ")[1].split(", ")
        self.assertLessEqual(set(here), set(get_args(_types.Isa)))

    def test_a_copy_of_a_scene_with_animations_needs_its_file_as_it_was(self):
        with tempfile.TemporaryDirectory() as folder:
            here, path = os.getcwd(), os.path.join(folder, "box.gltf")
            with open(path, "wb") as file:
                file.write(box())
            try:
                os.chdir(folder)
                kept = pickle.dumps(halflit.Scene.load("box.gltf", keep_animations=True))
            finally:
                os.chdir(here)
            self.assertEqual(pickle.loads(kept).counts["meshes"], 1)
            with open(path, "ab") as file:
                file.write(b" ")
            with self.assertRaisesRegex(halflit.UsageError, "box.gltf: changed since"):
                pickle.loads(kept)

    def test_a_scene_reaches_a_process_that_is_spawned(self):
        scene = halflit.Scene.demo()
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            self.assertEqual(pool.submit(hash_of, scene).result(), hash_of(scene))

    def test_a_material_is_matt_unless_it_is_asked_to_be_metal(self):
        self.assertEqual(halflit.Material().metallic, 0)
        self.assertEqual(halflit.Material(metallic=0.5).metallic, 0.5)
        self.assertEqual(halflit.Material(metallic_roughness_texture=0).metallic, 1)  # a factor of the texture
        white = {"base_color": (0.8, 0.8, 0.8)}
        self.assertEqual(light_of(white), light_of({**white, "metallic": 0}))
        self.assertNotEqual(light_of(white), light_of({**white, "metallic": 1}))

    def test_the_factor_of_a_metallic_texture_does_not_depend_on_the_order(self):
        material = halflit.Material()
        material.metallic_roughness_texture = 0
        self.assertEqual(material.metallic, 1)
        for members in ({"metallic": 0.25, "metallic_roughness_texture": 0}, {"metallic_roughness_texture": 0, "metallic": 0.25}):
            self.assertEqual(halflit.Material(**members).metallic, 0.25)
        scene = halflit.Scene()
        texture = scene.add_texture(np.zeros((2, 2, 3), np.uint8))
        index = scene.add_material(base_color=(1, 0, 0))
        scene.set_material(index, metallic_roughness_texture=texture)
        self.assertEqual(scene.material(index).metallic, 1)
        scene.set_material(index, metallic_roughness_texture=texture, metallic=0)
        self.assertEqual(scene.material(index).metallic, 0)
        made = halflit.Material(metallic=0, metallic_roughness_texture=1)
        self.assertIn("metallic=0.0", repr(made))
        self.assertEqual(eval(repr(made), vars(halflit)), made)

    def test_colours_are_light_texts_or_codes(self):
        red = halflit.Material(base_color="#ff8000")
        self.assertEqual(halflit.Material(base_color=np.uint8((255, 128, 0))), red)
        self.assertAlmostEqual(red.base_color[1], ((128 / 255 + 0.055) / 1.055) ** 2.4, places=6)
        self.assertEqual(halflit.Material(base_color="#f808").base_color[3], np.float32(0x88 / 255))
        self.assertEqual(halflit.Material(base_color=(1, 0, 0)).base_color, (1, 0, 0, 1))
        self.assertEqual(halflit.Light(color="#fff").color, (1, 1, 1))
        self.assertEqual(halflit.Light(color=(8, 8, 7)).color, (8, 8, 7))
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        white = scene.render(8, background="#ffffff").pixel_hash
        for background in ((1, 1, 1), np.uint8((255, 255, 255)), np.float32((1, 1, 1, 1))):
            self.assertEqual(scene.render(8, background=background).pixel_hash, white)

    def test_dicts_and_objects_may_be_given_everywhere(self):
        scene = halflit.Scene()
        paint, lamp = halflit.Material(roughness=0.5), halflit.Light("point", range=3)
        self.assertEqual(scene.material(scene.add_material({"roughness": 0.5})), paint)
        self.assertEqual(scene.light(scene.add_light({"type": "point", "range": 3})), lamp)
        self.assertEqual(scene.material(scene.add_material(paint, metallic=1)), halflit.Material(roughness=0.5, metallic=1))
        self.assertEqual(scene.light(scene.add_light(lamp, range=4)).range, 4)
        scene.set_light(1, {"type": "spot"})
        self.assertEqual(scene.light(1).type, "spot")
        scene.set_material(0, paint, roughness=0.1)
        self.assertAlmostEqual(scene.material(0).roughness, 0.1)
        scene.set_material(0, {"roughness": 0.2})
        self.assertAlmostEqual(scene.material(0).roughness, 0.2)
        self.assertEqual((paint.roughness, paint.metallic, lamp.range), (0.5, 0, 3))  # the caller's are not changed
        for call in (lambda: scene.add_light(3), lambda: scene.set_light(0, "point"), lambda: scene.add_material("red"),
                     lambda: halflit.render(box(), 8, lights=["point"])):  # fmt: skip
            with self.assertRaisesRegex(halflit.UsageError, "expected a (Light|Material) or a dict of its members"):
                call()

    def test_a_mesh_without_a_material_is_seen_from_both_sides(self):
        # Made for people who do not know which way round their faces are.
        self.assertEqual(light_of(None), light_of({"roughness": 0.6, "double_sided": True}))
        self.assertEqual(light_of(None), light_of(None, FACES[:, ::-1]))

    def test_each_member_is_explained(self):
        for kind in (halflit.Material, halflit.Light, halflit.Camera, halflit.Lobe, halflit.TextureUse):
            for name in set(kind._members()) - {"world_from_camera"}:
                self.assertRegex(kind.__doc__, rf"(?m)^ +{name}: \S", kind)
        self.assertTrue(_options.KNOWN)
        for name in _options.KNOWN:
            self.assertRegex(halflit.PictureOptions.__doc__, rf"(?m)^ +{name}: \S")
        self.assertEqual(set(halflit.PictureOptions.__annotations__), _options.KNOWN)


class Refused(unittest.TestCase):
    def test_numbers_that_are_none(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        nan, inf = float("nan"), float("inf")
        for keywords, words in (
            ({"fov": 500}, "fov: expected a number from 1 to 170"),
            ({"fov": nan}, "fov: expected a finite number"),
            ({"zoom": nan}, "zoom"),
            ({"zoom": 0}, "zoom"),
            ({"azimuth": inf}, "azimuth: expected a finite number"),
            ({"ambient": (nan, 0, 0)}, "ambient: a number is not finite"),
            ({"background": (nan, 0, 0)}, "background: expected linear light"),
            ({"exposure": nan}, "exposure"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, words):
                scene.render(8, **keywords)
        with self.assertRaisesRegex(halflit.UsageError, "zoom"):
            scene.frame(zoom=nan)
        with self.assertRaisesRegex(halflit.UsageError, "azimuth: expected a number, found 'left'"):
            scene.frame(azimuth="left")
        for ambient in ((nan, 0, 0), (-1, 0, 0)):
            with self.assertRaisesRegex(halflit.UsageError, "sky: "):
                scene.set_ambient(ambient)

    def test_members_out_of_range(self):
        nan, inf = float("nan"), float("inf")
        for kind, name, values in (
            (halflit.Light, "color", ((nan, 1, 1),)),
            (halflit.Light, "position", ((0, inf, 0),)),
            (halflit.Light, "direction", ((0, nan, 0), (0, 0, 0))),
            (halflit.Light, "range", (nan, inf, -1)),
            (halflit.Light, "shadow_radius", (nan, -1)),
            (halflit.Light, "outer_cone_rad", (nan, 4)),
            (halflit.Material, "metallic", (7, -1, nan)),
            (halflit.Material, "roughness", (-3, 1.1)),
            (halflit.Material, "base_color", ((nan, 0, 0), (-1, 0, 0), (0, 0, 0, 2))),
            (halflit.Material, "emissive", ((-1, 0, 0), (nan, 0, 0))),
            (halflit.Material, "normal_scale", (nan,)),
            (halflit.Material, "specular", (2,)),
            (halflit.Material, "clearcoat", (2,)),
            (halflit.Material, "thickness", (-1, nan)),
            (halflit.Material, "lobe", (("sloan", nan), 3)),
            (halflit.Lobe, "wrap", (2, nan)),
            (halflit.TextureUse, "uv_set", (2, -1)),
            (halflit.TextureUse, "row_u", ((1, 0, nan),)),
            (halflit.Camera, "fov_y_rad", (0, 3.2, nan)),
            (halflit.Camera, "half_height", (0, nan)),
        ):
            for value in values:
                with self.assertRaisesRegex(halflit.UsageError, f"^{name}: "):
                    kind(**{name: value})

    def test_matrices(self):
        eye, turned = np.eye(4), np.eye(4)
        eye[3, 0] = 2
        turned[:3, :3] *= 2
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for matrix, words in (
            (eye, "expected 0 0 0 1 as the last row"),
            (np.array(halflit.Camera.look_at((3, 0, 0), (0, 0, 0)).matrix.T), "is it transposed"),
            (np.full((4, 4), np.nan), "not finite"),
            (np.eye(3), r"shape \(4, 4\), found \(3, 3\)"),
            ("identity", "an array of numbers"),
        ):
            for call in (lambda m: scene.set_instance(0, m), lambda m: scene.add_instance(0, m), lambda m: halflit.Camera(m)):
                with self.assertRaisesRegex(halflit.UsageError, f"^matrix: .*{words}"):
                    call(matrix)
        scene.set_instance(0, turned)
        with self.assertRaisesRegex(halflit.UsageError, "matrix: expected a rigid one"):
            halflit.Camera(turned)
        for points in (((1, 2, 3), (1, 2, 3)), ((1, 2, 3), (0, 0, float("nan"))), ((1, 2, 3), (0, 0, 0), (0, 0, 0))):
            with self.assertRaisesRegex(halflit.UsageError, "look_at: expected"):
                halflit.Camera.look_at(*points)
        for members, words in (({"near_z": -1}, "near_z"), ({"near_z": 2, "far_z": 1}, "far_z")):
            with self.assertRaisesRegex(halflit.UsageError, f"{words}: expected a distance"):
                scene.render(8, camera=halflit.Camera(**members))

    def test_codes_in_the_place_of_light(self):
        scene = halflit.Scene()
        for colors in (np.full((8, 3), 255.0), np.full((8, 3), 200), np.full((8, 4), 2, np.uint16), np.full((8, 3), np.nan),
                       np.full((8, 3), -1.0)):  # fmt: skip
            with self.assertRaisesRegex(halflit.UsageError, "colors: expected uint8 sRGB codes, or linear light"):
                scene.add_mesh(CORNERS, FACES, colors=colors)
        for colors in (np.full((8, 3), 2.0), np.ones((8, 3), int), [[1, 0, 1]] * 8, np.full((8, 3), 200, np.uint8)):
            scene.add_mesh(CORNERS, FACES, colors=colors)
        for value in ((255, 0, 0), (255.0, 0, 0), np.array((200, 30, 90)), np.array((0, 1, 0), bool), "reddish", "#12", (1, (2, 3)), None):
            with self.assertRaisesRegex(halflit.UsageError, "^base_color: expected"):
                halflit.Material(base_color=value)
            with self.assertRaisesRegex(halflit.UsageError, "^background: expected"):
                scene.render(8, background=() if value is None else value)
        for image in (np.full((4, 8, 3), 200, np.uint8), np.ones((4, 8, 3), int)):
            with self.assertRaisesRegex(halflit.UsageError, "environment: expected .* floats of linear light"):
                scene.set_environment(image)

    def test_what_is_no_whole_number_or_truth(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for call, words in (
            (lambda: scene.render((16.9, 8.2)), "size: expected a whole number, found 16.9"),
            (lambda: scene.render("64"), "size: expected whole numbers, found '64'"),
            (lambda: scene.render((8, 8, 8)), r"size: expected \(width, height\)"),
            (lambda: scene.render(8, samples=4.0), "samples: expected 1, 4, 8 or 16, found '4.0'"),
            (lambda: scene.render(8, region=(0, 0, 4)), "region: expected x, y, width and height"),
            (lambda: scene.render(8, region=(0, 0, 4, 4.5)), "region: expected a whole number, found 4.5"),
            (lambda: scene.render(8, premultiplied="yes"), "premultiplied: expected True or False"),
            (lambda: scene.render(8, normalize_specular="no"), "normalize_specular: expected one of off, on"),
            (lambda: scene.render(8, max_error="low"), "max_error: expected 0, or a number above 0 to 255, found 'low'"),
            (lambda: scene.render(8, time_limit="1"), "time_limit: expected a number"),
            (lambda: scene.render(8, fov="wide"), "fov: expected a number"),
            (lambda: scene.render(8, out=[1, 2]), "out: expected an array"),
            (lambda: scene.render(8, dtype="float"), "dtype: expected uint8 or float32"),
            (lambda: scene.render(8, dtype=3), "dtype: expected uint8 or float32, found 3"),
            (lambda: scene.render(8, aovs=3), "aovs: expected names of depth"),
            (lambda: scene.render(8, aovs=[["depth"]]), "aovs: expected names of depth"),
            (lambda: scene.render(8, isa=2), "isa: expected a text or a path, found 2"),
            (lambda: scene.render(8, cancelled=True), "cancelled: expected a function"),
            (lambda: scene.render(8).save(3), "path: expected a text or a path"),
            (lambda: scene.add_mesh(CORNERS, FACES, name=3), "name: expected a text"),
            (lambda: scene.add_mesh(CORNERS, [[0, 1, 2], [0, 1]]), "faces: expected an array of numbers"),
            (lambda: scene.add_mesh("cube", FACES), "vertices: expected an array of numbers, found 'cube'"),
            (lambda: scene.add_texture([[1, 2], [3]]), "texture: expected an array of numbers"),
            (lambda: scene.set_environment(None), "environment: expected an array of numbers"),
            (lambda: scene.render(8, camera=object()), "matrix: expected an array of numbers"),
            (lambda: halflit.render(box(), 8, load=[1]), "load: expected a dict"),
            (lambda: scene.instance("first"), "index: expected a whole number, found 'first'"),
            (lambda: scene.instance(0.0), "index: expected a whole number, found 0.0"),
            (lambda: scene.pose(time="late"), "time: expected a number"),
            (lambda: scene.add_instance(1.5), "mesh: expected a whole number"),
            (lambda: halflit.TextureUse(uv_set=1.9), "uv_set: expected a whole number"),
            (lambda: halflit.Material(base_color_texture="wood"), "base_color_texture: expected a whole number, found 'wood'"),
            (lambda: halflit.Material(alpha_mode=1.7), "alpha_mode: expected a whole number"),
            (lambda: halflit.Material(double_sided="no"), "double_sided: expected True or False, found 'no'"),
            (lambda: halflit.Material(roughness="0.5"), "roughness: expected a number, found '0.5'"),
            (lambda: halflit.Light(position=3), "position: expected 3 numbers, found 3"),
            (lambda: halflit.Light("point", color=(1, -1, 0)), r"color: expected light from 0 on, found \(1, -1, 0\)"),
            (lambda: halflit.render("demo", "big"), "size: expected whole numbers, found 'big'"),
            (lambda: halflit.render("demo", 8, elevation=91), "elevation: expected a number from -90 to 90"),
            (lambda: halflit.Scene.load(box(), strict="no"), "strict: expected True or False"),
            (lambda: halflit.Scene.load(box(), crease_deg="sharp"), "crease_deg: expected a number"),
            (lambda: halflit.Scene.load(box(), time="1"), "time: expected a number"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, "^" + words):
                call()
        self.assertEqual(scene.render(np.array((8, 6)), samples=np.int64(4), premultiplied=np.True_).shape, (6, 8, 4))

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
