"""Many pictures at once are those that are drawn one by one."""
import os
import signal
import threading
import time
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, moved

VIEWS = [(30 * i, 10 + i) for i in range(6)]


def meshes(count):
    random = np.random.default_rng(3)
    return [((CORNERS * random.uniform(0.1, 9, 3) + random.uniform(-2, 2, 3)).astype(np.float32), FACES) for _ in range(count)]


class Batches(unittest.TestCase):
    def test_pictures_that_are_drawn_ahead_are_the_same(self):
        scene = halflit.Scene.demo()
        expected = [picture.pixel_hash for picture in scene.render_batch(VIEWS, 48)]
        for ahead in (1, 3, 20):
            self.assertEqual([picture.pixel_hash for picture in scene.render_batch(VIEWS, 48, ahead=ahead)], expected)

    def test_the_next_picture_is_drawn_while_the_last_is_used(self):
        begun = threading.Event()
        batch = halflit.Scene.demo().render_batch(VIEWS, 48, ahead=1, progress=lambda share: begun.set())
        next(batch)
        begun.wait(60)
        begun.clear()
        next(batch)
        self.assertTrue(begun.wait(60))  # nobody has asked for the third
        batch.close()

    def test_an_error_is_raised_and_the_rest_is_not_drawn(self):
        shares = []
        batch = halflit.Scene.demo().render_batch([(0, 20), np.zeros((4, 4)), (90, 20)], 32, ahead=2, progress=shares.append)
        self.assertEqual(next(batch).shape, (32, 32, 4))
        with self.assertRaisesRegex(halflit.UsageError, "matrix"):
            next(batch)
        self.assertEqual(shares.count(1.0), 1)

    def test_ctrl_c_ends_a_picture_that_is_drawn_ahead(self):
        scene = halflit.Scene.demo()
        scene.render((1600, 900), samples=16, threads=1)
        start = time.perf_counter()
        scene.render((1600, 900), samples=16, threads=1)
        alone = time.perf_counter() - start
        batch, sent = scene.render_batch(VIEWS, (1600, 900), ahead=2, samples=16, threads=1), []
        next(batch)

        def interrupt():
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(0.2 * alone, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in batch:
                pass
        took = time.perf_counter() - sent[0]
        timer.join()
        print(f"Ctrl-C took effect after {1000 * took:.1f} ms, a frame takes {1000 * alone:.0f} ms")
        self.assertLess(took, 0.4 * alone)

    def test_arrays_are_the_pictures(self):
        scene = halflit.Scene.demo()
        names = ["depth", "id", "view_normal", "ray"]
        arrays = scene.render_arrays(VIEWS, (40, 30), aovs=names, dtype=np.float32)
        self.assertEqual({name: array.shape for name, array in arrays.items()},
                         {"color": (6, 30, 40, 4), "depth": (6, 30, 40), "id": (6, 30, 40), "view_normal": (6, 30, 40, 3),
                          "ray": (6, 30, 40)})  # fmt: skip
        for i, picture in enumerate(scene.render_batch(VIEWS, (40, 30), aovs=names, dtype=np.float32)):
            self.assertTrue(np.array_equal(arrays["color"][i], picture))
            for name in names:
                self.assertTrue(np.array_equal(arrays[name][i], picture.aovs[name]), name)
        with self.assertRaisesRegex(halflit.UsageError, "one or more"):
            scene.render_arrays([], 8)


class Meshes(unittest.TestCase):
    def test_the_pictures_of_many_meshes_are_those_of_each(self):
        given = meshes(30)
        for options in ({}, {"azimuth": 70, "zoom": 0.8}, {"view": "top", "orthographic": True}, {"samples": 1, "exposure": 0.5}):
            expected = [halflit.render(mesh, (40, 30), **options).pixel_hash for mesh in given]
            for threads in (0, 1, 3):
                drawn = halflit.render_meshes(iter(given), (40, 30), threads=threads, **options)
                self.assertEqual([picture.pixel_hash for picture in drawn], expected)
        self.assertGreater(len(set(expected)), 25)

    def test_meshes_have_colours_and_a_material(self):
        colors = np.linspace(0, 255, 24).reshape(8, 3).astype(np.uint8)
        given = [{"vertices": vertices, "faces": faces, "colors": colors} for vertices, faces in meshes(5)]
        drawn = list(halflit.render_meshes(given, 32, material={"unlit": True}, aovs=["id"]))
        for mesh, picture in zip(given, drawn):
            scene = halflit.Scene()
            scene.add_mesh(**mesh, material={"unlit": True})
            self.assertEqual(picture.pixel_hash, scene.render(32).pixel_hash)
            self.assertEqual(set(np.unique(picture.aovs["id"])), {0, 1})

    def test_open_meshes_points_and_lines_are_those_of_each_too(self):
        # Next to each other: closed meshes, single sides that face away, points of another size and lines.
        random, given = np.random.default_rng(5), []
        quad = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        for i in range(24):
            turned = np.linalg.qr(random.normal(size=(3, 3)))[0].astype(np.float32)
            kinds = ({"vertices": quad @ turned, "faces": [[0, 1, 2], [0, 2, 3]]},
                     {"vertices": random.normal(size=(4 ** (1 + i % 5), 3)), "topology": "points"},
                     {"vertices": CORNERS @ turned * (1 + i), "faces": FACES, "normals": CORNERS @ turned},
                     {"vertices": quad @ turned, "topology": "lines", "matrix": moved(i, 2)},
                     {"vertices": CORNERS * np.float32(0.1) ** i, "faces": FACES})  # fmt: skip
            given.append(kinds[i % 5])
        for material in (None, {"base_color": (0.8, 0.2, 0.1), "double_sided": False}):
            expected = []
            for mesh in given:
                scene = halflit.Scene()
                scene.add_mesh(**mesh, material=material)
                expected.append(halflit.render(scene, 40, aovs=["material"]))
            for threads in (1, 2, 1):
                drawn = list(halflit.render_meshes(given, 40, threads=threads, material=material, aovs=["material"]))
                self.assertEqual([picture.pixel_hash for picture in drawn], [picture.pixel_hash for picture in expected])
                for one, other in zip(drawn, expected):
                    self.assertTrue(np.array_equal(one.aovs["material"], other.aovs["material"]))
                    self.assertTrue(np.array_equal(one.camera.matrix, other.camera.matrix))
        with self.assertRaisesRegex(TypeError, "no 'place' of its own"):
            list(halflit.render_meshes([{**given[0], "place": False}], 8))

    def test_ctrl_c_ends_the_pictures_of_meshes(self):
        options = {"samples": 16, "threads": 2}
        alone = time.perf_counter()
        for _ in halflit.render_meshes(meshes(2), (3000, 3000), **options):
            pass
        alone, sent, before = time.perf_counter() - alone, [], signal.getsignal(signal.SIGINT)

        def interrupt():
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(0.3 * alone, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            list(halflit.render_meshes(meshes(100), (3000, 3000), **options))
        took = time.perf_counter() - sent[0]
        timer.join()
        print(f"Ctrl-C took effect after {1000 * took:.1f} ms, two meshes take {1000 * alone:.0f} ms")
        self.assertLess(took, 0.5 * alone)
        self.assertIs(signal.getsignal(signal.SIGINT), before)

    def test_ctrl_c_does_not_end_meshes_that_another_thread_waits_for(self):
        given = meshes(6)
        expected, drawn, begun = [picture.pixel_hash for picture in halflit.render_meshes(given, 400)], [], threading.Event()

        def draw():
            for picture in halflit.render_meshes(given, 400, threads=2, progress=lambda share: begun.set()):
                drawn.append(picture.pixel_hash)

        thread = threading.Thread(target=draw)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            begun.wait(60)
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1)
        thread.join()
        self.assertEqual(drawn, expected)

    def test_meshes_are_read_as_pictures_are_asked_for(self):
        read = []

        def source():
            for mesh in meshes(100):
                read.append(1)
                yield mesh

        drawn = halflit.render_meshes(source(), 16, threads=2)
        self.assertEqual(len(read), 0)
        next(drawn)
        self.assertLess(len(read), 20)
        drawn.close()

    def test_a_wrong_mesh_is_refused(self):
        drawn = halflit.render_meshes([*meshes(2), (CORNERS, FACES + 8)], 16, threads=1)
        self.assertEqual(next(drawn).shape, (16, 16, 4))
        next(drawn)
        with self.assertRaisesRegex(halflit.UsageError, "mesh 2: faces: vertex 15"):
            next(drawn)
        with self.assertRaisesRegex(TypeError, "no keyword 'camera'"):
            halflit.render_meshes([], 16, camera=np.eye(4))

    def test_what_is_no_mesh_is_named(self):
        (corners, faces), *_ = meshes(1)
        for given, said in (
            ([3], "mesh 0: expected .vertices, faces., Splats or a dict of arguments of add_mesh.., found 3"),
            ([(corners, faces), None], "mesh 1: expected .*, found None"),
            ([(corners, faces, 1)], "mesh 0: expected .vertices, faces."),
            (["ab"], "mesh 0: expected .*, found 'ab'"),
            ([corners], "mesh 0: expected"),
            ([{"faces": faces}], "mesh 0: expected vertices"),
            ([{"vertices": corners, "faces": faces, "matrix": 3}], "mesh 0: matrix: "),
            ("ab", "meshes: expected an iterable"),
            ({"vertices": corners}, "meshes: expected an iterable"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, "^" + said):
                list(halflit.render_meshes(given, 8, threads=1))
        for name in ("colour", "place", 3):
            with self.assertRaisesRegex(TypeError, f"mesh 0: has no {name!r}"):
                list(halflit.render_meshes([{"vertices": corners, "faces": faces, name: 1}], 8))


if __name__ == "__main__":
    unittest.main()
