"""Planes beside the picture, parts of it, the caller's memory, files and notebooks."""
import base64
import io
import json
import os
import tempfile
import unittest
import zlib

import numpy as np

import halflit
from support import CORNERS, FACES, box


def cube():
    scene = halflit.Scene()
    scene.add_mesh(CORNERS, FACES, material={"base_color": (0.5, 0.25, 1), "metallic": 0})
    return scene


#: Looks at the cube's front face, z = 1, from 4 units away.
FRONT = halflit.Camera.look_at((0, 0, 5), (0, 0, 0), fov_y_rad=0.3)


def pixels_of(data):
    """The pixels of a PNG, uint8 (height, width, 3 or 4)."""
    try:
        from PIL import Image
    except ImportError:
        raise unittest.SkipTest("no PIL") from None
    return np.asarray(Image.open(io.BytesIO(data)))


class Planes(unittest.TestCase):
    def test_values_of_a_face(self):
        scene = cube()
        picture = scene.render((20, 10), camera=FRONT, aovs="all", samples=4)
        planes = picture.aovs
        self.assertEqual(tuple(planes), halflit.AOVS)
        inside = planes["id"] == 1
        self.assertTrue(inside[5, 10] and planes["id"].dtype == np.int32)
        self.assertTrue(np.allclose(planes["depth"][inside], 4, atol=1e-5))
        self.assertTrue(np.isinf(planes["depth"][~inside]).all())
        for name in ("normal", "vertex_normal"):
            self.assertTrue(np.allclose(planes[name][inside], (0, 0, 1), atol=1e-6))
            self.assertTrue((planes[name][~inside] == 0).all())
        self.assertTrue(np.allclose(planes["albedo"][inside], (0.5, 0.25, 1), atol=1e-6))
        self.assertTrue(np.allclose(planes["position"][inside][:, 2], 1, atol=1e-5))
        self.assertTrue(set(np.unique(planes["triangle"])) <= {0, 3, 4})
        self.assertEqual(planes["coverage"][5, 10], 1)
        self.assertTrue((planes["lights"][inside] >= 1).all())
        self.assertEqual(picture.pixel_hash, cube().render((20, 10), camera=FRONT, samples=4).pixel_hash)
        one = scene.render((20, 10), camera=FRONT, aovs="depth").aovs
        self.assertEqual(list(one), ["depth"])
        with self.assertRaisesRegex(halflit.UsageError, "aovs: expected names of depth, normal"):
            scene.render(8, aovs=["depth", "speed"])

    def test_positions_are_seen_where_they_are_shown(self):
        # Vertices are rounded to 1/256 pixel, so points between them move by at most half of that; float32 rounds as well.
        for azimuth, size in ((35, (320, 240)), (80, (97, 201)), (200, (640, 640))):
            picture = cube().render(size, azimuth=azimuth, samples=1, aovs=["position", "id"])
            camera, (width, height) = picture.camera, size
            shown = picture.aovs["id"] > 0
            own = (picture.aovs["position"][shown] - camera.matrix[:3, 3]) @ camera.matrix[:3, :3]
            scale = height / 2 / np.tan(camera.fov_y_rad / 2)
            x, y = width / 2 - own[:, 0] / own[:, 2] * scale, height / 2 + own[:, 1] / own[:, 2] * scale
            row, column = np.nonzero(shown)
            worst = max(np.abs(x - column - 0.5).max(), np.abs(y - row - 0.5).max())
            self.assertLess(worst, 1 / 512 + 2e-4)
            self.assertGreater(len(row), 1000)

    def test_planes_of_a_far_model_are_in_its_world(self):
        with self.assertWarnsRegex(UserWarning, "drawn at the origin"):
            far = halflit.render(box(translation=[1e6, 0, 0]), 40, aovs=["position", "depth", "id"])
        near = halflit.render(box(), 40, aovs=["position", "depth", "id"])
        inside = near.aovs["id"] == 1
        self.assertTrue((far.aovs["id"] == near.aovs["id"]).all())
        self.assertTrue(np.allclose(far.aovs["position"][inside] - (1e6, 0, 0), near.aovs["position"][inside], atol=0.07))  # 2^20 / 2^24
        self.assertTrue(np.allclose(far.aovs["depth"][inside], near.aovs["depth"][inside], atol=1e-4))
        tiny = halflit.render(box(scale=[1e-5] * 3), 40, aovs=["position", "depth", "id"])
        self.assertTrue(np.allclose(tiny.aovs["depth"][inside] * 1e5, near.aovs["depth"][inside], rtol=1e-4))
        self.assertTrue(np.allclose(tiny.aovs["position"][inside] * 1e5, near.aovs["position"][inside], atol=1e-3))

    def test_planes_of_the_program(self):
        # The numbers that `--aov` writes.
        try:
            from PIL import Image
        except ImportError:
            self.skipTest("no PIL")
        import subprocess

        import support

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "x.png")
            flags = ["--size", "80x60", "-o", path, "--aov", "id,coverage,lights,mesh,material,part", "--quiet"]
            subprocess.run([support.PROGRAM, "render", "demo", *flags], check=True)
            planes = halflit.render("demo", (80, 60), aovs=["id", "coverage", "lights", "mesh", "material", "part"]).aovs
            for name, scale in (("id", 1), ("lights", 1), ("mesh", 1), ("material", 1), ("part", 1), ("coverage", 65535)):
                stored = np.asarray(Image.open(os.path.join(folder, f"x.{name}.png"))).astype(np.int64)
                self.assertEqual(stored.tolist(), np.floor(planes[name] * float(scale) + 0.5).astype(np.int64).tolist(), name)


    def test_parts_are_the_nodes_that_place_something(self):
        # The second and the fourth node place two triangles each, side by side.
        corners = np.array([[[x, 0, 0], [x + 1, 0, 0], [x, 1, 0]] for x in (0, 1)], np.float32)
        data = base64.b64encode(corners.tobytes()).decode()
        accessors = [{"bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3",
                      "min": corners[i].min(0).tolist(), "max": corners[i].max(0).tolist()} for i in (0, 1)]  # fmt: skip
        file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 3]}],
                "nodes": [{"children": [1, 2]}, {"mesh": 0}, {}, {"mesh": 0, "translation": [0, 2, 0]}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": i}} for i in (0, 1)]}], "accessors": accessors,
                "bufferViews": [{"buffer": 0, "byteOffset": 36 * i, "byteLength": 36} for i in (0, 1)],
                "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64," + data}]}  # fmt: skip
        scene = halflit.Scene.load(json.dumps(file).encode())
        planes = scene.render(40, aovs=["id", "part"], view="front").aovs
        found = {(int(i), int(p)) for i, p in zip(planes["id"].ravel(), planes["part"].ravel())}
        self.assertEqual(found, {(0, 0), (1, 1), (2, 1), (3, 2), (4, 2)})

    def test_points_of_triangles_and_derived_planes(self):
        scene = halflit.Scene()
        uv = np.array([[0, 0], [2, 0], [0, 4]], np.float32)
        for x in (-1, 1):
            corners = np.array([[x - 1, -1, 0], [x + 1, -1, 0], [x - 1, 1, 0]], np.float32)
            scene.add_mesh(corners, [[0, 1, 2]], uv=uv, material={"base_color": (1, 1, 1)})
        camera = halflit.Camera.look_at((0, 0, 6), (0, 0, 0), fov_y_rad=0.5)
        planes = scene.render((64, 32), camera=camera, aovs="all", samples=1).aovs
        tangent = np.tan(0.25)
        x = 6 * (2 * (np.arange(64) + 0.5) / 64 - 1) * tangent * 2
        y = 6 * (1 - 2 * (np.arange(32) + 0.5) / 32) * tangent
        x, y = np.meshgrid(x, y)
        seen = planes["id"] > 0
        self.assertGreater(seen.sum(), 300)
        left = np.where(planes["id"] == 1, -2, 0)
        expected = np.stack([(x - left) / 2, (y + 1) / 2], axis=2)
        self.assertLess(np.abs(planes["barycentric"] - expected)[seen].max(), 2e-3)  # corners are whole 1/256 pixels
        self.assertLess(np.abs(planes["uv"] - planes["barycentric"] * (2, 4))[seen].max(), 1e-6)
        self.assertTrue(np.allclose(planes["ray"][seen], np.sqrt(x * x + y * y + 36)[seen], rtol=1e-5))
        self.assertTrue(np.isinf(planes["ray"][~seen]).all())
        self.assertTrue(np.allclose(planes["view_normal"][seen], (0, 0, 1), atol=1e-6))
        self.assertEqual(planes["mesh"].tolist(), planes["id"].tolist())
        self.assertEqual(set(planes["material"][seen]), set(planes["mesh"][seen]))
        for name in ("barycentric", "uv", "view_normal", "mesh", "material"):
            self.assertFalse(planes[name][~seen].any(), name)
        alone = scene.render((64, 32), camera=camera, aovs=["ray", "mesh"], samples=1).aovs
        self.assertEqual(list(alone), ["ray", "mesh"])
        self.assertTrue((alone["ray"] == planes["ray"]).all() and (alone["mesh"] == planes["mesh"]).all())
        part = scene.render((64, 32), camera=camera, aovs=["ray"], samples=1, region=(20, 8, 30, 12)).aovs
        self.assertTrue((part["ray"] == planes["ray"][8:20, 20:50]).all())

    def test_normals_of_the_view_and_distances_have_no_up(self):
        upright, turned = halflit.Scene(), halflit.Scene(up="z")
        back = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], np.float32)  # y up to z up
        upright.add_mesh(CORNERS, FACES)
        turned.add_mesh(CORNERS @ back.T, FACES)
        eye = np.array([2.0, 3.0, 4.0])
        first = upright.render(40, camera=halflit.Camera.look_at(eye, (0, 0, 0)), aovs=["view_normal", "ray", "id"]).aovs
        camera = halflit.Camera.look_at(back @ eye, (0, 0, 0), (0, 0, 1))
        second = turned.render(40, camera=camera, aovs=["view_normal", "ray", "id"]).aovs
        seen = (first["id"] > 0) & (second["id"] > 0)
        self.assertGreater(seen.sum(), 300)
        self.assertLess(np.abs(first["view_normal"] - second["view_normal"])[seen].max(), 1e-5)
        self.assertLess(np.abs(first["ray"][seen] - second["ray"][seen]).max(), 1e-4)

    def test_motion_is_where_points_are_in_the_other_picture(self):
        needed = ["id", "triangle", "barycentric", "position"]
        scene, camera = cube(), halflit.Camera.look_at((2, 2, 5), (0, 0, 0), fov_y_rad=0.6)
        other = halflit.Camera.look_at((2.5, 1.5, 5), (0.2, 0, 0), fov_y_rad=0.6)
        picture = scene.render((60, 40), camera=camera, aovs=needed, samples=1)
        found = scene.motion(picture, other)

        def pixels(view, points):
            local = (points - view.matrix[:3, 3]) @ view.matrix[:3, :3]
            scale = 20 / np.tan(0.3) / -local[..., 2]
            return np.stack([30 + local[..., 0] * scale, 20 - local[..., 1] * scale], axis=-1)

        position = picture.aovs["position"].astype(np.float64)
        seen = picture.aovs["id"] > 0
        expected = pixels(other, position) - pixels(camera, position)
        self.assertGreater(seen.sum(), 300)
        self.assertLess(np.abs(found - expected)[seen].max(), 1e-3)
        self.assertFalse(found[~seen].any())
        self.assertFalse(scene.motion(picture, camera).any())
        moved = cube()
        moved.set_instance(0, np.array([[1, 0, 0, 0.3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]))
        found = scene.motion(picture, camera, moved)
        expected = pixels(camera, position + (0.3, 0, 0)) - pixels(camera, position)
        self.assertLess(np.abs(found - expected)[seen].max(), 1e-3)
        with self.assertRaisesRegex(halflit.UsageError, "found none of triangle, barycentric"):
            scene.motion(scene.render(8, aovs=["id"]), camera)
        with self.assertRaisesRegex(halflit.UsageError, "found a region"):
            scene.motion(scene.render((60, 40), region=(0, 0, 20, 20), aovs=needed), camera)


class Batches(unittest.TestCase):
    def test_pictures_are_those_of_single_calls(self):
        scene = cube()
        views = [(0, 20), (120, -10), FRONT, FRONT.matrix, (240, 40)]
        keywords = [{"azimuth": v[0], "elevation": v[1]} if isinstance(v, tuple) else {"camera": v} for v in views]
        batch = list(scene.render_batch(views, (40, 30), light="viewer", aovs=["depth", "id"], threads=1))
        for picture, view in zip(batch, keywords):
            single = scene.render((40, 30), aovs=["depth", "id"], **view)
            self.assertEqual(picture.pixel_hash, single.pixel_hash)
            self.assertTrue((picture.aovs["depth"] == single.aovs["depth"]).all())
        self.assertEqual(len(batch), len(views))

    def test_a_fixed_light_is_that_of_the_first_camera(self):
        scene = cube()
        first = scene.render(60, azimuth=30, elevation=20, aovs=["id"])
        batch = list(scene.render_batch([(30, 20), (210, 20), (30, 20)], 60, aovs=["id"]))
        self.assertEqual([p.pixel_hash for p in batch[::2]], [first.pixel_hash] * 2)
        turned = scene.render(60, azimuth=210, elevation=20, aovs=["id"])
        self.assertTrue((batch[1].aovs["id"] == turned.aovs["id"]).all())
        self.assertNotEqual(batch[1].pixel_hash, turned.pixel_hash)
        setup = scene.setup(60, azimuth=30, elevation=20)
        cameras = list(scene.render_batch([setup.camera, batch[1].camera], 60))
        self.assertEqual([p.pixel_hash for p in cameras], [p.pixel_hash for p in batch[:2]])

    def test_wrong_batches_are_refused(self):
        scene = cube()
        for keywords, text in (({"camera": FRONT}, "no keyword 'camera'"), ({"out": np.zeros((8, 8, 4), np.uint8)}, "no keyword 'out'")):
            with self.assertRaisesRegex(TypeError, text):
                scene.render_batch([FRONT], 8, **keywords)
        with self.assertRaisesRegex(halflit.UsageError, "light: expected 'fixed' or 'viewer', found 'sun'"):
            scene.render_batch([FRONT], 8, light="sun")
        with self.assertRaises(halflit.UsageError):
            list(scene.render_batch([(0, "up")], 8))
        self.assertEqual(list(scene.render_batch([], 8)), [])


class Memory(unittest.TestCase):
    def test_regions_are_parts(self):
        whole = cube().render((60, 40), aovs=["depth"])
        part = cube().render((60, 40), region=(10, 5, 30, 20), aovs=["depth"])
        self.assertEqual(part.shape, (20, 30, 4))
        self.assertTrue((part == whole[5:25, 10:40]).all())
        self.assertTrue((part.aovs["depth"] == whole.aovs["depth"][5:25, 10:40]).all())
        for region in ((50, 0, 20, 20), (0, 0, 0, 4), (-1, 0, 4, 4)):
            with self.assertRaisesRegex(halflit.UsageError, "region"):
                cube().render((60, 40), region=region)

    def test_the_callers_memory(self):
        expected = cube().render((60, 40))
        canvas = np.full((50, 80, 4), 7, np.uint8)
        drawn = cube().render((60, 40), out=canvas[5:45, 10:70])
        self.assertTrue(np.shares_memory(drawn, canvas))
        self.assertTrue((canvas[5:45, 10:70] == expected).all())
        self.assertTrue((canvas[:5] == 7).all() and (canvas[:, :10] == 7).all() and (canvas[:, 70:] == 7).all())
        for out in (canvas, canvas[::-1][:40, :60], np.zeros((40, 120, 4), np.uint8)[:, ::2], np.zeros((40, 60, 4), np.int16)):
            with self.assertRaises(halflit.UsageError):
                cube().render((60, 40), out=out)
        locked = np.zeros((40, 60, 4), np.uint8)
        locked.flags.writeable = False
        with self.assertRaisesRegex(halflit.UsageError, "writeable"):
            cube().render((60, 40), out=locked)

    def test_floats_are_the_light_of_the_codes(self):
        light = cube().render(40, dtype=np.float32, tone_curve="none", background="transparent")
        codes = cube().render(40, tone_curve="none", background="transparent")
        self.assertEqual((light.dtype, light.shape), (np.float32, (40, 40, 4)))
        solid = codes[:, :, 3] == 255
        clipped = np.clip(light[solid][:, :3].astype(float), 0, 1)
        again = np.where(clipped <= 0.0031308, clipped * 12.92, 1.055 * clipped ** (1 / 2.4) - 0.055) * 255
        self.assertLess(np.abs(again - codes[solid][:, :3]).max(), 0.51)  # half a code of rounding, and float32's
        half = cube().render(40, background="transparent", premultiplied=True)
        self.assertTrue((half[:, :, :3].max(axis=2) <= half[:, :, 3]).all())

    def test_premultiplied_pictures_are_shown_as_others(self):
        straight = cube().render(40, background="transparent")
        picture = cube().render(40, background="transparent", premultiplied=True)
        self.assertEqual((picture.premultiplied, picture[3:, 2:].premultiplied, straight.premultiplied), (True, True, False))
        self.assertNotEqual(picture.pixel_hash, straight.pixel_hash)
        shown = pixels_of(picture.to_png())
        edge = (straight[:, :, 3] > 0) & (straight[:, :, 3] < 255)
        self.assertGreater(edge.sum(), 10)
        self.assertTrue((shown[:, :, 3] == straight[:, :, 3]).all())
        drawn = straight[:, :, 3] > 0
        # Premultiplied codes are whole numbers, which alpha / 255 may be the smaller.
        error = np.abs(shown.astype(int) - straight)[drawn][:, :3] * straight[drawn][:, 3:]
        self.assertLessEqual(error.max(), 255)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "x.png")
            picture.save(path)
            self.assertEqual(pixels_of(open(path, "rb").read()).tolist(), shown.tolist())
            light = cube().render(40, background="transparent", dtype=np.float32, premultiplied=True)
            expected = cube().render(40, background="transparent", dtype=np.float32)
            for name in ("a.png", "b.png"):
                (light if name == "a.png" else expected).save(os.path.join(folder, name))
            first, second = (pixels_of(open(os.path.join(folder, name), "rb").read()).astype(int) for name in ("a.png", "b.png"))
            self.assertLessEqual(np.abs(first - second)[expected[:, :, 3] > 0].max(), 1)


