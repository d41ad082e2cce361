"""halflit.compat.pyrender: objects behave as pyrender documents them, flags decide pictures, which upload what has changed alone."""
import gc
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import weakref

import numpy as np

import halflit.compat.pyrender as pyrender
import ray_cast
import stand_ins
from halflit import _c
from halflit.compat.pyrender import GLTF, RenderFlags
from halflit.compat.pyrender._looks import light_of

APPS = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "apps", "python")
SIZE = 32


def moved(x=0.0, y=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def square(half=1.0, **members):
    """A mesh in the plane z = 0 that faces +z."""
    corners = half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    members = {"normals": np.tile([0, 0, 1], (4, 1)), "indices": [[0, 1, 2], [0, 2, 3]], **members}
    return pyrender.Mesh([pyrender.Primitive(corners, **members)])


def rough(color=(1.0, 1.0, 1.0, 1.0), **members):
    return pyrender.MetallicRoughnessMaterial(baseColorFactor=color, metallicFactor=0.0, roughnessFactor=1.0, **members)


def seen(*objects, **scene):
    """A scene of objects with their poses, seen from z = 2 by a camera of 90 degrees."""
    made = pyrender.Scene(**scene)
    for thing, pose in objects:
        made.add(thing, pose=pose)
    made.add(pyrender.PerspectiveCamera(yfov=math.pi / 2), pose=moved(z=2))
    return made


def draw(scene, flags=RenderFlags.NONE, size=SIZE, **options):
    return pyrender.OffscreenRenderer(size, size).render(scene, flags, **options)


class Objects(unittest.TestCase):
    def test_all_names_of_pyrender_are_there(self):
        names = "Camera PerspectiveCamera OrthographicCamera IntrinsicsCamera Light PointLight DirectionalLight SpotLight Sampler Texture"
        names += " Material MetallicRoughnessMaterial SpecularGlossinessMaterial Primitive Mesh Node Scene Renderer Viewer"
        for name in (names + " OffscreenRenderer RenderFlags TextAlign GLTF __version__").split():
            self.assertIn(name, pyrender.__all__)
            self.assertTrue(hasattr(pyrender, name))
        for kind in (pyrender.Viewer, pyrender.Renderer):
            with self.assertRaisesRegex(NotImplementedError, "^[^\n]*no window[^\n]*$"):
                kind(pyrender.Scene(), use_raymond_lighting=True)

    def test_projections(self):
        wide = pyrender.PerspectiveCamera(yfov=math.pi / 2, znear=0.5, zfar=2.0).get_projection_matrix(200, 100)
        np.testing.assert_allclose(wide, [[0.5, 0, 0, 0], [0, 1, 0, 0], [0, 0, -5 / 3, -4 / 3], [0, 0, -1, 0]], atol=1e-12)
        endless = pyrender.PerspectiveCamera(yfov=math.pi / 2, znear=0.5, aspectRatio=1.5).get_projection_matrix()
        np.testing.assert_allclose(endless, [[2 / 3, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]], atol=1e-12)
        flat = pyrender.OrthographicCamera(xmag=3, ymag=2, znear=1, zfar=3)
        np.testing.assert_allclose(flat.get_projection_matrix(), [[1 / 3, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, -1, -2], [0, 0, 0, 1]])
        self.assertAlmostEqual(flat.get_projection_matrix(100, 50)[0, 0], 1 / 4)
        pinhole = pyrender.IntrinsicsCamera(100, 110, 40, 30, znear=1, zfar=3).get_projection_matrix(80, 50)
        point = pinhole @ (0.1, 0.2, -2, 1)  # 2 in front: at pixel 40 + 100 * 0.1 / 2, 30 - 110 * 0.2 / 2
        np.testing.assert_allclose((point[:2] / point[3] + 1) / 2 * (80, 50), (45, 50 - 19), atol=1e-9)
        for make in (lambda: pyrender.PerspectiveCamera(yfov=0), lambda: pyrender.OrthographicCamera(1, 1, znear=0),
                     lambda: pyrender.PerspectiveCamera(1, znear=2, zfar=1), lambda: pyrender.OrthographicCamera(-1, 1)):  # fmt: skip
            self.assertRaises(ValueError, make)

    def test_nodes_are_placed_by_a_matrix_or_its_parts(self):
        half = math.sqrt(0.5)
        node = pyrender.Node(translation=[1, 2, 3], rotation=[0, 0, half, half], scale=[2, 3, 4])
        np.testing.assert_allclose(node.matrix, [[0, -3, 0, 1], [2, 0, 0, 2], [0, 0, 4, 3], [0, 0, 0, 1]], atol=1e-12)
        random = np.random.default_rng(5)
        for _ in range(20):
            quaternion = random.normal(size=4)
            quaternion /= np.linalg.norm(quaternion) * np.sign(quaternion[3])
            node = pyrender.Node(rotation=quaternion, scale=[0.5, 2, 1])
            again = pyrender.Node(matrix=node.matrix)
            np.testing.assert_allclose(again.rotation, quaternion, atol=1e-9)
            np.testing.assert_allclose(again.scale, [0.5, 2, 1], atol=1e-9)
        node.translation = [5, 0, 0]
        np.testing.assert_allclose(node.rotation, quaternion, atol=1e-9)
        for name, value in (("matrix", np.zeros((4, 4))), ("matrix", np.eye(3)), ("rotation", [1, 1, 0, 0]), ("scale", [1])):
            self.assertRaises(ValueError, setattr, node, name, value)
        self.assertRaises(TypeError, pyrender.Node, mesh=3)

    def test_a_scene_is_a_tree(self):
        scene = pyrender.Scene(name="yard")
        arm = scene.add(square(), name="arm", pose=moved(1))
        hand = scene.add(square(), name="hand", pose=moved(0, 2), parent_name="arm")
        light = scene.add(pyrender.PointLight(name="lamp"), parent_node=hand)
        camera = scene.add(pyrender.PerspectiveCamera(1.0), pose=moved(z=3))
        other = scene.add(pyrender.PerspectiveCamera(1.0))
        self.assertIs(scene.main_camera_node, camera)
        np.testing.assert_allclose(scene.get_pose(light)[:3, 3], (1, 2, 0))
        scene.set_pose(arm, moved(5))
        np.testing.assert_allclose(scene.get_pose(light)[:3, 3], (5, 2, 0))
        np.testing.assert_allclose(scene.bounds, [[4, -1, 0], [6, 3, 0]])
        np.testing.assert_allclose(scene.centroid, (5, 1, 0))
        self.assertAlmostEqual(scene.scale, math.sqrt(20))
        self.assertEqual(scene.get_nodes(name="arm"), {arm})
        self.assertEqual(scene.get_nodes(obj=hand.mesh), {hand})
        self.assertEqual(scene.get_nodes(obj_name="lamp", name="hand"), set())
        self.assertEqual(scene.get_nodes(obj_name="lamp"), {light})
        self.assertEqual((len(scene.meshes), len(scene.point_lights), len(scene.cameras), len(scene.nodes)), (2, 1, 2, 5))
        for wrong in (lambda: scene.add_node(arm), lambda: scene.add(square(), parent_name="leg"), lambda: scene.get_pose(pyrender.Node()),
                      lambda: setattr(scene, "main_camera_node", pyrender.Node())):  # fmt: skip
            self.assertRaises(ValueError, wrong)
        self.assertRaises(TypeError, scene.add, "mesh")
        scene.remove_node(hand)
        self.assertEqual((arm.children, scene.has_node(light), len(scene.lights)), ([], False, 0))
        scene.remove_node(camera)
        self.assertIs(scene.main_camera_node, other)
        scene.clear()
        self.assertEqual((scene.nodes, scene.main_camera_node, scene.bounds.tolist()), (set(), None, np.zeros((2, 3)).tolist()))
        child = pyrender.Node(name="child")
        whole = pyrender.Scene(nodes=[child, pyrender.Node(children=[child])])
        self.assertEqual(len(whole.nodes), 2)

    def test_colours_are_shares_or_255ths(self):
        np.testing.assert_allclose(pyrender.Scene(bg_color=[255, 0, 51]).bg_color, [1, 0, 0.2, 1])
        np.testing.assert_allclose(pyrender.Scene(bg_color=[0.1, 0.2, 0.3, 0]).bg_color, [0.1, 0.2, 0.3, 0], rtol=1e-6)
        np.testing.assert_allclose(pyrender.Scene().bg_color, np.ones(4))
        np.testing.assert_allclose(pyrender.PointLight(color=0.5, intensity=3).color, np.full(3, 0.5))
        np.testing.assert_allclose(pyrender.MetallicRoughnessMaterial(baseColorFactor=[0.5, 0.5, 0.5]).baseColorFactor, [0.5, 0.5, 0.5, 1])
        np.testing.assert_allclose(square(color_0=np.full((4, 3), 51, np.uint8)).primitives[0].color_0, np.tile([0.2, 0.2, 0.2, 1], (4, 1)))
        texture = pyrender.Texture(source=np.full((2, 3, 3), 0.5), source_channels="RGBA").source
        self.assertEqual((texture.shape, texture.dtype, texture[0, 0].tolist()), ((2, 3, 4), np.uint8, [127, 127, 127, 255]))
        for wrong in (dict(metallicFactor=2), dict(alphaMode="ADD"), dict(alphaCutoff=-1)):
            self.assertRaises(ValueError, pyrender.MetallicRoughnessMaterial, **wrong)
        self.assertRaises(ValueError, pyrender.SpotLight, innerConeAngle=1.0, outerConeAngle=0.5)
        self.assertRaises(ValueError, square, normals=np.zeros((3, 3)))

    def test_meshes_of_trimesh(self):
        box = stand_ins.box([1, 1, 1])
        smooth = pyrender.Mesh.from_trimesh(box).primitives[0]
        self.assertEqual((len(smooth.positions), smooth.material.alphaMode, smooth.material.metallicFactor), (8, "BLEND", 0.2))
        flat = pyrender.Mesh.from_trimesh([box, box], smooth=False, wireframe=True).primitives
        self.assertEqual((len(flat), len(flat[0].positions), flat[0].indices, flat[0].material.wireframe), (2, 36, None, True))
        box.visual.face_colors = np.full((12, 3), 200, np.uint8)
        self.assertRaises(ValueError, pyrender.Mesh.from_trimesh, box)
        np.testing.assert_allclose(pyrender.Mesh.from_trimesh(box, smooth=False).primitives[0].color_0[:, 0], 200 / 255)
        own = rough()
        self.assertIs(pyrender.Mesh.from_trimesh(box, material=own, smooth=False).primitives[0].material, own)
        pbr = stand_ins.Part(baseColorFactor=np.array([255, 0, 0, 255], np.uint8), doubleSided=True, metallicFactor=0.5, alphaCutoff=None)
        shown = stand_ins.box([1, 1, 1])
        shown.visual = stand_ins.Part(defined=True, kind="texture", uv=None, material=pbr)
        made = pyrender.Mesh.from_trimesh(shown).primitives[0].material
        self.assertEqual((made.baseColorFactor.tolist(), made.doubleSided, made.metallicFactor), ([1, 0, 0, 1], True, 0.5))
        self.assertRaises(TypeError, pyrender.Mesh.from_trimesh, "box")


class Flags(unittest.TestCase):
    def test_backgrounds_have_their_codes(self):
        for color in ([0.3, 0.5, 0.7, 1.0], [0.0, 0.01, 0.02, 1.0], [1.0, 1.0, 1.0, 0.0], [12, 200, 97]):
            scene = seen((square(0.2), moved()), bg_color=color)
            wanted = np.floor(scene.bg_color.astype(np.float64) * 255 + 0.5)
            for flags in (RenderFlags.NONE, RenderFlags.FLAT, RenderFlags.DISABLE_ANTI_ALIASING):
                self.assertEqual(draw(scene, flags)[0][0, 0].tolist(), wanted[:3].tolist())
                self.assertEqual(draw(scene, flags | RenderFlags.RGBA)[0][0, 0].tolist(), wanted.tolist())

    def test_what_is_empty_or_not_finite_is_not_drawn(self):
        nothing = pyrender.Mesh([pyrender.Primitive(np.zeros((0, 3))), pyrender.Primitive(np.zeros((0, 3)), mode=GLTF.POINTS)])
        nowhere = pyrender.Primitive(np.eye(3), poses=np.zeros((0, 4, 4)))
        alone = pyrender.Mesh([pyrender.Primitive(np.eye(3), indices=np.zeros((0, 3), int)), nowhere])
        self.assertEqual(nothing.bounds.shape, (2, 3))
        wrong = square(normals=np.full((4, 3), np.nan))
        for flags in (RenderFlags.NONE, RenderFlags.ALL_WIREFRAME, RenderFlags.FACE_NORMALS | RenderFlags.VERTEX_NORMALS):
            depth = draw(seen((nothing, moved()), (alone, moved()), (pyrender.Mesh([]), moved())), flags)[1]
            self.assertFalse(depth.any())
            self.assertTrue(draw(seen((wrong, moved())), flags)[1].any())
        broken = pyrender.Primitive(np.eye(3), indices=[[0, 1, 7]])
        self.assertRaises(ValueError, draw, seen((pyrender.Mesh([broken]), moved())))

    def test_shapes_and_types(self):
        scene = seen((square(), moved()))
        color, depth = draw(scene)
        self.assertEqual((color.shape, color.dtype, depth.shape, depth.dtype), ((SIZE, SIZE, 3), np.uint8, (SIZE, SIZE), np.float32))
        self.assertTrue(color.flags.c_contiguous and color.flags.writeable and depth.flags.writeable)
        np.testing.assert_array_equal(draw(scene, RenderFlags.DEPTH_ONLY), depth)
        self.assertEqual(draw(scene, RenderFlags.RGBA)[0].shape, (SIZE, SIZE, 4))
        self.assertEqual(draw(scene, RenderFlags.SEG | RenderFlags.RGBA, seg_node_map={})[0].tolist(), [[[0, 0, 0, 255]] * SIZE] * SIZE)
        with self.assertRaisesRegex(ValueError, "camera"):
            draw(pyrender.Scene())
        renderer = pyrender.OffscreenRenderer(8, 4)
        self.assertEqual(renderer.render(scene)[0].shape, (4, 8, 3))
        renderer.viewport_width = 6
        self.assertEqual(renderer.render(scene)[1].shape, (4, 6))
        renderer.delete()
        self.assertEqual(renderer.render(scene)[1].shape, (4, 6))

    def test_an_empty_scene_is_background(self):
        color, depth = draw(seen())
        self.assertTrue((color == 255).all() and not depth.any())

    def test_flat_pictures_have_the_colours_that_are_given(self):
        picture = np.array([[[10, 20, 30], [200, 100, 50]]], np.uint8)
        uv = [[0, 0], [1, 0], [1, 1], [0, 1]]
        material = rough((0.5, 1.0, 1.0, 1.0), baseColorTexture=picture)
        scene = seen((square(2.0, texcoord_0=uv, material=material, color_0=np.tile([1.0, 0.5, 1.0], (4, 1))), moved()))
        color, _ = draw(scene, RenderFlags.FLAT)
        np.testing.assert_allclose(color[5, 4].astype(int), (5, 10, 30), atol=1)
        np.testing.assert_allclose(color[5, 28].astype(int), (100, 50, 50), atol=1)

    def test_back_faces(self):
        behind = np.diag([1.0, -1, -1, 1])
        scene = seen((square(material=rough()), behind))
        self.assertFalse(draw(scene)[1].any())
        for flags in (RenderFlags.SKIP_CULL_FACES, RenderFlags.SKIP_CULL_FACES | RenderFlags.DEPTH_ONLY):
            found = draw(scene, flags)
            self.assertAlmostEqual(float((found if flags & RenderFlags.DEPTH_ONLY else found[1]).max()), 2.0, places=5)
        self.assertTrue(draw(seen((square(material=rough(doubleSided=True)), behind)))[1].any())

    def test_wireframes_and_normals(self):
        ball = pyrender.Mesh.from_trimesh(stand_ins.uv_sphere(1.0, 6))
        scene = seen((ball, moved()), (pyrender.DirectionalLight(intensity=3), moved()))
        color, depth = draw(scene, size=96)
        wire, wire_depth = draw(scene, RenderFlags.ALL_WIREFRAME, size=96)
        flipped, _ = draw(scene, RenderFlags.FLIP_WIREFRAME, size=96)
        np.testing.assert_array_equal(wire, flipped)
        self.assertTrue(0.02 < (wire_depth > 0).sum() / (depth > 0).sum() < 0.7)
        np.testing.assert_array_equal(draw(scene, RenderFlags.ALL_WIREFRAME | RenderFlags.DEPTH_ONLY, size=96), depth)
        solid, _ = draw(scene, RenderFlags.ALL_SOLID, size=96)
        np.testing.assert_array_equal(solid, color)
        for flag in (RenderFlags.VERTEX_NORMALS, RenderFlags.FACE_NORMALS):
            lined, lined_depth = draw(scene, flag, size=96)
            np.testing.assert_array_equal(lined_depth, depth)
            blue = (lined[:, :, 2] > 200) & (lined[:, :, 0] < 100)
            self.assertGreater(blue.sum(), 50)
            self.assertFalse(((color[:, :, 2] > 200) & (color[:, :, 0] < 100)).any())

    def test_shadows(self):
        sun = moved()
        sun[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]  # along -y
        upright = np.eye(4)
        upright[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
        floor, lid = moved(y=-1) @ np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]]), moved(y=0.5)
        lid[:3, :3] = floor[:3, :3]
        scene = seen((square(1.5, material=rough()), floor), (square(0.5, material=rough(doubleSided=True)), lid),
                     (pyrender.DirectionalLight(intensity=3), sun))  # fmt: skip
        plain, depth = draw(scene)
        for flag, darker in ((RenderFlags.SHADOWS_DIRECTIONAL, True), (RenderFlags.SHADOWS_ALL, True), (RenderFlags.SHADOWS_SPOT, False)):
            shaded, _ = draw(scene, flag)
            self.assertEqual(bool((shaded[26, 16].astype(int) < plain[26, 16].astype(int) - 50).all()), darker, flag)
            self.assertEqual(shaded[26, 2].tolist(), plain[26, 2].tolist())

    def test_what_blends_is_seen_through_and_has_a_depth(self):
        glass = square(0.5, material=rough((1.0, 0.0, 0.0, 0.5), alphaMode="BLEND"))
        wall = square(2.0, material=rough((0.0, 0.0, 1.0, 1.0)))
        color, depth = draw(seen((glass, moved(z=0.5)), (wall, moved(z=-1)), ambient_light=[1.0, 1.0, 1.0]))
        self.assertAlmostEqual(float(depth[16, 16]), 1.5, places=5)
        self.assertAlmostEqual(float(depth[8, 16]), 3.0, places=5)
        self.assertTrue(150 < color[16, 16, 0] < 255 and 150 < color[16, 16, 2] < 255)
        alone, _ = draw(seen((glass, moved(z=0.5)), ambient_light=[1.0, 1.0, 1.0], bg_color=[0, 0, 0, 0]), RenderFlags.RGBA)
        self.assertTrue(120 < alone[16, 16, 3] < 136)

    def test_points_and_lines(self):
        points = np.array([[-0.5, 0, 0], [0.5, 0, 0]])
        cloud = pyrender.Mesh.from_points(points, colors=[[0.2, 0.4, 0.6], [1.0, 0.0, 0.0]])
        renderer = pyrender.OffscreenRenderer(SIZE, SIZE, point_size=4.0)
        color, depth = renderer.render(seen((cloud, moved()), bg_color=[0.0, 0.0, 0.0]), RenderFlags.DISABLE_ANTI_ALIASING)
        self.assertEqual((depth > 0).sum(), 24)  # two circles in squares of 4 x 4
        self.assertEqual({tuple(code) for code in color.reshape(-1, 3)}, {(0, 0, 0), (51, 102, 153), (255, 0, 0)})
        ends = pyrender.Primitive([[-0.5, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0]], mode=GLTF.LINE_STRIP, color_0=[0.0, 1.0, 0.0])
        color, depth = draw(seen((pyrender.Mesh([ends]), moved()), bg_color=[0.0, 0.0, 0.0]))
        self.assertTrue(8 <= (color[:, :, 1] > 60).sum() <= 40)
        self.assertEqual(color[:, :, 0].max(), 0)

    def test_strips_and_fans_are_triangles(self):
        corners = np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]])
        wanted = draw(seen((square(), moved())))[1]
        for mode, order in ((GLTF.TRIANGLE_STRIP, None), (GLTF.TRIANGLE_FAN, [0, 1, 3, 2]), (GLTF.TRIANGLES, [0, 1, 2, 2, 1, 3])):
            mesh = pyrender.Mesh([pyrender.Primitive(corners, indices=order, mode=mode)])
            np.testing.assert_array_equal(draw(seen((mesh, moved())))[1], wanted)


