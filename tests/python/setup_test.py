"""Camera, light and exposure that are chosen: when they are chosen anew, and what keywords say of them."""
import copy
import unittest
import unittest.mock

import numpy as np

import halflit
from halflit import _c
from support import CAMERA, CORNERS, FACES, TURN, box, moved, program_hash


def cube():
    scene = halflit.Scene()
    scene.add_mesh(CORNERS, FACES)
    return scene


class Measured(unittest.TestCase):
    def test_settings_that_keep_a_share(self):
        scene, found = cube(), None
        scene.add_light("directional", direction=(-1, -2, -1))
        for azimuth in (0, 50):
            found = scene.measure(200, "draft", found, azimuth=azimuth)
        self.assertGreaterEqual(found["percent"], 95)
        self.assertEqual(set(found["settings"]), {"samples", "anisotropy", "shadow_size"})
        full, cheaper = scene.render(200, azimuth=50), scene.render(200, azimuth=50, **found["settings"])
        near = (np.abs(np.asarray(full, int) - np.asarray(cheaper, int)).max(axis=2) <= 8).mean()
        self.assertGreaterEqual(100 * near, 95)
        self.assertEqual(scene.measure(200, (8, 95), azimuth=0), scene.measure(200, "draft", azimuth=0))
        for wrong in ("best", (2, 100), (2,)):
            with self.assertRaises((halflit.Error, ValueError)):
                scene.measure(64, wrong)