class Files(unittest.TestCase):
    def test_notebooks_show_the_pixels(self):
        picture = cube().render((31, 17), background="transparent")
        data = picture._repr_png_()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        try:
            from PIL import Image
        except ImportError:
            self.skipTest("no PIL")
        self.assertEqual(np.asarray(Image.open(io.BytesIO(data))).tolist(), picture.tolist())
        self.assertEqual(np.asarray(Image.open(io.BytesIO(picture[::2, :9]._repr_png_()))).tolist(), picture[::2, :9].tolist())
        self.assertEqual(np.asarray(Image.open(io.BytesIO(picture[:, :, :3].to_png()))).tolist(), picture[:, :, :3].tolist())
        light = cube().render((31, 17), dtype=np.float32, background="transparent")
        shown = np.asarray(Image.open(io.BytesIO(light._repr_png_()))).astype(int)
        codes = cube().render((31, 17), tone_curve="none", background="transparent", alpha="linear")
        self.assertLess(np.abs(shown - codes).max(), 2)  # one code by rounding
        self.assertIsNone(picture[0]._repr_png_())
        self.assertIsNone((picture / 2)._repr_png_())
        self.assertIsNotNone(cube()._repr_png_())

    def test_files(self):
        picture = cube().render((31, 17))
        with tempfile.TemporaryDirectory() as folder:
            for name in ("x.png", "x.bmp", "x.tga", "x.jpg"):
                picture.save(os.path.join(folder, name))
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 100)
            with open(os.path.join(folder, "x.png"), "rb") as file:
                self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
            light = cube().render((31, 17), dtype=np.float32)
            for name in ("x.pfm", "x.hdr"):
                light.save(os.path.join(folder, name))
            with self.assertRaisesRegex(halflit.UsageError, "x.hdr: expected a picture of float32"):
                picture.save(os.path.join(folder, "x.hdr"))
            with self.assertRaisesRegex(halflit.UsageError, "x.foo: unknown file extension"):
                picture.save(os.path.join(folder, "x.foo"))
            with self.assertRaises(halflit.UsageError):
                picture[0].save(os.path.join(folder, "x.png"))
            with self.assertRaises(FileNotFoundError):
                picture.save(os.path.join(folder, "no", "x.png"))

    def test_files_and_notebooks_have_the_same_codes(self):
        codes = cube().render((31, 17), background="transparent")
        light = cube().render((31, 17), background="transparent", dtype=np.float32)
        with tempfile.TemporaryDirectory() as folder:
            for picture in (codes, light, codes[:, :, :3], light[:, :, :3], codes[::2, 3:]):
                path = os.path.join(folder, "x.png")
                picture.save(path)
                stored, shown = pixels_of(open(path, "rb").read()), pixels_of(picture.to_png())
                self.assertEqual(stored[:, :, :3].tolist(), shown[:, :, :3].tolist())
                self.assertTrue((stored[:, :, 3:] == (shown[:, :, 3:] if shown.shape[2] == 4 else 255)).all())
            light[:, :, :3].save(os.path.join(folder, "x.pfm"))

    def test_a_picture_is_an_array(self):
        picture = cube().render(16)
        self.assertIsInstance(picture, np.ndarray)
        self.assertEqual(picture.mean(axis=2).shape, (16, 16))
        self.assertEqual(zlib.crc32(picture.tobytes()), zlib.crc32(np.asarray(picture).tobytes()))
        self.assertEqual(picture[2:5].report, {})
        for name in ("total_ms", "triangles_drawn", "pixels_visible", "isa", "threads", "warnings"):
            self.assertIn(name, picture.report)
        self.assertEqual(picture.report["triangles_submitted"], 12)


if __name__ == "__main__":
    unittest.main()