class Brightness(unittest.TestCase):
    """The light of pyrender's shading where it has a closed form: a rough dielectric that faces light and camera."""

    def check(self, scene, light, tolerance=1.5):
        color, _ = draw(scene, size=33)
        wanted = 255 * min(1.0, light) ** (1 / 2.2)
        for code in color[16, 16]:
            self.assertAlmostEqual(float(code), wanted, delta=tolerance)

    def test_lights_have_the_units_of_pyrender(self):
        wall = (square(3.0, material=rough((0.5, 0.5, 0.5, 1.0))), moved())
        # (1 - F) 0.96 / pi of diffuse light and F G D / 4 of highlights, F = 0.04, G = 1, D = 1 / pi.
        share = (0.96 * 0.96 * 0.5 + 0.04 / 4) / math.pi
        for intensity in (0.3, 1.0, 3.0):
            self.check(seen(wall, (pyrender.DirectionalLight(intensity=intensity), moved(7))), intensity * share)
        for distance in (1.0, 2.0):
            self.check(seen(wall, (pyrender.PointLight(intensity=4.0), moved(z=distance))), 4.0 / distance**2 * share)
        spot = pyrender.SpotLight(intensity=4.0, innerConeAngle=math.pi / 16, outerConeAngle=math.pi / 6)
        self.check(seen(wall, (spot, moved(z=1.5))), 4.0 / 1.5**2 * share)
        self.check(seen(wall, (spot, moved(2, z=1.5))), 0.0)
        self.check(seen(wall, (pyrender.DirectionalLight([1.0, 1.0, 1.0], 1.0), moved()), ambient_light=[0.2, 0.2, 0.2]), share + 0.1, 3)

    def test_ambient_light_is_a_share_of_the_base_colour(self):
        for metallic in (0.0, 1.0):
            material = pyrender.MetallicRoughnessMaterial(baseColorFactor=[0.6, 0.6, 0.6, 1.0], metallicFactor=metallic)
            self.check(seen((square(3.0, material=material), moved()), ambient_light=[0.5, 0.5, 0.5]), 0.3, 3)

    def test_emission(self):
        self.check(seen((square(3.0, material=rough(emissiveFactor=[0.25, 0.25, 0.25])), moved())), 0.25, 1.5)


