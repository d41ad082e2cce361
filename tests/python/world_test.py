"""Models that are far from the origin, tiny or both: all that is given and asked for is in the file's own world."""
import os
import tempfile
import unittest
import warnings

import numpy as np

import halflit
from support import CAMERA, CORNERS, FACES, LAMPS, box, moved, program_hash

FAR = {"translation": [1e6, 0, -3e6]}
TINY = {"scale": [1e-5] * 3}
BOTH = {"translation": [70, 0, 0], "scale": [1e-5] * 3}


class Worlds(unittest.TestCase):
    def setUp(self):
        shown = warnings.catch_warnings()
        shown.__enter__()
        self.addCleanup(shown.__exit__, None, None, None)
        warnings.filterwarnings("ignore", "halflit: the scene")  # that it is drawn elsewhere

    def check_same(self, picture, expected):
        self.assertEqual(picture.pixel_hash, expected.pixel_hash)
        self.assertGreater(picture.report["pixels_visible"], 100)

    def test_cameras_that_were_given_draw_the_same(self):
        for node in (FAR, TINY, BOTH):
            camera = {"nodes": [{"mesh": 0, **node}], **CAMERA}
            scene = halflit.Scene.load(box(more=camera))
            self.assertFalse(scene._world.is_drawn)
            for keywords in ({}, {"azimuth": 0, "elevation": 0}, {"azimuth": 180}):  # some have a position of nearly 0
                first = scene.render(80, **keywords)
                self.check_same(scene.render(80, camera=scene.frame(**{k: float(v) for k, v in keywords.items()})), first)
                self.check_same(scene.render(80, camera=first.camera), first)
                self.check_same(scene.render(80, camera=scene.setup(80, **keywords).camera), first)
                self.check_same(scene.render(setup=scene.setup(80, **keywords)), first)

    def test_cameras_of_the_file(self):
        place = {"camera": 0, "translation": [1e6 + 0.2, 0.3, 5 - 3e6]}
        scene = halflit.Scene.load(box(more={"nodes": [{"mesh": 0, **FAR}, place], **CAMERA}))
        camera = scene.cameras[0]
        self.assertTrue(np.allclose(camera.matrix[:3, 3], place["translation"], rtol=0, atol=1e-5))
        self.assertEqual(camera.name, "front")
        self.check_same(scene.render((90, 60), camera=camera), scene.render((90, 60), camera=0))

    def test_a_view_of_the_bounds(self):
        near, far = halflit.Scene.load(box()), halflit.Scene.load(box(**FAR))
        self.assertEqual(far.bounds.tolist(), [[1e6 - 1, -1, -3e6 - 1], [1e6 + 1, 1, -3e6 + 1]])
        start = np.array(FAR["translation"])
        for offset in ((3, 2, 5), (0.25, 4, -0.125)):
            camera = halflit.Camera.look_at(far.bounds.mean(axis=0) + offset, far.bounds.mean(axis=0))
            self.assertEqual((camera.matrix[:3, 3] - start).tolist(), list(offset))
            expected = near.render(80, camera=halflit.Camera.look_at(offset, (0, 0, 0)))
            self.check_same(far.render(80, camera=camera), expected)
            self.check_same(far.render(80, camera=camera.matrix), expected)

    def test_sizes_of_a_camera(self):
        near, tiny = halflit.Scene.load(box()), halflit.Scene.load(box(**TINY))
        flat = {"orthographic": True, "half_height": 2, "near_z": 0.5, "far_z": 9}
        expected = near.render(80, camera=halflit.Camera.look_at((0, 0, 4), (0, 0, 0), **flat), aovs="id")
        for name in ("half_height", "near_z", "far_z"):
            flat[name] *= 1e-5
        given = tiny.render(80, camera=halflit.Camera.look_at((0, 0, 4e-5), (0, 0, 0), **flat), aovs="id")
        self.assertEqual(given.aovs["id"].tolist(), expected.aovs["id"].tolist())
        self.assertAlmostEqual(given.camera.half_height * 1e5, 2, places=5)

    def test_instances(self):
        scene = halflit.Scene.load(box(**FAR))
        first = scene.render(80)
        mesh, matrix = scene.instance(0)
        self.assertEqual(matrix.tolist(), moved(*FAR["translation"]).tolist())
        scene.set_instance(0, matrix)
        self.check_same(scene.render(80), first)
        scene.add_instance(mesh, matrix @ moved(3, 0, 0))
        self.assertEqual(scene.bounds[1].tolist(), [1e6 + 4, 1, -3e6 + 1])
        scene.add_mesh(CORNERS, FACES, matrix=matrix @ moved(6, 0, 0))
        self.assertEqual(scene.bounds[1].tolist(), [1e6 + 7, 1, -3e6 + 1])
        tiny = halflit.Scene.load(box(**TINY))
        tiny.add_mesh(CORNERS * 1e-5, FACES, matrix=moved(4e-5, 0, 0))
        self.assertTrue(np.allclose(tiny.bounds, [[-1e-5, -1e-5, -1e-5], [5e-5, 1e-5, 1e-5]], rtol=1e-6))

    def test_lights(self):
        lamp = {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1e6 + 3, 4, 2 - 3e6]}
        scene = halflit.Scene.load(box(more={"nodes": [{"mesh": 0, **FAR}, lamp], **LAMPS}))
        first, light = scene.render(80), scene.light(0)
        self.assertEqual(list(light.position), lamp["translation"])
        scene.set_light(0, light)
        self.check_same(scene.render(80), first)
        near = halflit.Scene.load(box(more={"nodes": [{"mesh": 0}, {**lamp, "translation": [3, 4, 2]}], **LAMPS}))
        for made, start in ((scene, (1e6, 0, -3e6)), (near, (0, 0, 0))):
            light = made.light(0)
            light.range, light.position = 9, np.add(start, (2, 3, 3))
            made.set_light(0, light)
            made.add_light("point", position=np.add(start, (-2, 3, 3)), shadow_radius=0.1)
        self.check_same(scene.render(80), near.render(80))

    def test_positions_are_doubles_as_the_programs_are(self):
        # As float32 the position would be 1000000, the radius of the light half of its distance.
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "far.glb")
        with open(path, "wb") as file:
            file.write(box(**FAR))
        light = halflit.Light("point", position=(1000001.53, 0.2, -2999998.41), color=(1, 1, 1))
        self.assertEqual(light.position, (1000001.53, 0.2, -2999998.41))
        flags = ("--size", "80", "--light", "point:pos=1000001.53,0.2,-2999998.41:intensity=1")
        self.assertEqual(halflit.render(path, 80, lights=[light]).pixel_hash, program_hash(path, *flags))
        camera = halflit.Camera(moved(1e6 + 0.01, 0, 5 - 3e6))
        self.assertEqual(camera.copy().matrix[0, 3], 1e6 + 0.01)

    def test_cameras_by_points_are_those_of_the_program(self):
        eye, target = np.array((0.1, 0.7, 3.3)), np.array((0.05, 0.1, 0))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "box.glb")
        for node, start, size in (({}, (0, 0, 0), 1), (FAR, FAR["translation"], 1), (TINY, (0, 0, 0), 1e-5)):
            with open(path, "wb") as file:
                file.write(box(**node))
            points = [(point * size + start).tolist() for point in (eye, target)]
            words = [",".join(map(repr, point)) for point in points]
            expected = program_hash(path, "--size", "100", "--camera-position", words[0], "--camera-target", words[1])
            camera = halflit.Camera.look_at(*points, fov_y_rad=np.radians(35), near_z=0.1 * size)
            self.assertEqual(halflit.render(path, 100, camera=camera).pixel_hash, expected, node)

    def test_lengths_of_settings(self):
        tiny = halflit.Scene.load(box(**TINY))
        self.assertAlmostEqual(tiny.render(8, shadow_fade=2e-5).settings["shadow_fade"], 2e-5, places=11)

    def test_arrays_far_from_the_origin_are_told(self):
        far = CORNERS.astype(float) + (1e6, 0, 0)
        with self.assertWarnsRegex(UserWarning, "float32 rounds them to steps of 0.0625.*move them to the origin") as told:
            halflit.Scene().add_mesh(far * (1, 0.99, 0.99), FACES)
        self.assertEqual(told.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for vertices in (far, far.astype(np.float32), CORNERS * 1e6 + (1e6, 0, 0), CORNERS.tolist()):
                halflit.Scene().add_mesh(vertices, FACES)  # nothing is lost


if __name__ == "__main__":
    unittest.main()
