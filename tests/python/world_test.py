"""All that is given and asked for has the file's coordinates: of models that are far from the origin, tiny or both, or have z up."""
import json
import os
import subprocess
import tempfile
import unittest
import warnings
import zipfile

import numpy as np

import halflit
from support import CAMERA, CORNERS, FACES, LAMPS, PROGRAM, box, moved, program_hash, program_json, stl

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

    def test_the_place_of_a_removed_mesh_has_no_size_left(self):
        scene = halflit.Scene()
        instance = scene.add_file(stl(CORNERS[FACES] * 1e-30))
        mesh = scene.instance(instance[0])[0]
        for one in instance:
            scene.remove_instance(one)
        scene.remove_mesh(mesh)
        self.assertEqual(scene.add_mesh(CORNERS, FACES), mesh)
        self.assertEqual(scene.bounds.tolist(), [[-1, -1, -1], [1, 1, 1]])
        scene.set_mesh(mesh, CORNERS * 2, FACES)
        self.assertEqual(scene.bounds.tolist(), [[-2, -2, -2], [2, 2, 2]])

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

    def test_files_with_z_up_have_their_own_coordinates(self):
        # A box of 1 x 2 x 3: as an STL file, whose z points up by custom, as arrays, and as a file that says so.
        corners, folder = (CORNERS + 1) / 2 * (1, 2, 3), tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "box.stl")
        with open(path, "wb") as file:
            file.write(stl(corners))
        arrays = halflit.Scene(up="z")
        arrays.add_mesh(corners[FACES.astype(int)].reshape(-1, 3))
        scenes = [halflit.Scene.load(path), arrays, halflit.Scene.load(path, up="y"), halflit.Scene.load(path, up="-x")]
        self.assertEqual([scene.up for scene in scenes], ["z", "z", "y", "-x"])
        for scene in scenes:
            self.assertEqual(scene.bounds.tolist(), [[0, 0, 0], [1, 2, 3]])
            self.assertEqual(scene.instance(0)[1].tolist(), np.eye(4).tolist())
        camera = halflit.Camera.look_at((5, 3, 2), (0.5, 1, 1.5), up="z")
        light = halflit.Light("point", position=(4, -2, 5), color=(20, 20, 20))
        drawn = []
        for scene in scenes:
            scene.add_light(light)
            drawn.append(scene.render(64, camera=camera, samples=1, studio="never", aovs="all"))
            found = scene.light(0)
            self.assertEqual((found.position, found.color), (light.position, light.color))
        first = drawn[0]
        for one in drawn[1:]:
            self.assertEqual(one.camera.matrix.tolist(), camera.matrix.tolist())
            for name in ("id", "depth", "ray", "position", "normal", "vertex_normal", "view_normal"):
                # Turned axes change the order of three products in a sum: float32 in a scene of size 4.
                self.assertLess(np.abs(np.nan_to_num(one.aovs[name] - 1.0 * first.aovs[name])).max(), 2e-6, name)
        seen = first.aovs["id"] > 0
        self.assertGreater(seen.sum(), 500)
        axis, eye = -camera.matrix[:3, 2], camera.matrix[:3, 3]
        along = (first.aovs["position"][seen] - eye) @ axis
        self.assertLess(np.abs(along - first.aovs["depth"][seen]).max(), 1e-5)

    def test_named_views_go_by_up(self):
        # From the top of z, a disc of radius 20 and height 4 fills more than from its side.
        turn = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        rim = np.stack([20 * np.cos(turn), 20 * np.sin(turn)], axis=1)
        points = np.concatenate([np.pad(rim, ((0, 0), (0, 1)), constant_values=z) for z in (-2, 2)] + [[[0, 0, -2]], [[0, 0, 2]]])
        i, j = np.arange(60), (np.arange(60) + 1) % 60
        fans = ((i, j, j + 60), (i, j + 60, i + 60), (j, i, i * 0 + 120), (i + 60, j + 60, i * 0 + 121))
        faces = np.concatenate([np.stack(one, axis=1) for one in fans])
        share = lambda picture: (np.asarray(picture)[..., 3] > 0).mean()
        keywords = {"view": "top", "background": "transparent", "contact_shadow": 0}
        from_z, from_y = (share(halflit.render((points, faces), 64, up=up, **keywords)) for up in ("z", "y"))
        self.assertEqual(share(halflit.render(stl(points[faces].reshape(-1, 3)), 64, **keywords)), from_z)
        self.assertGreater(from_z, 3 * from_y)

    def test_planes_of_the_program_have_the_files_coordinates(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path, report = os.path.join(folder.name, "box.stl"), os.path.join(folder.name, "report.json")
        with open(path, "wb") as file:
            file.write(stl((CORNERS + 1) / 2 * (1, 2, 3)))
        told = program_json("info", path, "--json")
        self.assertEqual(told["bounds"], {"min": [0, 0, 0], "max": [1, 2, 3]})
        self.assertEqual([told["measures"][end] for end in ("min", "max")], [[0, 0, 0], [1, 2, 3]])
        flags = ("--size", "80x60", "--view", "iso", "--samples", "1", "--background", "transparent", "--contact-shadow", "0")
        subprocess.run([PROGRAM, path, *flags, "-o", os.path.join(folder.name, "x.png"), "--report", report, "--quiet"], check=True)
        with open(report, encoding="utf-8") as file:
            said = json.load(file)
        k, r, t = (np.array(said["camera"][name]) for name in "krt")
        camera = halflit.Camera.from_intrinsics(k, (80, 60), r, t, first_pixel=0.5, near_z=said["camera"]["near"])
        scene = halflit.Scene.load(path)
        picture = scene.render((80, 60), camera=camera, samples=1, background="transparent", contact_shadow=0)
        expected = scene.render((80, 60), view="iso", samples=1, background="transparent", contact_shadow=0)
        self.assertEqual(expected.pixel_hash, said["pixel_hash"])
        self.assertTrue(np.array_equal(np.asarray(picture)[..., 3], np.asarray(expected)[..., 3]))

    def test_coordinates_of_3mf_are_in_its_unit(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ("a.3mf", "b.3mf")]
            for path, unit, size in zip(paths, ("millimeter", "inch"), (1, 1 / 25.4)):
                points = "".join('<vertex x="%.9g" y="%.9g" z="%.9g"/>' % tuple(p * size + 0) for p in CORNERS)
                faces = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(f) for f in FACES)
                mesh = f"<mesh><vertices>{points}</vertices><triangles>{faces}</triangles></mesh>"
                with zipfile.ZipFile(path, "w") as file:
                    file.writestr("[Content_Types].xml", "<Types/>")
                    file.writestr("3D/3dmodel.model", f'<model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
                                  f'<resources><object id="1">{mesh}</object></resources><build><item objectid="1"/></build></model>')  # fmt: skip
            info = program_json("info", paths[0], "--json")
            self.assertEqual((info["bounds"]["min"], info["bounds"]["max"]), ([-1, -1, -1], [1, 1, 1]))
            self.assertEqual((info["measures"]["unit"], info["measures"]["max"]), ("mm", [1, 1, 1]))
            self.assertEqual(halflit.Scene.load(paths[0]).bounds.tolist(), [[-1, -1, -1], [1, 1, 1]])
            found = program_json("compare", *paths, "--json", "-")
            self.assertEqual((found["unit"], found["differs"]), ("mm", False))

    def test_flags_are_in_the_files_coordinates(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "box.stl")
        with open(path, "wb") as file:
            file.write(stl((CORNERS + 1) / 2 * (1, 2, 3)))
        words = ("--size", "64", "--camera-position", "5,3,2", "--camera-target", "0.5,1,1.5", "--light", "point:pos=4,-2,5:intensity=20")
        camera = halflit.Camera.look_at((5, 3, 2), (0.5, 1, 1.5), up="z", fov_y_rad=np.radians(35))
        light = halflit.Light("point", position=(4, -2, 5), color=(20, 20, 20))
        self.assertEqual(halflit.render(path, 64, camera=camera, lights=[light]).pixel_hash, program_hash(path, *words))

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