class Cameras(unittest.TestCase):
    def test_orthographic_depths_are_distances(self):
        ball = stand_ins.uv_sphere(0.8, 10)
        scene = pyrender.Scene()
        scene.add(pyrender.Mesh.from_trimesh(ball))
        scene.add(pyrender.OrthographicCamera(xmag=1.0, ymag=1.2, znear=0.5, zfar=10.0), pose=moved(0.1, 0, 3))
        renderer = pyrender.OffscreenRenderer(48, 32)
        depth = renderer.render(scene, RenderFlags.DEPTH_ONLY)
        sides = (-1.8, 1.8, -1.2, 1.2)
        expected = ray_cast.depths(ball.triangles, sides, moved(0.1, 0, 3), (48, 32), 0.5, 10.0, orthographic=True)
        inner = ray_cast.inner(expected, 0.1)
        self.assertGreater(inner.sum(), 100)
        self.assertLess((np.abs(depth - expected)[inner] / expected[inner]).max(), 1e-4)
        self.assertFalse(depth[ray_cast.outer(expected)].any())

    def test_what_is_beyond_the_planes_is_not_seen(self):
        for near, far, is_seen in ((0.05, None, True), (2.5, None, False), (0.05, 1.5, False), (1.5, 2.5, True)):
            scene = pyrender.Scene()
            scene.add(square())
            scene.add(pyrender.PerspectiveCamera(yfov=1.0, znear=near, zfar=far), pose=moved(z=2))
            self.assertEqual(bool(draw(scene, RenderFlags.DEPTH_ONLY).any()), is_seen, (near, far))

    def test_a_camera_may_be_scaled_and_not_mirrored(self):
        scene = pyrender.Scene()
        scene.add(square())
        node = scene.add(pyrender.PerspectiveCamera(yfov=1.0), pose=moved(z=2) @ np.diag([0.5, 0.5, 0.5, 1]))
        self.assertAlmostEqual(float(draw(scene)[1].max()), 4.0, places=5)  # in the camera's lengths
        for matrix in (np.diag([-1.0, 1, 1, 1]), np.diag([1.0, 2, 1, 1])):
            scene.set_pose(node, moved(z=2) @ matrix)
            self.assertRaises(ValueError, draw, scene)

    def test_an_aspect_ratio_stretches_the_view(self):
        scene = pyrender.Scene()
        scene.add(square(0.5))
        scene.add(pyrender.PerspectiveCamera(yfov=math.pi / 2, aspectRatio=2.0), pose=moved(z=1))
        depth = draw(scene, RenderFlags.DEPTH_ONLY, size=40)
        self.assertEqual(((depth > 0).any(axis=0).sum(), (depth > 0).any(axis=1).sum()), (10, 20))


