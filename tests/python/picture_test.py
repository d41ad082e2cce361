"""A picture is a numpy array that keeps what is known about it."""
import copy
import io
import multiprocessing
import os
import pathlib
import pickle
import tempfile
import threading
import unittest

import numpy as np

import halflit


def drawn(size=(40, 30)):
    scene = halflit.Scene.demo()
    return scene.render(size, aovs=["depth", "id"], premultiplied=True, background="transparent", samples=8, shadow_fade=2.0)


class Saved(unittest.TestCase):
    def test_names_may_be_bytes(self):
        picture = drawn()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bild \u00e4.dat")
            for name in (path, os.fsencode(path), pathlib.Path(path)):
                picture.save(name, format="png")
                with open(path, "rb") as file:
                    self.assertEqual(file.read(), picture.to_png())
                os.unlink(path)
            self.assertEqual(os.listdir(folder), [])
        with self.assertRaisesRegex(halflit.UsageError, "path: expected a text or a path"):
            picture.save(3, format="png")

    def test_wrong_places_and_formats_are_named(self):
        picture = halflit.render("demo", (16, 12))
        for call, name in ((lambda: picture.save(io.StringIO()), "path"), (lambda: picture.save(None), "path"),
                           (lambda: picture.save(None, format="png"), "path"), (lambda: picture.encode(None), "format")):
            with self.assertRaisesRegex(halflit.UsageError, f"^{name}: "):
                call()

    def test_a_file_is_whole_whoever_writes_it_and_nothing_else_is_left(self):
        pictures = [np.full((64, 64, 4), shade, np.uint8).view(halflit.Picture) for shade in (10, 200)]
        whole = {picture.encode("bmp") for picture in pictures}
        with tempfile.TemporaryDirectory() as folder:
            path, wrong = os.path.join(folder, "picture"), []

            def write(picture):
                try:
                    for _ in range(100):
                        picture.save(path, format="bmp")
                        with open(path, "rb") as file:
                            if file.read() not in whole:
                                wrong.append("torn")
                except OSError as error:
                    wrong.append(error)

            threads = [threading.Thread(target=write, args=(picture,)) for picture in pictures]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(wrong, [])
            os.mkdir(os.path.join(folder, "taken"))
            with self.assertRaises(OSError):
                pictures[0].save(os.path.join(folder, "taken"), format="png")  # a folder is not replaced
            self.assertEqual(sorted(os.listdir(folder)), ["picture", "taken"])


class Kept(unittest.TestCase):
    def check_equal(self, picture, other):
        self.assertIsInstance(other, halflit.Picture)
        self.assertTrue(np.array_equal(picture, other))
        self.assertEqual(other.report, picture.report)
        self.assertEqual(other.settings, picture.settings)
        self.assertEqual(other.settings["samples"], 8)
        self.assertEqual(other.camera, picture.camera)
        self.assertTrue(other.premultiplied)
        self.assertEqual(list(other.aovs), ["depth", "id"])
        for name, plane in other.aovs.items():
            self.assertTrue(np.array_equal(plane, picture.aovs[name]))
            self.assertIs(type(plane), np.ndarray)

    def test_copies_and_pickles_are_equal(self):
        picture = drawn()
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            self.check_equal(picture, pickle.loads(pickle.dumps(picture, protocol)))
        for other in (picture.copy(), copy.copy(picture), copy.deepcopy(picture)):
            self.check_equal(picture, other)
            other[:] = 0
            other.aovs["depth"][:] = 0
            self.assertGreater(picture.max(), 0)
            self.assertGreater(picture.aovs["depth"].max(), 0)

    @unittest.skipUnless("fork" in multiprocessing.get_all_start_methods(), "no fork")
    def test_pictures_come_from_other_processes(self):
        with multiprocessing.get_context("fork").Pool(1) as pool:
            picture = pool.apply(drawn)
        here = drawn()
        self.assertEqual(picture.pixel_hash, here.pixel_hash)
        picture.report = here.report  # times differ
        self.check_equal(here, picture)

    def test_a_setup_says_that_it_stays(self):
        with self.assertRaisesRegex(TypeError, "cannot be copied or pickled"):
            pickle.dumps(halflit.Scene.demo().setup(16))


class Computed(unittest.TestCase):
    def test_one_number_is_a_number_of_numpy(self):
        picture = drawn()
        plain = np.asarray(picture)
        for name in ("mean", "sum", "min", "max", "std", "var", "argmax", "argmin", "any", "all", "prod", "ptp"):
            found = getattr(picture, name)() if hasattr(picture, name) else getattr(np, name)(picture)
            self.assertNotIsInstance(found, np.ndarray, name)
            self.assertEqual(found, getattr(np, name)(plain), name)
        for function in (np.mean, np.median, np.percentile, np.linalg.norm, np.dot):
            arguments = {np.percentile: (30,), np.dot: (plain.ravel(),)}.get(function, ())
            given = picture.ravel().astype(float) if function in (np.dot, np.linalg.norm) else picture
            found = function(given, *arguments)
            self.assertNotIsInstance(found, halflit.Picture, function)
            self.assertEqual(float(found), float(function(np.asarray(given), *arguments)), function)
        self.assertIsInstance(picture[0, 0, 0], np.uint8)
        self.assertEqual(f"{picture.mean():.1f}", f"{plain.mean():.1f}")

    def test_parts_and_arrays_are_pictures_of_which_nothing_is_known(self):
        picture = drawn()
        for other in (picture[2:9], picture[:, :, :3], picture / 2, picture.mean(axis=2), picture > 3, np.add(picture, 1), picture.ravel()):
            self.assertIsInstance(other, halflit.Picture)
            self.assertEqual((other.report, other.aovs, other.camera, other.settings), ({}, {}, None, {}))
        self.assertTrue(np.array_equal(picture[2:9], np.asarray(picture)[2:9]))
        changed = picture.copy()
        changed += 1  # in place: still the same object
        self.assertEqual(changed.settings["samples"], 8)
        out = np.zeros(picture.shape)
        self.assertIs(np.multiply(picture, 2.0, out=out), out)


if __name__ == "__main__":
    unittest.main()
