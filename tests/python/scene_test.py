"""Scenes from numpy arrays: what is handed over, what is drawn, what is refused."""
import copy
import errno
import json
import os
import pathlib
import pickle
import tempfile
import unittest
import warnings

import numpy as np

import halflit
from support import CORNERS, FACES, LAMPS, TURN, box, moved, stl


def render(scene, **keywords):
    return scene.render((80, 60), **keywords)


class Arrays(unittest.TestCase):
    def test_the_same_from_every_type_of_array(self):
        first = halflit.render((CORNERS, FACES), (80, 60))
        self.assertEqual((first.shape, first.dtype), ((60, 80, 4), np.uint8))
        for vertices, faces in (
            (CORNERS.astype(np.float64), FACES.astype(np.int64)),
            (CORNERS.tolist(), FACES.tolist()),
            (np.asfortranarray(CORNERS), FACES.astype(np.int32)),
            (CORNERS, FACES.ravel()),
            (CORNERS[FACES.ravel()], None),
        ):
            self.assertEqual(halflit.render((vertices, faces), (80, 60)).pixel_hash, first.pixel_hash)

    def test_float32_and_int32_are_not_copied(self):
        from halflit import _arrays

        for array in (CORNERS, CORNERS[2:6]):
            self.assertIs(_arrays.floats(array, 3, "x").base, array.base)
            self.assertEqual(_arrays.floats(array, 3, "x").ctypes.data, array.ctypes.data)
        for kind in (np.uint32, np.int32):
            faces = FACES.astype(kind)
            self.assertEqual(_arrays.indices(faces, 3, len(CORNERS)).ctypes.data, faces.ctypes.data)
        texture = np.zeros((8, 16, 4), np.uint8)[:, :5]
        self.assertEqual(_arrays.rgba8(texture).ctypes.data, texture.ctypes.data)

    def test_large_arrays_are_read_and_may_be_freed(self):
        scene = halflit.Scene()
        for _ in range(3):
            vertices = np.random.default_rng(1).random((300000, 3), np.float32)
            mesh = scene.add_mesh(vertices)
            del vertices
        first = render(scene)
        self.assertEqual(scene.counts["triangles"], 300000)
        scene.set_vertices(mesh, np.random.default_rng(1).random((300000, 3), np.float32))
        self.assertEqual(render(scene).pixel_hash, first.pixel_hash)

    def test_normals(self):
        flat, smooth, given = halflit.Scene(), halflit.Scene(), halflit.Scene()
        flat.add_mesh(CORNERS, FACES)
        smooth.add_mesh(CORNERS, FACES, normals="smooth")
        given.add_mesh(CORNERS, FACES, normals=CORNERS)  # those of a ball
        hashes = [render(scene).pixel_hash for scene in (flat, smooth, given)]
        self.assertEqual(len(set(hashes)), 3)
        # On a closed and symmetric body smooth normals are those of the ball, but for the weights of the faces.
        seen = render(smooth, aovs=["normal", "position"]).aovs
        drawn = np.linalg.norm(seen["normal"], axis=2) > 0
        place = seen["position"][drawn] / np.linalg.norm(seen["position"][drawn], axis=1, keepdims=True)
        self.assertGreater((seen["normal"][drawn] * place).sum(axis=1).min(), 0.9)

    def test_vertex_colours(self):
        linear, codes, short = halflit.Scene(), halflit.Scene(), halflit.Scene()
        colors = (np.arange(32).reshape(8, 4) * 8 % 256).astype(np.uint8)
        colors[:, 3] = 255
        as_light = np.where(colors / 255 <= 0.04045, colors / 255 / 12.92, ((colors / 255 + 0.055) / 1.055) ** 2.4)
        as_light[:, 3] = 1
        linear.add_mesh(CORNERS, FACES, colors=as_light)
        codes.add_mesh(CORNERS, FACES, colors=colors)
        short.add_mesh(CORNERS, FACES, colors=colors[:, :3])
        hashes = {render(scene).pixel_hash for scene in (linear, codes, short)}
        self.assertEqual(len(hashes), 1)
        self.assertNotEqual(hashes, {halflit.render((CORNERS, FACES), (80, 60)).pixel_hash})

    def test_texture_shows_its_texels(self):
        # An unlit square that fills the view shows the texture's four colours in their places, without a tone curve bit for bit.
        texture = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [90, 120, 30]]], np.uint8)
        square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
        camera = halflit.Camera(orthographic=True, half_height=1, near_z=0, far_z=10)
        camera.matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]
        scene = halflit.Scene()
        index = scene.add_texture(texture)
        use = halflit.TextureUse(index, mag_filter="nearest", min_filter="nearest", mip_filter="none", wrap_u="clamp", wrap_v="clamp")
        scene.add_mesh(square, [[0, 1, 2], [0, 2, 3]], uv=uv, material={"base_color_texture": use, "unlit": True})
        picture = scene.render(4, camera=camera, tone_curve="none", exposure=1)
        self.assertEqual(picture[::3, ::3, :3].tolist(), texture.tolist())
        scene.set_texture(index, texture[::-1])
        self.assertEqual(scene.render(4, camera=camera, tone_curve="none", exposure=1)[::3, ::3, :3].tolist(), texture[::-1].tolist())

    def test_points_and_lines(self):
        for topology, faces in (("points", [0, 1, 2]), ("lines", [[0, 1], [2, 3]]), ("points", None)):
            scene = halflit.Scene()
            scene.add_mesh(CORNERS, faces, topology=topology, material={"unlit": True})
            picture = render(scene, point_size=5, line_width=3)
            self.assertGreater(picture.report["pixels_visible"], 10, topology)

    def test_points_and_lines_without_a_material_have_their_own_colours(self):
        # As those of files: no side of them faces a light. What has normals is lit.
        colors = np.full((8, 3), (200, 100, 50), np.uint8)
        options = {"point_size": 9, "line_width": 9, "tone_curve": "none", "samples": 1, "edl": "off"}
        for topology, faces in (("points", np.arange(8)), ("lines", [[0, 7], [1, 6]])):
            given = {"vertices": CORNERS, "faces": faces, "topology": topology, "colors": colors}
            added, replaced, lit = halflit.Scene(), halflit.Scene(), halflit.Scene()
            added.add_mesh(**given)
            replaced.add_mesh(CORNERS, FACES)
            replaced.set_mesh(0, **given)
            lit.add_mesh(**given, normals=CORNERS)
            picture = render(added, **options)
            shown = {tuple(color) for color in picture[picture.any(axis=2)].tolist()} - {tuple(picture[0, 0].tolist())}
            self.assertEqual(shown, {(200, 100, 50, 255)}, topology)
            self.assertEqual(render(replaced, **options).pixel_hash, picture.pixel_hash)
            self.assertNotEqual(render(lit, **options).pixel_hash, picture.pixel_hash)
            replaced.set_mesh(0, CORNERS, FACES)
            added = halflit.Scene()
            added.add_mesh(CORNERS, FACES)
            self.assertEqual(render(replaced, **options).pixel_hash, render(added, **options).pixel_hash)

    def test_what_is_wrong_is_refused(self):
        scene = halflit.Scene()
        for arguments, words in (
            ((CORNERS[:, :2], FACES), r"vertices: expected an array of shape \(n, 3\), found \(8, 2\)"),
            ((CORNERS, FACES[:, :2]), r"faces: expected an array of shape \(n, 3\)"),
            ((CORNERS, FACES.astype(float)), "faces: expected whole numbers"),
            ((CORNERS, FACES.astype(int) - 1), "faces: vertex -1, expected 0 to 7"),
            ((CORNERS, FACES.astype(int) + 2**32), r"faces: vertex \d+, expected 0 to 7"),
            ((CORNERS[:5], FACES), "faces: vertex 7, expected 0 to 4: the number of vertices is 5"),
            ((CORNERS, FACES.ravel()[:35]), "faces: 35 corners"),
            ((CORNERS, None), "vertices: 8 without faces, expected 3"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                scene.add_mesh(*arguments)
        for keywords, words in (
            ({"normals": CORNERS[:3]}, "normals: 3 rows"),
            ({"normals": "soft"}, "normals: expected"),
            ({"uv": CORNERS}, "uv: expected"),
            ({"colors": CORNERS[:, :2]}, "colors: expected"),
            ({"normals": CORNERS * np.nan}, "normals: row 0 is not finite"),
            ({"uv": np.full((8, 2), 1e300)}, r"uv: row 0 is not finite in float32: \[inf, inf\]"),
            ({"material": 3}, "material"),
            ({"material": {"shine": 3}}, "Material has no member shine"),
            ({"topology": "quads"}, "topology: expected one of triangles"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, words):
                scene.add_mesh(CORNERS, FACES, **keywords)
        with self.assertRaisesRegex(halflit.UsageError, "faces: vertex 9"):
            scene.add_mesh(CORNERS, [[0, 1, 9]], normals="smooth")
        with self.assertRaisesRegex(halflit.UsageError, "texture"):
            scene.add_texture(np.zeros((4, 4, 4)))
        self.assertEqual(scene.counts["meshes"], 0)


    def test_a_mesh_that_is_refused_leaves_nothing(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        before = scene.counts
        paint = {"base_color": (1, 0, 0)}
        for arguments in ({"matrix": np.eye(3)}, {"faces": FACES + 1}, {"faces": FACES.ravel()[:35]}, {"colors": CORNERS * np.nan},
                          {"normals": CORNERS[:2]}, {"name": "a\0"}, {"topology": "lines"}):  # fmt: skip
            with self.assertRaises(halflit.UsageError):
                scene.add_mesh(CORNERS, **{"faces": FACES, "material": paint, **arguments})
            self.assertEqual(scene.counts, before, arguments)
        for index in (5, -1, "x"):
            with self.assertRaisesRegex(halflit.UsageError, "mesh"):
                scene.set_mesh(index, CORNERS, FACES, material=paint)
        self.assertEqual(scene.counts, before)

    def test_a_mesh_is_replaced(self):
        scene = halflit.Scene()
        red, blue = {"base_color": (1, 0, 0)}, {"base_color": (0, 0, 1)}
        mesh = scene.add_mesh(CORNERS, FACES, material=red)
        first, materials = render(scene).pixel_hash, scene.counts["materials"]
        scene.set_mesh(mesh, CORNERS / 2, FACES)
        scene.set_mesh(mesh, CORNERS, FACES)  # it has kept its material
        self.assertEqual(render(scene).pixel_hash, first)
        for _ in range(5):
            scene.set_mesh(mesh, CORNERS, FACES, material=blue)
        self.assertEqual(scene.counts["materials"], materials)
        self.assertEqual(render(scene).pixel_hash, cube_of(blue).pixel_hash)
        shared = scene.add_material(red)
        scene.set_mesh(mesh, CORNERS, FACES, material=shared)
        scene.set_mesh(mesh, CORNERS, FACES, material=blue)  # others may use the shared one
        self.assertEqual(scene.material(shared), halflit.Material(**red))
        with self.assertRaisesRegex(halflit.UsageError, "material: expected one, as mesh 0 was not added"):
            halflit.Scene.load(box()).set_mesh(0, CORNERS, FACES)

    def test_smooth_normals_follow_the_vertices(self):
        squeezed = CORNERS * np.float32((0.3, 1, 1.5))
        fresh = halflit.Scene()
        fresh.add_mesh(squeezed, FACES, normals="smooth")
        for normals in (None, "smooth"):
            scene, faces = halflit.Scene(), FACES.copy()
            mesh = scene.add_mesh(CORNERS, faces, normals="smooth")
            faces[:] = 0  # the caller's
            scene.set_vertices(mesh, squeezed, normals=normals)
            self.assertEqual(render(scene).pixel_hash, render(fresh).pixel_hash)
        scene.set_vertices(mesh, squeezed, normals=CORNERS)
        given = render(scene).pixel_hash
        scene.set_vertices(mesh, squeezed)  # keeps those
        self.assertEqual(render(scene).pixel_hash, given)
        for made, normals in ((scene, "smooth"), (fresh, "soft")):
            with self.assertRaisesRegex(halflit.UsageError, 'normals: expected an array, or "smooth" for a mesh that was added so'):
                made.set_vertices(0, squeezed, normals=normals)
        with self.assertRaisesRegex(halflit.UsageError, "5 vertices, expected 8"):
            fresh.set_vertices(0, squeezed[:5])

    def test_textures_of_one_to_four_channels(self):
        grey = np.random.default_rng(2).integers(0, 255, (4, 4, 1), dtype=np.uint8)
        half = np.full_like(grey, 128)
        solid = np.full_like(grey, 255)
        hashes = []
        for pixels in (grey, grey[:, :, 0], np.repeat(grey, 3, axis=2), np.concatenate([grey, solid], axis=2),
                       np.concatenate([grey, grey, grey, solid], axis=2), np.concatenate([grey, half], axis=2)):  # fmt: skip
            scene = halflit.Scene()
            material = {"base_color_texture": scene.add_texture(pixels), "alpha_mode": "blend"}
            scene.add_mesh(CORNERS, FACES, uv=CORNERS[:, :2], material=material)
            hashes.append(render(scene).pixel_hash)
        self.assertEqual(len(set(hashes[:5])), 1)
        self.assertNotEqual(hashes[5], hashes[0])
        for shape in ((4, 4, 5), (4,), (4, 4, 0)):
            with self.assertRaisesRegex(halflit.UsageError, "texture: expected an array of shape"):
                halflit.Scene().add_texture(np.zeros(shape, np.uint8))

    def test_allowed_folders(self):
        # A text is one folder, not a list of letters, whose first one is the root of all files.
        with tempfile.TemporaryDirectory() as folder:
            model, other = os.path.join(folder, "model"), os.path.join(folder, "other")
            os.mkdir(model)
            os.mkdir(other)
            with open(os.path.join(other, "x.bin"), "wb") as file:
                file.write(CORNERS.tobytes())
            path = os.path.join(model, "x.gltf")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(points_of("../other/x.bin"), file)
            for allowed in (other, pathlib.Path(other), os.fsencode(other), [other], (pathlib.Path(model), other)):
                self.assertEqual(halflit.Scene.load(path, allow_external=allowed).counts["meshes"], 1)
            here = os.getcwd()
            os.chdir(folder)  # where ".", and a folder named by the text's letters, are
            self.addCleanup(os.chdir, here)
            os.mkdir(os.path.join(folder, "m"))
            for allowed in ((), "m", os.path.join(folder, "m"), [model]):
                with self.assertRaises(halflit.Error):
                    halflit.Scene.load(path, allow_external=allowed)
            with self.assertRaises(halflit.Error):
                halflit.Scene.load(path, allow_external="/m")


def points_of(file):
    """A glTF document of the cube's corners, which lie in the file."""
    accessor = {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1] * 3, "max": [1] * 3}
    return {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}], "accessors": [accessor],
            "bufferViews": [{"buffer": 0, "byteLength": 96}], "buffers": [{"byteLength": 96, "uri": file}]}  # fmt: skip


def cube_of(material):
    scene = halflit.Scene()
    scene.add_mesh(CORNERS, FACES, material=material)
    return render(scene)


class Parts(unittest.TestCase):
    def test_instances_move(self):
        scene, fresh = halflit.Scene(), halflit.Scene()
        place = np.eye(4)
        place[:3, 3] = 1, 2, 3
        mesh = scene.add_mesh(CORNERS, FACES, name="cube")
        scene.add_instance(mesh, place)
        self.assertEqual(scene.counts["instances"], 2)
        self.assertEqual(scene.bounds.tolist(), [[-1, -1, -1], [2, 3, 4]])
        number, matrix = scene.instance(1)
        self.assertEqual((number, matrix.tolist()), (mesh, place.tolist()))
        before = render(scene)
        scene.set_instance(0, place)
        fresh.add_mesh(CORNERS, FACES, matrix=place)
        fresh.add_instance(0, place)
        self.assertNotEqual(render(scene).pixel_hash, before.pixel_hash)
        self.assertEqual(render(scene).pixel_hash, render(fresh).pixel_hash)

    def test_looks_names_and_removal_of_instances(self):
        scene, painted = halflit.Scene(), halflit.Scene()
        mesh = scene.add_mesh(CORNERS, FACES, material={"base_color": (1, 1, 1), "metallic": 0}, place=False)
        red = scene.add_instance(mesh, color=(0.5, 0.1, 0.1), name="left")
        painted.add_mesh(CORNERS, FACES, material={"base_color": (0.5, 0.1, 0.1), "metallic": 0})
        self.assertEqual(render(scene).pixel_hash, render(painted).pixel_hash)
        look = scene.look(red)
        self.assertEqual((look["material"], look["visible"], look["name"], look["node"]), (None, True, "left", None))
        self.assertTrue(np.allclose(look["color"], (0.5, 0.1, 0.1, 1)))
        other = scene.add_instance(mesh, moved(3), visible=False)
        self.assertEqual(render(scene).pixel_hash, render(painted).pixel_hash)
        scene.set_instance(other, visible=True)
        self.assertNotEqual(render(scene).pixel_hash, render(painted).pixel_hash)
        scene.remove_instance(other)
        self.assertEqual(render(scene).pixel_hash, render(painted).pixel_hash)
        with self.assertRaisesRegex(halflit.UsageError, "instance 1 was removed"):
            scene.instance(other)
        self.assertEqual(scene.add_instance(mesh), other)
        with self.assertRaisesRegex(halflit.UsageError, "mesh 0: instance 0 places it"):
            scene.remove_mesh(mesh)
        with self.assertRaisesRegex(halflit.UsageError, "color: expected"):
            scene.add_instance(mesh, color="reddish")
        self.assertEqual(scene.counts["instances"], 3)  # the place of what was refused is free

    def test_many_instances_at_once(self):
        scene, single = halflit.Scene(), halflit.Scene()
        places = np.array([moved(3 * i, i) for i in range(5)])
        for made in (scene, single):
            made.add_mesh(CORNERS, FACES, place=False)
        self.assertEqual(scene.add_instances(0, places), range(0, 5))
        for place in places:
            single.add_instance(0, place)
        self.assertEqual(render(scene).pixel_hash, render(single).pixel_hash)
        scene.set_instances(places[:2], [4, 2])
        single.set_instance(4, places[0])
        single.set_instance(2, places[1])
        self.assertEqual(render(scene).pixel_hash, render(single).pixel_hash)
        for wrong in (places[0], places.transpose(0, 2, 1) + 1, places[:, :3]):
            with self.assertRaisesRegex(halflit.UsageError, "matrices: expected"):
                scene.set_instances(wrong)
        with self.assertRaisesRegex(halflit.UsageError, "instance 9, but the scene has 5"):
            scene.set_instances(places[:1], [9])

    def test_a_world_with_z_up(self):
        turn = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)  # of z-up coordinates to y up
        upright, scene = halflit.Scene(), halflit.Scene(up="z")
        lifted = moved(0, 0, 2)
        scene.add_mesh(CORNERS, FACES, matrix=lifted)
        upright.add_mesh(CORNERS, FACES, matrix=turn @ lifted)
        self.assertEqual(render(scene).pixel_hash, render(upright).pixel_hash)
        self.assertEqual(scene.bounds.tolist(), [[-1, -1, 1], [1, 1, 3]])
        self.assertTrue(np.array_equal(scene.instance(0)[1], lifted))
        self.assertTrue(np.allclose(turn @ render(scene).camera.matrix, render(upright).camera.matrix))
        seen = render(scene, aovs=["position"]).aovs["position"]
        self.assertGreater(seen[:, :, 2].max(), 2.9)
        with self.assertRaisesRegex(halflit.UsageError, "up: expected one of"):
            halflit.Scene(up="w")

    def test_files_are_added_to_a_scene(self):
        # Two links of a robot, and a box of arrays: each where its pose says, by all that a file has.
        shining = {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 3, 0]}
        lamp = {"nodes": [{"mesh": 0, "name": "link"}, shining], **LAMPS}
        scene = halflit.Scene(up="z")
        scene.add_mesh(CORNERS, FACES, matrix=moved(-4))
        first = scene.add_file(stl(CORNERS))
        second = scene.add_file(box(more=lamp), moved(4, 0, 1))
        self.assertEqual((list(first), list(second)), ([1], [2]))
        self.assertEqual(scene.bounds.tolist(), [[-5, -1, -1], [5, 1, 2]])
        self.assertEqual([scene.instance(i)[1][:3, 3].tolist() for i in range(3)], [[-4, 0, 0], [0, 0, 0], [4, 0, 1]])
        self.assertEqual((scene.look(2)["name"], scene.nodes[scene.look(2)["node"]]["instances"]), ("link", [2]))
        self.assertEqual(list(scene.light(0).position), [4, 3, 1])
        picture = scene.render(60, azimuth=10, aovs=["id", "albedo"], samples=1)
        self.assertEqual(set(np.unique(picture.aovs["id"])), {0, 1, 2, 3})
        self.assertTrue(np.allclose(picture.aovs["albedo"][picture.aovs["id"] == 3].mean(axis=0), (0.9, 0.2, 0.1), atol=1e-3))
        scene.set_instance(second[0], moved(0, 4))
        self.assertEqual(scene.bounds.tolist(), [[-5, -1, -1], [1, 5, 1]])
        with self.assertRaisesRegex(halflit.UsageError, "up: expected none, or that of the scene"):
            scene.add_file(stl(CORNERS), up="x")
        with self.assertRaisesRegex(halflit.UsageError, "matrix|pose: expected"):
            scene.add_file(stl(CORNERS), np.eye(3))
        with self.assertRaises(halflit.BadInputError):
            scene.add_file(b"nothing")
        self.assertEqual(scene.counts["instances"], 3)

    def test_load_on_a_scene_adds(self):
        scene = halflit.Scene()
        self.assertIs(scene.load(stl(CORNERS)), scene)
        self.assertEqual((scene.counts["meshes"], scene.up), (1, "z"))
        scene.load(box(translation=[0, 0, 5]))
        self.assertEqual((scene.counts["meshes"], scene.bounds[1].tolist()), (2, [1, 1, 6]))
        # Far from the origin and tiny: the first file decides where it is drawn.
        far = halflit.Scene()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            far.load(box(translation=[1e6, 0, 0])).load(box(translation=[1e6 + 3, 0, 0]))
            far.load(box(translation=[1e6, 2, 0], scale=[1e-3] * 3))
        self.assertEqual(far.bounds[:, 0].tolist(), [1e6 - 1, 1e6 + 4])
        placed = moved(1e6, 2)
        placed[[0, 1, 2], [0, 1, 2]] = 1e-3
        self.assertTrue(np.allclose(far.instance(2)[1], placed, rtol=1e-7, atol=1e-12))

    def test_depth_does_not_depend_on_the_far_plane(self):
        # A square at depth 2.5, and one .002 behind another, by parallel rays.
        square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32), np.array([[0, 1, 2], [0, 2, 3]])
        scene, pair = halflit.Scene(), halflit.Scene()
        scene.add_mesh(square[0] + (0, 0, 0.5), square[1])
        for z in (-0.002, 0):
            pair.add_mesh(square[0] + np.float32((0, 0, z)), square[1])
        for far in (0, 10, 1e3, 1e5, 1e6, 1e30):
            keywords = {"orthographic": True, "half_height": 1.2, "near_z": 0.1, "far_z": far}
            camera = halflit.Camera.look_at((0, 0, 3), (0, 0, 0), **keywords)
            depth = scene.render(64, camera=camera, samples=1, aovs=["depth"]).aovs["depth"]
            self.assertAlmostEqual(depth[32, 32], 2.5, delta=2.5e-6)  # 2.5438 when it was a share of the way to 1e6
            seen = pair.render(64, camera=camera, samples=1, aovs=["id"]).aovs["id"]
            self.assertEqual(((seen == 1).sum(), (seen == 2).sum() > 2000), (0, True), far)
        cut = halflit.Camera.look_at((0, 0, 3), (0, 0, 0), orthographic=True, half_height=1, far_z=2.4)
        self.assertEqual((scene.render(16, camera=cut, samples=1, aovs=["id"]).aovs["id"] > 0).sum(), 0)

    def test_near_plane_follows_the_scene(self):
        # A ball of 5 cm at 8 cm, in metres.
        u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0, np.pi, 20))
        ball = 0.025 * np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], -1).reshape(-1, 3)
        i = np.arange(19)[:, None] * 40 + np.arange(39)
        scene = halflit.Scene()
        scene.add_mesh(ball, np.stack([i, i + 40, i + 1, i + 1, i + 40, i + 41], -1).reshape(-1, 3), name="ball")
        lens = np.array([[100, 0, 64], [0, 100, 64], [0, 0, 1.0]])

        def pixels(distance, **members):
            camera = halflit.Camera.from_intrinsics(lens, (128, 128), np.eye(3), (0, 0, distance), **members)
            return (scene.render(128, camera=camera, samples=1, aovs=["id"]).aovs["id"] > 0).sum()

        with warnings.catch_warnings():
            warnings.simplefilter("error")
            # A ball of radius r at distance d covers pi f^2 r^2 / (d^2 - r^2) pixels; one of 40 x 20 facets a little less.
            for distance in (0.06, 0.08, 0.2, 40):
                expected = np.pi * 100**2 * 0.025**2 / (distance**2 - 0.025**2)
                self.assertLess(abs(pixels(distance) - expected), 0.04 * expected + 4)
        with self.assertWarnsRegex(UserWarning, "near plane cuts 'ball', instance 0"):
            self.assertLess(pixels(0.08, near_z=0.09), pixels(0.08))
        scene._told.clear()
        with self.assertWarnsRegex(UserWarning, "near plane cuts 'ball', instance 0"):
            self.assertEqual(pixels(0.08, near_z=0.5), 0)

    def test_nodes_of_a_file(self):
        nodes = {"nodes": [{"name": "arm", "children": [1]}, {"name": "hand", "mesh": 0, "translation": [1, 0, 0]}]}
        scene = halflit.Scene.load(box(more=nodes))
        self.assertEqual([node["name"] for node in scene.nodes], ["arm", "hand"])
        self.assertEqual([node["parent"] for node in scene.nodes], [None, 0])
        seen = render(scene, aovs=["id"]).aovs["id"]
        self.assertEqual(set(np.unique(seen)) - {0}, {i + 1 for i in scene.nodes[1]["instances"]})
        self.assertEqual((scene.look(0)["node"], scene.name("instance", 0)), (1, "hand"))
        with self.assertRaisesRegex(halflit.UsageError, "part: expected one of node, instance"):
            scene.name("wheel", 0)

    def test_frames_of_one_scene_are_those_of_fresh_ones(self):
        # Whatever was drawn before: other sizes, views and light.
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for keywords in ({}, {"azimuth": 80}, {"studio": "never"}, {"ambient": (0.1, 0.2, 0.3)}, {"exposure": 2.0}, {}):
            for size in (40, (60, 40)):
                fresh = halflit.render((CORNERS, FACES), size, **keywords)
                self.assertEqual(scene.render(size, **keywords).pixel_hash, fresh.pixel_hash, (keywords, size))

    def test_materials_are_read_and_replaced(self):
        scene = halflit.Scene()
        paint = halflit.Material(name="paint", base_color=(1, 0.5, 0.25), metallic=0, lobe=("sloan", 0.5), alpha_mode="blend")
        index = scene.add_material(paint)
        self.assertEqual(scene.material(index), paint)
        self.assertEqual((paint.base_color, paint.alpha_mode, paint.double_sided), ((1, 0.5, 0.25, 1), "blend", False))
        self.assertEqual(repr(halflit.Material(metallic=1, roughness=0.5)), "Material(metallic=1.0, roughness=0.5)")
        scene.add_mesh(CORNERS, FACES, material=index)
        before = render(scene)
        scene.set_material(index, roughness=0.1, lobe="half-lambert", alpha_mode="opaque", base_color=[0, 0, 1])
        self.assertEqual(scene.material(index).name, "paint")
        self.assertNotEqual(render(scene).pixel_hash, before.pixel_hash)
        with self.assertRaisesRegex(halflit.UsageError, "material 5"):
            scene.material(5)
        with self.assertRaisesRegex(halflit.UsageError, "expected one of opaque, mask, blend"):
            halflit.Material(alpha_mode="solid")
        with self.assertRaisesRegex(halflit.UsageError, "base_color: expected 3 or 4 numbers"):
            halflit.Material(base_color=(1, 2))

    def test_setup_is_kept_while_things_move(self):
        scene = halflit.Scene.load(box(more=TURN), keep_animations=True)
        setup = scene.setup((80, 60))
        frames = []
        for i in range(4):
            scene.pose(time=i / 2)
            frames.append(scene.render(setup=setup))
            again = halflit.Scene.load(box(more=TURN), time=i / 2)
            self.assertEqual(frames[-1].pixel_hash, again.render((80, 60), camera=setup.camera, exposure=setup.exposure).pixel_hash)
        self.assertEqual(len({frame.pixel_hash for frame in frames}), 4)
        scene.render(30, azimuth=90)  # another setup in between
        scene.pose(time=0)
        self.assertEqual(scene.render(setup=setup).pixel_hash, frames[0].pixel_hash)
        with self.assertRaisesRegex(halflit.UsageError, "setup: made for 80 x 60"):
            scene.render(64, setup=setup)

    def test_a_calibration_places_pixels(self):
        turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
        k, move = [[600, 0, 331.3], [0, 590, 247.9], [0, 0, 1]], np.array([0.1, -0.2, 5])
        camera = halflit.Camera.from_intrinsics(k, (640, 480), turn, move)
        points = np.random.default_rng(2).uniform(-1, 1, (1000, 3))
        seen = points @ turn.T + move
        want = seen[:, :2] / seen[:, 2:] * (600, 590) + (331.3, 247.9) + 0.5  # the first pixel's middle is at 0
        left, right, bottom, top = camera.sides
        own = (points - camera.matrix[:3, 3]) @ camera.matrix[:3, :3]
        x, y = own[:, 0] / -own[:, 2], own[:, 1] / -own[:, 2]
        got = np.stack([(x - left) / (right - left) * 640, (top - y) / (top - bottom) * 480], 1)
        self.assertLess(np.abs(got - want).max(), 1e-3)
        self.assertEqual(halflit.Camera(**camera.to_dict()).sides, camera.sides)
        with self.assertRaisesRegex(halflit.UsageError, "mirrors"):
            halflit.Camera.from_intrinsics(k, (640, 480), turn * [[1], [-1], [1]], move)
        with self.assertRaisesRegex(halflit.UsageError, "K: expected"):
            halflit.Camera.from_intrinsics([600, 590], (640, 480), turn, move)

    def test_cameras(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        framed = scene.frame(80 / 60, azimuth=10, zoom=1.2)
        self.assertEqual(render(scene, camera=framed).pixel_hash, render(scene, azimuth=10, zoom=1.2).pixel_hash)
        camera = halflit.Camera.look_at((3, 2, 5), (0, 0, 0), fov_y_rad=0.8, near_z=0.5, far_z=50)
        view = np.linalg.inv(camera.matrix.astype(float))
        t, aspect = 1 / np.tan(0.4), 80 / 60
        perspective = [[t / aspect, 0, 0, 0], [0, t, 0, 0], [0, 0, -50.5 / 49.5, -50 / 49.5], [0, 0, -1, 0]]
        other = halflit.Camera.from_matrices(view, perspective)
        for name in ("fov_y_rad", "near_z", "far_z"):
            self.assertAlmostEqual(getattr(other, name), getattr(camera, name), places=4)
        self.assertTrue(np.allclose(other.matrix, camera.matrix, atol=1e-6))
        difference = render(scene, camera=other).astype(int) - render(scene, camera=camera)
        self.assertLess(abs(difference).mean(), 0.05)  # measured 0: the matrices differ in the last bit
        flat = halflit.Camera.from_matrices(view, [[0.25, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, -0.2, -1.2], [0, 0, 0, 1]])
        self.assertEqual([flat.orthographic, flat.half_height, flat.half_width], [True, 2, 4])
        self.assertAlmostEqual(flat.near_z, 1, places=5)
        self.assertAlmostEqual(flat.far_z, 11, places=4)
        by_matrix = render(scene, camera=camera.matrix)
        self.assertEqual(by_matrix.camera.matrix.tolist(), camera.matrix.tolist())
        shifted = halflit.Camera.from_matrices(view, [[1, 0, 0.2, 0], [0, 2, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]])
        self.assertTrue(np.allclose(shifted.sides, (-0.8, 1.2, -0.5, 0.5)))
        mirrored = np.diag([1.0, 1, -1, 1])
        with self.assertRaisesRegex(halflit.UsageError, "mirrors"):
            halflit.Camera(mirrored)
        with self.assertRaisesRegex(halflit.UsageError, "^camera: cannot be combined with .*azimuth"):
            render(scene, camera=camera, azimuth=3)
        with self.assertRaisesRegex(halflit.UsageError, "^camera: .*the scene has no camera"):
            render(scene, camera=1)

    def test_errors_tell_what_is_wrong(self):
        with self.assertRaisesRegex(halflit.FileError, "nowhere.glb"):
            halflit.render("/nowhere.glb")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "nowhere.hdr")
            for call in (lambda: halflit.render(path), lambda: halflit.Scene().set_environment(path)):
                with self.assertRaises(FileNotFoundError) as missing:
                    call()
                self.assertIsInstance(missing.exception, halflit.FileError)
                self.assertEqual((missing.exception.errno, missing.exception.filename), (errno.ENOENT, path))
                self.assertEqual(str(missing.exception), f"{path}: cannot be opened: No such file or directory")
            with self.assertRaises(halflit.FileError) as other:
                halflit.render(folder)
            self.assertNotIsInstance(other.exception, FileNotFoundError)
            model = os.path.join(folder, "model.gltf")
            with open(model, "w", encoding="utf-8") as file:
                json.dump(points_of("gone.bin"), file)
            with self.assertRaisesRegex(halflit.BadInputError, "gone.bin"):  # the model itself is there
                halflit.render(model)
        with self.assertRaises(halflit.BadInputError):
            halflit.render(b"glTF and then nothing")
        with self.assertRaisesRegex(TypeError, "sampels.*did you mean 'samples'"):
            halflit.render("demo", sampels=4)
        with self.assertRaisesRegex(TypeError, r"'width', the picture's is size=\(width, height\)"):
            halflit.render("demo", width=4)
        with self.assertRaisesRegex(TypeError, "no keyword up for the demo"):
            halflit.render("demo", up="z")
        with self.assertRaisesRegex(TypeError, r"'up', it is one of Scene\(\), Scene.load\(\)"):
            halflit.Scene().render(up="z")
        for name in ("lenien", "time_s", "size", "reserved", "allow_external_count"):
            with self.assertRaisesRegex(TypeError, f"has no keyword '{name}'"):
                halflit.Scene.load(box(), **{name: 1})
        for source in (7, ["a.glb", "b.glb"], (pathlib.Path("a.glb"), FACES)):
            with self.assertRaisesRegex(TypeError, "expected a path"):
                halflit.render(source)
        with self.assertRaisesRegex(halflit.UsageError, "size"):
            halflit.render("demo", (0, 4))
        with self.assertRaisesRegex(halflit.UsageError, "samples"):
            halflit.render("demo", 16, samples=3)
        with self.assertRaises(halflit.LimitError):
            halflit.Scene.load(box(), max_geometry_bytes=10)
        scene = halflit.Scene()
        with scene:
            self.assertIsNone(scene.bounds)
        with self.assertRaisesRegex(halflit.UsageError, "closed"):
            scene.render(8)
        self.assertEqual(repr(scene), "<halflit.Scene, closed>")

    def test_a_mesh_tells_the_instance_that_places_it(self):
        scene = halflit.Scene()
        kept = scene.add_mesh(CORNERS, FACES, name="kept", place=False)
        arm = scene.add_mesh(CORNERS, FACES, name="arm")
        self.assertEqual((kept, kept.instance, arm, arm.instance), (0, None, 1, 0))
        self.assertIsInstance(arm, int)
        for other in (copy.copy(arm), pickle.loads(pickle.dumps(arm))):
            self.assertEqual((type(other), other, other.instance), (halflit.MeshIndex, 1, 0))
        scene.set_instance(arm.instance, moved(1, 2, 3))
        self.assertEqual(scene.instance(arm.instance)[0], arm)
        ids = scene.render(32, aovs=["id"]).aovs["id"]
        self.assertEqual(set(np.unique(ids)), {0, arm.instance + 1})
        self.assertEqual(scene.look(arm.instance)["name"], "arm")
        second = scene.add_instance(kept, moved(4), name="hand")
        self.assertEqual([scene.name("instance", i) for i in (arm.instance, second)], ["arm", "hand"])

    def test_vertices_that_are_not_finite_are_left_out_with_a_warning(self):
        apart = np.concatenate([CORNERS, CORNERS + (5, 0, 0)])
        scene, plain = halflit.Scene(), halflit.Scene()
        plain.add_mesh(CORNERS, FACES)
        apart[8:] = np.nan
        with self.assertWarnsRegex(UserWarning, "vertices: mesh 'arm' has 8 that are not finite, the first in row 8: ") as told:
            scene.add_mesh(apart, np.concatenate([FACES, FACES + 8]), name="arm")
        self.assertEqual(len(told.warnings), 1)
        with self.assertWarnsRegex(UserWarning, "12 triangles dropped"):
            self.assertEqual(render(scene).pixel_hash, render(plain).pixel_hash)
        with self.assertWarnsRegex(UserWarning, "vertices: mesh 0 has 8 that are not finite"):
            scene.set_vertices(0, apart)
        with self.assertRaisesRegex(halflit.UsageError, "normals: row 8 is not finite"):
            scene.add_mesh(CORNERS.repeat(2, axis=0), FACES, normals=apart)

    def test_exact_vertices_that_are_too_far_away_are_warned_of(self):
        for offset, kind in ((1e6, np.float64), (4e6, np.float32)):
            far = CORNERS.astype(kind) + kind(offset)
            self.assertTrue(np.array_equal(far - kind(offset), CORNERS))
            with self.assertWarnsRegex(UserWarning, "vertices: float32, in which cameras are placed, has steps of .*views of the scene show it small"):
                halflit.Scene().add_mesh(far, FACES)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            halflit.Scene().add_mesh(CORNERS.astype(float) + 4e5, FACES)

    def test_messages_name_the_argument(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        nan, k, turn = float("nan"), [[600, 0, 32], [0, 600, 32], [0, 0, 1]], np.eye(3)
        by_intrinsics, load = halflit.Camera.from_intrinsics, halflit.Scene.load
        for said, call in (
            ("K: a number is not finite", lambda: by_intrinsics(np.multiply(k, nan), 64, turn, (0, 0, 1))),
            ("K: expected fx and fy above 0, found 0", lambda: by_intrinsics(np.zeros((3, 3)), 64, turn, (0, 0, 1))),
            ("K: expected numbers of shape", lambda: by_intrinsics([1], 64, turn, (0, 0, 1))),
            ("R: expected rows of length 1", lambda: by_intrinsics(k, 64, 2 * turn, (0, 0, 1))),
            ("size: ", lambda: by_intrinsics(k, (64, nan), turn, (0, 0, 1))),
            ("first_pixel: ", lambda: by_intrinsics(k, 64, turn, (0, 0, 1), "a")),
            *((f"{name}: expected a finite number", lambda name=name: scene.render(8, **{name: nan}))
              for name in ("azimuth", "elevation", "zoom", "fov", "studio_turn")),
            ("elevation: expected a number from -90 to 90", lambda: scene.render(8, elevation=91)),
            ("fov: expected a number from 1 to 170", lambda: scene.render(8, fov=-1)),
            ("view: expected a finite number", lambda: scene.render(8, view=(nan, 0))),
            ("threads is -1", lambda: scene.render(8, threads=-1)),
            ("isa: 'x86'", lambda: scene.render(8, isa="x86")),
            ("material 5, but", lambda: scene.add_mesh(CORNERS, FACES, material=5)),
            ("mesh 5, but", lambda: scene.set_instance(0, mesh=5)),
            ("source: .* found None", lambda: load(None)),
            ("time: ", lambda: load(box(), time=nan)),
            ("pose: ", lambda: scene.pose("walk")),
            ("camera_frame: aspect", lambda: scene.frame(-1)),
            ("scene: expected a Scene, found 3", lambda: halflit.Camera.view(3)),
            ("theta: ", lambda: halflit.Camera.orbit(nan, 0, 1)),
            ("target: ", lambda: halflit.Camera.orbit(0, 0, 1, (nan, 0, 0))),
            ("poses: ", lambda: scene.setup(8, poses=3)),
            ("poses: ", lambda: scene.setup(8, poses=[3])),
            ("cameras: .* found 3", lambda: scene.render_arrays(3, 8)),
            ("cameras: .* found 3", lambda: scene.render_batch(3, 8)),
            ("views: .* found 'front'", lambda: scene.render_views("front", 8)),
            ("meshes: .* found 3", lambda: halflit.render_meshes(3, 8)),
            ("lights: .* found 3", lambda: halflit.render("demo", 8, lights=3)),
            ("pictures: .* found 3", lambda: halflit.contact_sheet(3)),
            ("labels: .* found 'a'", lambda: halflit.contact_sheet([np.zeros((8, 8, 3), np.uint8)], labels="a")),
            ("mesh: expected a Trimesh.* found int", lambda: halflit.Scene.from_trimesh(3)),
            ("name: expected a text of Unicode", lambda: scene.add_mesh(CORNERS, FACES, name="\ud800")),
            ("camera: expected a text of Unicode", lambda: scene.render(8, camera="\ud800")),
            ("name: ", lambda: scene.set_name("mesh", 0, None)),
        ):  # fmt: skip
            with self.assertRaisesRegex(halflit.UsageError, "^" + said) as told:
                call()
            self.assertNotIn("halflit_", str(told.exception))
            self.assertNotIn("\n", str(told.exception))

    def test_numbers_that_c_cannot_hold_are_refused(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        for call in (
            lambda: scene.instance(2**32),
            lambda: scene.render(8, memory_limit=-1),
        ):
            with self.assertRaisesRegex(halflit.UsageError, "expected a whole number"):
                call()
        self.assertEqual(scene.render(8, dtype=None).dtype, np.uint8)

    def test_a_copied_camera_keeps_its_name(self):
        camera = halflit.Camera(name="a name of some length")
        copy = camera.copy()
        camera.name = "other"
        del camera
        self.assertEqual(copy.name, "a name of some length")

    def test_an_empty_scene_is_its_background(self):
        with self.assertWarnsRegex(UserWarning, "nothing to draw"):
            picture = halflit.Scene().render(8)
        self.assertEqual(np.unique(picture.reshape(-1, 4), axis=0).tolist(), [[0x2C, 0x30, 0x36, 255]])


if __name__ == "__main__":
    unittest.main()