class Uploads(unittest.TestCase):
    """Tests of what a picture asks the library for."""

    def setUp(self):
        self.robot = pyrender.Scene(ambient_light=[0.3, 0.3, 0.3])
        self.links = []
        for i in range(5):
            parent = self.links[-1] if i % 3 else None
            mesh = pyrender.Mesh.from_trimesh(stand_ins.uv_sphere(0.3, 4), material=rough((0.5, 0.5, 0.5, 1.0)))
            self.links.append(self.robot.add(mesh, pose=moved(0.1 + 0.25 * i), parent_node=parent))
        self.light = self.robot.add(pyrender.DirectionalLight(intensity=2.0))
        self.camera = self.robot.add(pyrender.PerspectiveCamera(1.0), pose=moved(z=3))
        self.renderer = pyrender.OffscreenRenderer(SIZE, SIZE)
        self.renderer.render(self.robot)

    def calls(self, scene=None):
        """The names of the library's functions that change something in the next picture, and the picture."""
        with unittest.mock.patch.object(_c, "call", side_effect=_c.call) as call:
            color, depth = self.renderer.render(scene or self.robot)
        names = [one.args[0] for one in call.call_args_list]
        fresh = pyrender.OffscreenRenderer(SIZE, SIZE).render(scene or self.robot)
        np.testing.assert_array_equal(color, fresh[0])  # as one that uploads everything
        np.testing.assert_array_equal(depth, fresh[1])
        return [name[len("scene_") :] for name in names if name.startswith("scene_") and "_get_" not in name] + [
            name for name in names if name == "choose_picture"
        ]

    def test_shares_of_the_picture_are_light_to_the_power_of_11_fifths(self):
        shares = np.concatenate([np.arange(256) / 255, np.float32(0.7) ** np.arange(60, dtype=np.float32)])
        light = light_of(shares)
        self.assertEqual((light[0], light[255]), (0, 1))
        self.assertLess(np.abs(light[1:] ** 5 / shares[1:] ** 11 - 1).max(), 1e-12)

    def test_a_scene_that_does_not_change_is_not_uploaded_again(self):
        self.assertEqual(self.calls(), [])
        self.robot.set_pose(self.camera, moved(0.1, 0, 3))
        self.assertEqual(self.calls(), [])
        self.robot.bg_color = [0, 0, 0]
        self.assertEqual(self.calls(), [])

    def test_poses_that_change_move_instances_alone(self):
        self.robot.set_pose(self.links[0], moved(0, 0.1))
        self.assertEqual(self.calls(), ["place_instances_double"])
        pose = moved(0, 0.2)
        self.robot.set_pose(self.links[1], pose)
        self.assertEqual(self.calls(), ["place_instances_double"])
        pose[0, 3] = 0.5  # scripts write into the array that they gave
        self.assertEqual(self.calls(), ["place_instances_double"])

    def test_materials_and_vertices_are_uploaded_alone(self):
        primitive = self.links[2].mesh.primitives[0]
        primitive.material.baseColorFactor[0] = 1.0  # in place
        self.assertIn("set_material", self.calls())
        primitive.positions = primitive.positions * np.float32(1.2)
        self.assertEqual(self.calls().count("set_mesh"), 1)
        primitive.material = pyrender.SpecularGlossinessMaterial()
        self.calls()
        for name in ("diffuseFactor", "specularFactor", "emissiveFactor"):
            getattr(primitive.material, name)[1] = 0.25
            self.assertIn("set_material", self.calls(), name)
        self.assertEqual(self.calls(), [])

    def test_nodes_come_and_go(self):
        self.robot.remove_node(self.links[4])
        found = self.calls()
        self.assertIn("remove_mesh", found)
        self.assertNotIn("add_mesh", found)
        for step in range(3):
            node = self.robot.add(square(0.2 + 0.1 * step), pose=moved(-0.5))
            self.assertEqual(self.calls().count("add_mesh"), 1)
            self.robot.remove_node(node)
        self.links[0].mesh.is_visible = False
        self.assertNotIn("add_mesh", self.calls())
        self.robot.remove_node(self.light)
        self.assertIn("choose_picture", self.calls())
        world = next(iter(self.renderer._kept[self.robot].worlds.values()))
        found = world.scene.counts  # one more than the largest index: indices are used again
        self.assertEqual((found["meshes"], found["instances"], found["materials"]), (5, 5, 5))

    def test_textures_are_kept_and_freed(self):
        uv = [[0, 0], [1, 0], [1, 1], [0, 1]]
        texture = pyrender.Texture(source=np.full((4, 4, 3), 200, np.uint8), source_channels="RGB")
        node = self.robot.add(square(0.5, texcoord_0=uv, material=rough(baseColorTexture=texture)), pose=moved(z=1))
        self.assertEqual(self.calls().count("add_texture"), 1)
        self.assertEqual(self.calls(), [])
        texture.source = np.full((2, 2, 3), 50, np.uint8)
        self.assertEqual(self.calls().count("set_texture"), 1)
        self.robot.remove_node(node)
        self.assertEqual(self.calls().count("remove_texture"), 1)

    def test_a_scene_that_goes_takes_its_uploads_with_it(self):
        scene = seen((square(), moved()))
        self.renderer.render(scene)
        world = weakref.ref(next(iter(self.renderer._kept[scene].worlds.values())))
        del scene
        gc.collect()
        self.assertIsNone(world())
        self.assertEqual(len(self.renderer._kept), 1)
        self.renderer.delete()
        self.assertEqual(len(self.renderer._kept), 0)

    def test_instances_of_a_primitive_follow_their_node(self):
        poses = np.array([moved(-0.5), moved(0.5)])
        mesh = pyrender.Mesh.from_trimesh(stand_ins.uv_sphere(0.2, 5), poses=poses)
        scene = seen((mesh, moved()))
        node = next(iter(scene.mesh_nodes))
        for place in (moved(), moved(0, 0.5)):
            scene.set_pose(node, place)
            triangles = np.concatenate([stand_ins.uv_sphere(0.2, 5).triangles + (place @ pose)[:3, 3] for pose in poses])
            expected = ray_cast.depths(triangles, ray_cast.perspective(math.pi / 2, (SIZE, SIZE)), moved(z=2), (SIZE, SIZE))
            self.assertLess(np.mean((self.renderer.render(scene)[1] > 0) != (expected > 0)), 0.005)
        self.calls(scene)
        mesh.primitives[0].poses = poses @ moved(0, 0.1)
        self.assertEqual(self.calls(scene), ["place_instances_double"])
        mesh.primitives[0].poses = poses[:1]
        self.assertLess((self.renderer.render(scene)[1] > 0).sum(), 0.6 * (expected > 0).sum())