class Kept(unittest.TestCase):
    def test_a_light_that_is_refused_changes_no_pixel(self):
        scene = cube()
        first = scene.render(64)
        for wrong in (lambda: scene.set_light(99, halflit.Light()), lambda: scene.set_light(0, halflit.Light()),
                      lambda: scene.add_light("point", range=-1), lambda: scene.set_ambient((float("nan"), 0, 0)),
                      lambda: scene.set_environment("/nowhere.hdr")):  # fmt: skip
            with self.assertRaises(halflit.Error):
                wrong()
            self.assertEqual(scene.render(64).pixel_hash, first.pixel_hash)
        self.assertEqual(scene.counts["lights"], 0)  # those of the studio are not the caller's

    def test_a_setup_of_another_scene_is_refused(self):
        scene, other = cube(), cube()
        other.add_light("point", position=(0, 3, 3), color=(9, 1, 1))
        for made in (other.setup(64), other.setup(64, bounds=[[-2] * 3, [2] * 3])):
            for call in (scene.render, scene.measure):
                with self.assertRaisesRegex(halflit.UsageError, "^setup: expected one of this scene, found one of another"):
                    call(setup=made)
            other.render(setup=made)
            for copied in (copy.copy, copy.deepcopy):
                with self.assertRaisesRegex(TypeError, "cannot be copied"):
                    copied(made)

    def test_an_old_setup_is_not_taken_for_the_scene_as_it_is(self):
        scene, fresh = cube(), cube()
        old = scene.setup(64)
        for made in (scene, fresh):
            made.set_instance(0, moved(3, 2, 0) @ np.diag((2, 1, 1, 1)))
        scene.render(32, azimuth=90)
        scene.render(setup=old)
        self.assertEqual(scene.render(64).pixel_hash, fresh.render(64).pixel_hash)
        scene.render(setup=old)
        self.assertEqual(scene.render(64).pixel_hash, fresh.render(64).pixel_hash)

    def test_the_light_of_a_setup_is_that_of_its_camera(self):
        # The studio is turned with the viewer, so it must not be chosen for a view of the scene as it has become.
        around = {**TURN["animations"][0], "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}
        nodes = [{"mesh": 0}, {"children": [2]}, {"camera": 0, "translation": [0.2, 0.3, 5]}]
        model = box(more={"nodes": nodes, "scenes": [{"nodes": [0, 1]}], "animations": [around], **CAMERA})
        scene = halflit.Scene.load(model, keep_animations=True)
        setup = scene.setup((80, 60))
        first = scene.render(setup=setup)
        scene.pose(time=2)  # the file's camera has gone to another side
        self.assertNotEqual(scene.render((80, 60)).pixel_hash, first.pixel_hash)
        self.assertEqual(scene.render(setup=setup).pixel_hash, first.pixel_hash)
        lamp = halflit.Light(direction=(0, -1, 0))
        index = scene.add_light(lamp)  # so that the studio's share is chosen
        setup, first = scene.setup(64), None
        for _ in range(2):
            scene.set_light(index, lamp)  # takes back the setup's light
            drawn = scene.render(setup=setup)
            first = first or drawn.pixel_hash
            self.assertEqual(drawn.pixel_hash, first)

    def test_frames_of_a_scene_that_stays_choose_once(self):
        nodes = {"nodes": [{"mesh": 0}, {"camera": 0, "translation": [0.2, 0.3, 5]}], **CAMERA}
        scene, called = halflit.Scene.load(box(more=nodes)), []
        call = _c.call
        with unittest.mock.patch.object(_c, "call", lambda name, *more: called.append(name) or call(name, *more)):
            shapes = {scene.render(camera=0).shape for _ in range(3)}
            self.assertEqual(shapes, {(720, 1080, 4)})
            self.assertEqual(called.count("choose_picture"), 1)
            scene.set_instance(0, moved(0, 0.1, 0))
            scene.render(64)
            scene.render(64)
            self.assertEqual(called.count("choose_picture"), 2)


class Keywords(unittest.TestCase):
    def test_exposure_in_stops(self):
        expected = cube().render(64, exposure=2)
        self.assertEqual(cube().render(64, ev=1).pixel_hash, expected.pixel_hash)
        scene = cube()
        self.assertEqual(scene.render(setup=scene.setup(64), ev=1).pixel_hash, scene.render(setup=scene.setup(64), exposure=2).pixel_hash)
        self.assertEqual(scene.setup(64, ev=-1).exposure, 0.5)
        self.assertEqual(halflit.render("demo", (80, 60), ev=0.7).pixel_hash, program_hash("demo", "--size", "80x60", "--exposure", "0.7"))
        self.assertEqual(scene.setup(64, ev="auto-1").exposure, 0.5)
        self.assertEqual(scene.render(setup=scene.setup(64), ev="auto+1").pixel_hash, expected.pixel_hash)
        for keywords, words in (({"ev": 1, "exposure": 2}, "ev: cannot be combined"), ({"ev": float("nan")}, "ev: expected -64 to 64"),
                                ({"ev": "1"}, "ev: expected a number"), ({"ev": "auto+65"}, "ev: expected a number"),
                                ({"exposure": 0}, "exposure: expected a factor above 0"), ({"exposure": "auto+1"}, "ev takes stops")):  # fmt: skip
            with self.assertRaisesRegex(halflit.UsageError, words):
                scene.render(8, **keywords)

    def test_what_a_setup_does_not_keep_is_refused(self):
        scene = cube()
        for name, value in (("samples", 16), ("background", "#f00"), ("setup", None), ("dtype", np.float32)):
            with self.assertRaisesRegex(TypeError, rf"setup\(\) has no keyword '{name}'"):
                scene.setup(8, **{name: value})
        setup = scene.setup(8)
        for name, value in (("azimuth", 90), ("studio", "never"), ("ambient", (1, 1, 1)), ("camera", "frame"), ("studio_turn", 3)):
            with self.assertRaisesRegex(halflit.UsageError, f"setup: cannot be combined with {name}"):
                scene.render(setup=setup, **{name: value})
        self.assertEqual(scene.render(setup=setup, samples=1, azimuth=None).shape, (8, 8, 4))
        with self.assertRaisesRegex(halflit.UsageError, "setup: expected what Scene.setup"):
            scene.render(setup=setup.camera)

    def test_numbers_in_the_place_of_names(self):
        scene = cube()
        self.assertEqual(scene.render(32, studio=1).pixel_hash, scene.render(32, studio="always").pixel_hash)
        self.assertEqual(scene.render(32, studio=2).pixel_hash, scene.render(32, studio="never").pixel_hash)
        for studio, words in ((7, "studio"), ("neverr", "studio: expected one of for_dark"), (1.5, "studio: expected a whole number")):
            with self.assertRaisesRegex(halflit.UsageError, words):
                scene.render(8, studio=studio)

    def test_a_closed_scene_says_so(self):
        scene = cube()
        setup = scene.setup(8)
        scene.render(setup=setup)
        scene.close()
        for call in (lambda: scene.render(8), lambda: scene.render(setup=setup), lambda: scene.setup(8), lambda: scene.frame()):
            with self.assertRaisesRegex(halflit.UsageError, "the scene is closed"):
                call()

    def test_keywords_of_files_are_refused_for_what_is_none(self):
        for source in ((CORNERS, FACES), "demo", cube()):
            for name, value in (("time", 3), ("animation", "x"), ("scene", 0), ("variant", "x"), ("load", {"typo": 1})):
                with self.assertRaisesRegex(TypeError, f"render\\(\\) has no keyword {name} for"):
                    halflit.render(source, 8, **{name: value})
        with self.assertRaisesRegex(halflit.UsageError, "load: time is a keyword of render"):
            halflit.render(box(), 8, load={"time": 1})


class Poses(unittest.TestCase):
    """A camera for all that will be seen."""

    def share(self, picture):
        """Whether something lies on the picture's rim, and the share of its pixels that are drawn."""
        drawn = picture.aovs["id"] > 0
        return drawn[0].any() or drawn[-1].any() or drawn[:, 0].any() or drawn[:, -1].any(), drawn.mean()

    def scene(self, **options):
        scene = halflit.Scene(**options)
        scene.add_mesh(CORNERS, FACES)
        return scene

    def test_every_pose_is_seen_whole(self):
        for up in ("y", "z"):
            for options in ({}, {"azimuth": 80, "elevation": 5}, {"view": "front", "orthographic": True}):
                scene, path = self.scene(up=up), [moved(9 * np.cos(t), 4 * np.sin(t), t) for t in range(6)]
                setup = scene.setup((60, 40), poses=[[matrix] for matrix in path], **options)
                self.assertEqual(scene.instance(0)[1].tolist(), np.eye(4).tolist())  # put back
                for matrix in path:
                    scene.set_instance(0, matrix)
                    on_rim, share = self.share(scene.render(setup=setup, aovs=["id"]))
                    self.assertFalse(on_rim)
                    self.assertGreater(share, 0.001)

    def test_functions_pose(self):
        scene = self.scene()
        by_matrices = scene.setup(50, poses=[[moved(6)], [moved(-6)]])
        by_functions = scene.setup(50, poses=[lambda x=x: scene.set_instance(0, moved(x)) for x in (6, -6)])
        self.assertEqual(scene.instance(0)[1].tolist(), moved(-6).tolist())  # left as the last one poses it
        self.assertEqual(by_functions.camera, by_matrices.camera)

    def test_a_box_is_seen_whole_and_fills_the_picture(self):
        scene = self.scene()
        alone = scene.setup(50, view="front")  # level: without room below for a contact shadow
        of_box = scene.setup(50, bounds=[[-1, -1, -1], [1, 1, 1]], view="front")
        self.assertTrue(np.allclose(of_box.camera.matrix, alone.camera.matrix, atol=1e-5))
        far = scene.setup(50, bounds=[[-1, -1, -1], [1e6, 1, 1]])
        self.assertGreater(np.abs(far.camera.matrix[:3, 3]).max(), 1e5)
        moved_away = self.scene()
        moved_away.set_instance(0, moved(1e5, 0, 0))
        self.assertTrue(np.allclose(moved_away.setup(50, bounds=[[1e5 - 1, -1, -1], [1e5 + 1, 1, 1]], view="front").camera.matrix[:3, 3] - [1e5, 0, 0],
                                    alone.camera.matrix[:3, 3], atol=1e-4))  # fmt: skip

    def test_the_light_is_that_of_the_scene(self):
        scene = self.scene()
        scene.add_light("point", position=(2, 3, 2), color=(8, 8, 7))
        setup = scene.setup(50, poses=[[moved(3)], [moved(-3)]], exposure=0.7)
        self.assertEqual(round(setup.exposure, 6), 0.7)
        picture = scene.render(setup=setup)
        self.assertEqual(picture.pixel_hash, scene.render(50, camera=setup.camera, exposure=0.7).pixel_hash)

    def test_what_is_wrong_is_named(self):
        scene = self.scene()
        for options, said in (
            ({"poses": []}, "poses: expected one"),
            ({"bounds": [1, 2]}, "bounds: expected the least"),
            ({"bounds": [[1, 1, 1], [0, 0, 0]]}, "bounds: expected the least"),
            ({"bounds": [[0, 0, 0], [1, 1, 1]], "camera": np.eye(4)}, "poses, bounds: cannot be combined with camera"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, said):
                scene.setup(8, **options)


if __name__ == "__main__":
    unittest.main()
