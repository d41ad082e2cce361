"""Tests of values that a caller may hand over and take: tensors, file objects, colours by name."""
import io
import os
import tempfile
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, box, moved


class Tensor:
    """As a library of tensors has it, which knows DLPack alone."""

    def __init__(self, array, device=1):
        self.array, self.device = array, device

    def __dlpack_device__(self):
        return self.device, 0

    def __dlpack__(self, *arguments, **keywords):
        if self.device != 1:
            raise BufferError("on a GPU")
        return self.array.__dlpack__(*arguments, **keywords)


class Converted:
    """As a library of tensors has it, which knows numpy."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.array, dtype)


class Tensors(unittest.TestCase):
    @unittest.skipUnless(hasattr(np, "from_dlpack"), "an old numpy")
    def test_pictures_and_planes_are_taken_without_a_copy(self):
        picture = halflit.render((CORNERS, FACES), 16, aovs=["depth"])
        for array in (picture, picture.aovs["depth"]):
            taken = np.from_dlpack(array)
            self.assertEqual(taken.ctypes.data, array.ctypes.data)
            self.assertTrue(np.array_equal(taken, array))

    @unittest.skipUnless(hasattr(np, "from_dlpack"), "an old numpy")
    def test_tensors_are_arrays(self):
        expected = halflit.render((CORNERS, FACES), 32).pixel_hash
        for kind in (Tensor, Converted):
            self.assertEqual(halflit.render((kind(CORNERS), kind(FACES.astype(np.int64))), 32).pixel_hash, expected)
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        scene.set_instance(0, Tensor(moved(1, 2, 3)))
        self.assertEqual(scene.instance(0)[1].tolist(), moved(1, 2, 3).tolist())

    def test_a_tensor_on_a_gpu_is_refused_by_name(self):
        by_name = type("Cuda", (), {"is_cuda": True, "shape": (8, 3)})()
        for given in (Tensor(CORNERS, 2), Tensor(CORNERS, 10), by_name):
            with self.assertRaisesRegex(halflit.UsageError, "vertices: expected an array in main memory, found one on a GPU"):
                halflit.Scene().add_mesh(given, FACES)

    def test_a_tensor_that_follows_gradients_says_why(self):
        class Learned:
            def __array__(self, dtype=None, copy=None):
                raise RuntimeError("use tensor.detach()")

        with self.assertRaisesRegex(halflit.UsageError, "vertices: use tensor.detach"):
            halflit.Scene().add_mesh(Learned(), FACES)


    def test_a_tensor_that_fails_is_refused_by_name(self):
        class Wrong:
            def __init__(self, device, said):
                self.device, self.said = device, said

            def __dlpack_device__(self):
                return self.device

            def __dlpack__(self, **_):
                if isinstance(self.said, Exception):
                    raise self.said
                return self.said

        for wrong in (Wrong(3, 4), Wrong((1, 0), 4), Wrong((1, 0), ValueError("no\nmemory"))):
            with self.assertRaisesRegex(halflit.UsageError, "^vertices: expected an array of numbers, found .* fails: [^\n]*$"):
                halflit.Scene().add_mesh(wrong, FACES)


class FileObjects(unittest.TestCase):
    def test_scenes_are_read(self):
        expected = halflit.render(box(), 32).pixel_hash
        self.assertEqual(halflit.Scene.load(io.BytesIO(box())).render(32).pixel_hash, expected)
        self.assertEqual(halflit.render(io.BytesIO(box()), 32).pixel_hash, expected)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "box.glb")
            with open(path, "wb") as file:
                file.write(box())
            with open(path, "rb") as file:
                self.assertEqual(halflit.Scene.load(file).render(32).pixel_hash, expected)
            with open(path, "wb") as file:
                file.write(b"glTF")
            with open(path, "rb") as file, self.assertRaisesRegex(halflit.BadInputError, "box.glb"):
                halflit.Scene.load(file)
        with tempfile.NamedTemporaryFile() as file:
            file.write(b"\xd0\x00")
            file.flush()
            with open(file.name, encoding="utf-8") as text, self.assertRaisesRegex(halflit.UsageError, "^source: .*binary mode"):
                halflit.Scene.load(text)
        with self.assertRaisesRegex(halflit.UsageError, "binary mode"):
            halflit.Scene.load(io.StringIO("solid"))

    def test_pictures_are_written(self):
        picture = halflit.render((CORNERS, FACES), 16)
        for format in ("png", "jpg", "webp", "bmp"):
            file = io.BytesIO()
            picture.save(file, format=format)
            self.assertEqual(file.getvalue(), picture.encode(format))
        file = io.BytesIO()
        picture.save(file)
        self.assertEqual(file.getvalue(), picture.to_png())
        with tempfile.TemporaryDirectory() as folder:
            for name, options, format in (("x.jpg", {}, "jpg"), ("x.part", {"format": "bmp"}, "bmp")):
                path = os.path.join(folder, name)
                picture.save(path, **options)
                with open(path, "rb") as stored:
                    self.assertEqual(stored.read(), picture.encode(format))
                with open(path, "wb") as opened:
                    picture.save(opened, **options)
                with open(path, "rb") as stored:
                    self.assertEqual(stored.read(), picture.encode(format))
            self.assertEqual(sorted(os.listdir(folder)), ["x.jpg", "x.part"])


class Colours(unittest.TestCase):
    def hash_of(self, colors, **options):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES, colors=colors, material={"unlit": True}, **options)
        return scene.render(32).pixel_hash

    def test_vertex_colours_have_a_space(self):
        codes = (np.arange(32).reshape(8, 4) * 8 % 256).astype(np.uint8)
        self.assertEqual(self.hash_of(codes / 255, colors_space="srgb"), self.hash_of(codes))
        self.assertEqual(self.hash_of(codes / 255), self.hash_of(codes, colors_space="linear"))
        self.assertEqual(self.hash_of(codes, colors_space="srgb"), self.hash_of(codes))
        self.assertEqual(self.hash_of(codes[:, :3] / 255, colors_space="srgb"), self.hash_of(codes[:, :3]))
        self.assertNotEqual(self.hash_of(codes), self.hash_of(codes, colors_space="linear"))
        scene = halflit.Scene()
        with self.assertRaisesRegex(halflit.UsageError, "colors_space: expected 'srgb' or 'linear', found 'sRGB'"):
            scene.add_mesh(CORNERS, FACES, colors=codes, colors_space="sRGB")
        with self.assertRaisesRegex(halflit.UsageError, "sRGB values from 0 to 1"):
            scene.add_mesh(CORNERS, FACES, colors=codes.astype(float), colors_space="srgb")
        with self.assertRaisesRegex(halflit.UsageError, "without colors"):
            scene.add_mesh(CORNERS, FACES, colors_space="srgb")

    def test_colours_have_names(self):
        for name, code in (("white", "#ffffff"), ("navy", "#000080"), ("Orange", "#ffa500"), ("grey", "#808080"), ("lime", "#0f0")):
            self.assertEqual(halflit.Material(base_color=name), halflit.Material(base_color=code))
        picture = halflit.Scene().render(4, background="teal")
        self.assertEqual(picture[0, 0].tolist(), [0, 128, 128, 255])
        with self.assertRaisesRegex(halflit.UsageError, "expected a colour"):
            halflit.Material(base_color="whitest")


if __name__ == "__main__":
    unittest.main()