class Idioms(unittest.TestCase):
    """Tests of uses by public scripts besides the documented interface."""

    def cache_of(self, vertex, fragment):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        paths = [os.path.join(folder.name, name) for name in ("mesh.vert", "mesh.frag")]
        for path, text in zip(paths, (vertex, fragment)):
            if text is not None:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)

        class Cache:
            def get_program(self, vertex_shader, fragment_shader, geometry_shader=None, defines=None):
                return pyrender.shader_program.ShaderProgram(*paths, defines=defines)

        return Cache()

    def test_modules_are_there(self):
        self.assertEqual(pyrender.renderer.RenderFlags.SEG, RenderFlags.SEG)
        self.assertEqual(pyrender.version.__version__, pyrender.__version__)
        self.assertEqual(pyrender.utils.format_color_vector(255, 4).tolist(), [1, 1, 1, 1])
        self.assertTrue(np.allclose(pyrender.utils.format_color_array(np.array([255, 0, 51]), (2, 4)), [[1, 0, 0.2, 1]] * 2))
        self.assertEqual(pyrender.utils.format_texture_source(np.full((2, 3), 0.5), "RGB").shape, (2, 3, 3))
        self.assertIsNone(pyrender.utils.format_texture_source(None))
        with tempfile.TemporaryDirectory() as folder:
            pixels, path = np.arange(48, dtype=np.uint8).reshape(4, 4, 3), os.path.join(folder, "x.png")
            pyrender.image.save_image(path, pixels, flip_up_down=True)
            self.assertGreater(os.path.getsize(path), 60)

    def test_a_cache_of_programs_that_show_normals_gives_normals(self):
        n = np.array([1, 2, 2]) / 3
        wall = square(5.0, normals=np.tile(n, (4, 1)))
        pose = np.eye(4)
        pose[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]  # the camera's x is the world's y
        pose[2, 3] = 2
        scene = pyrender.Scene(bg_color=[0.0, 1.0, 0.0, 1.0])
        scene.add(wall)
        scene.add(pyrender.PerspectiveCamera(yfov=1.0), pose=pose)
        turned = "normalize(vec3(transpose(inverse(M)) * vec4(normal, 0)))"
        world = "void main() { gl_Position = P * V * M * vec4(position, 1); frag_normal = %s; }" % turned
        fragment = "in vec3 frag_normal; // no lights here\nvoid main() { frag_color = vec4(normalize(frag_normal) * 0.5 + 0.5, 1.0); }"
        in_view = pose[:3, :3].T @ n
        for vertex, expected in ((world, n), (world.replace("inverse(M)", "inverse(V * M)"), in_view), (None, n)):
            renderer = pyrender.OffscreenRenderer(16, 16)
            renderer._renderer._program_cache = self.cache_of(vertex, None if vertex is None else fragment)
            color, depth = renderer.render(scene, RenderFlags.SKIP_CULL_FACES)
            self.assertTrue((np.abs(color[4:12, 4:12].astype(float) - (expected + 1) * 127.5) <= 0.5 + 1e-3).all(), color[8, 8])
            self.assertAlmostEqual(float(depth[8, 8]), 2, places=5)
        self.assertEqual(renderer.render(scene, RenderFlags.DEPTH_ONLY).shape, (16, 16))
        usual = draw(scene, size=16)[0]
        for cache in (None, self.cache_of(world, "void main() { frag_color = sum_of_lights(normal); }")):
            renderer._renderer._program_cache = cache
            self.assertTrue(np.array_equal(renderer.render(scene)[0], usual))

    def test_other_programs_are_refused_by_name(self):
        renderer = pyrender.OffscreenRenderer(8, 8)
        renderer._renderer._program_cache = self.cache_of("void main() {}", "void main() { frag_color = vec4(barycentric, 1); }")
        with self.assertRaisesRegex(NotImplementedError, "mesh.frag: halflit runs no shaders.*aovs"):
            renderer.render(seen((square(), moved())))

    def test_ambient_light_alone_gives_the_shaders_colours(self):
        # pyrender's formula: (base colour * ambient light + emission) * vertex colour, to the power of 1 / 2.2.
        colors = np.tile(np.array([200, 100, 50, 255], np.uint8), (4, 1))
        for metal, ambient, emission in ((0.0, 1.0, 0.0), (1.0, 0.5, 0.0), (0.2, 0.5, 0.1)):
            material = pyrender.MetallicRoughnessMaterial(
                baseColorFactor=(0.3, 0.3, 0.3, 1.0), metallicFactor=metal, roughnessFactor=0.8, emissiveFactor=[emission] * 3
            )
            wall = square(5.0, material=material, color_0=None if emission else colors)
            color, _ = draw(seen((wall, moved()), ambient_light=[ambient] * 3))
            light = 0.3 * ambient * (1 if emission else colors[0, :3] / 255) + emission
            self.assertTrue((np.abs(color[16, 16] - 255 * np.broadcast_to(light, 3) ** (1 / 2.2)) <= 1).all(), color[16, 16])


class Types(unittest.TestCase):
    @unittest.skipUnless(shutil.which("mypy"), "no mypy")
    def test_types_are_complete(self):
        with tempfile.TemporaryDirectory() as folder:
            command = ["mypy", "--strict", "--enable-incomplete-feature=Unpack", "--follow-imports=silent", "--cache-dir", folder]
            command += ["--python-executable", sys.executable, "-p", "halflit.compat", "-m", "halflit.trimesh"]
            done = subprocess.run(command, env={**os.environ, "MYPYPATH": APPS}, stdout=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())


if __name__ == "__main__":
    unittest.main()
