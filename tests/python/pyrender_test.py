"""Ten public scripts that use pyrender, with halflit in its place: each test makes the calls of one, with models made by code and smaller
pictures. Depths are those of rays in float64, and masks too but for pixels at edges."""
import copy
import unittest

import numpy as np

import halflit.compat.pyrender as pyrender
import ray_cast
import stand_ins
from halflit.compat.pyrender.constants import RenderFlags

TURN = np.diag([1.0, -1.0, -1.0, 1.0])  # from cameras of computer vision, which look along +z with y down


def placed(mesh, pose):
    """Triangles of a mesh in the world."""
    return mesh.triangles @ np.asarray(pose)[:3, :3].T + np.asarray(pose)[:3, 3]


def look_at(eye, target, up=(0, 1, 0)):
    """World from a camera that looks along -z."""
    z = np.subtract(eye, target) / np.linalg.norm(np.subtract(eye, target))
    x = np.cross(up, z) / np.linalg.norm(np.cross(up, z))
    pose = np.eye(4)
    pose[:3] = np.stack([x, np.cross(z, x), z, eye], axis=1)
    return pose


def raymond_lights():
    """The three lights that many scripts take from pyrender's viewer: 30 degrees from the axis, a third of a turn apart."""
    nodes = []
    for phi in np.pi * np.array([0.0, 2.0 / 3.0, 4.0 / 3.0]):
        way = np.array([np.sin(np.pi / 6) * np.cos(phi), np.sin(np.pi / 6) * np.sin(phi), np.cos(np.pi / 6)])
        matrix = look_at(way, (0, 0, 0), up=(0.3, 1, 0))
        matrix[:3, 3] = 0
        nodes.append(pyrender.Node(light=pyrender.DirectionalLight(color=np.ones(3), intensity=1.0), matrix=matrix))
    return nodes


class Scripts(unittest.TestCase):
    def check_depth(self, depth, triangles, sides, pose, **camera):
        """Compares with rays: within 1e-4 of the depth, and seen where rays hit, but at edges."""
        expected = ray_cast.depths(triangles, sides, pose, depth.shape[::-1], **camera)
        self.assertEqual(depth.dtype, np.float32)
        inner = ray_cast.inner(expected)
        self.assertGreater(inner.sum(), 60)
        self.assertLess((np.abs(depth - expected) / np.where(expected > 0, expected, 1))[inner].max(), 1e-4)
        self.assertFalse(depth[ray_cast.outer(expected)].any())
        self.assertLess(np.mean((depth > 0) != (expected > 0)), 0.002)
        return expected

    def test_vibe_draws_a_body_over_a_photograph_by_a_camera_of_its_own(self):
        # mkocabas/VIBE, lib/utils/renderer.py: a weak-perspective camera that is derived from pyrender.Camera, three point lights.
        class WeakPerspectiveCamera(pyrender.Camera):
            def __init__(self, scale, translation, znear=pyrender.camera.DEFAULT_Z_NEAR, zfar=None, name=None):
                super().__init__(znear=znear, zfar=zfar, name=name)
                self.scale, self.translation = scale, translation

            def get_projection_matrix(self, width=None, height=None):
                matrix = np.diag([self.scale[0], self.scale[1], -1.0, 1.0])
                matrix[:2, 3] = self.translation[0] * self.scale[0], -self.translation[1] * self.scale[1]
                return matrix

        renderer = pyrender.OffscreenRenderer(viewport_width=64, viewport_height=64, point_size=1.0)
        scene = pyrender.Scene(bg_color=[0.0, 0.0, 0.0, 0.0], ambient_light=(0.3, 0.3, 0.3))
        light, light_pose = pyrender.PointLight(color=[1.0, 1.0, 1.0], intensity=1), np.eye(4)
        for position in ([0, -1, 1], [0, 1, 1], [1, 1, 2]):
            light_pose[:3, 3] = position
            scene.add(light, pose=light_pose)
        camera = WeakPerspectiveCamera(scale=[0.9, 0.9], translation=[0.1, -0.05], zfar=1000.0)
        photograph = np.full((64, 64, 3), 90, np.uint8)
        for flags in (RenderFlags.RGBA, RenderFlags.RGBA | RenderFlags.ALL_WIREFRAME):
            for angle in (0, 90):
                mesh = stand_ins.body().apply_transform(stand_ins.rotation(np.pi, [1, 0, 0]))
                mesh.apply_transform(stand_ins.rotation(np.radians(angle), [0, 1, 0]))
                material = pyrender.MetallicRoughnessMaterial(metallicFactor=0.0, alphaMode="OPAQUE", baseColorFactor=(1.0, 1.0, 0.9, 1.0))
                mesh_node = scene.add(pyrender.Mesh.from_trimesh(mesh, material=material), "mesh")
                camera_node = scene.add(camera, pose=np.eye(4))
                rgb, depth = renderer.render(scene, flags=flags)
                valid = (rgb[:, :, -1] > 0)[:, :, np.newaxis]
                image = (rgb[:, :, :-1] * valid + (1 - valid) * photograph).astype(np.uint8)
                scene.remove_node(mesh_node)
                scene.remove_node(camera_node)
                sides = (-1 / 0.9 - 0.1, 1 / 0.9 - 0.1, -1 / 0.9 - 0.05, 1 / 0.9 - 0.05)
                # This camera sees what is behind it, too: from distance -1 to 1.
                expected = ray_cast.depths(mesh.triangles + (0, 0, -5), sides, np.eye(4), (64, 64), orthographic=True)
                if flags == RenderFlags.RGBA:
                    inner = ray_cast.inner(expected, 0.01)
                    self.assertLess(np.abs(depth - (expected - 5))[inner].max(), 1e-4)
                    self.assertTrue((rgb[inner][:, 3] == 255).all())
                    self.assertFalse(rgb[ray_cast.outer(expected)].any())
                self.assertTrue((image[ray_cast.outer(expected)] == 90).all())
                self.assertGreater((image != 90).any(axis=2).sum(), 200)
        self.assertIsNone(scene.main_camera_node)
        self.assertEqual(len(scene.lights), 1)
        self.assertEqual(len(scene.light_nodes), 3)

    def test_spin_draws_a_body_by_a_focal_length_of_5000_pixels(self):
        # nkolot/SPIN, utils/renderer.py.
        size = 96
        renderer = pyrender.OffscreenRenderer(viewport_width=size, viewport_height=size, point_size=1.0)
        material = pyrender.MetallicRoughnessMaterial(metallicFactor=0.2, alphaMode="OPAQUE", baseColorFactor=(0.8, 0.3, 0.3, 1.0))
        mesh = stand_ins.body().apply_transform(stand_ins.rotation(np.radians(180), [1, 0, 0]))
        scene = pyrender.Scene(ambient_light=(0.5, 0.5, 0.5))
        scene.add(pyrender.Mesh.from_trimesh(mesh, material=material), "mesh")
        camera_pose = np.eye(4)
        camera_pose[:3, 3] = (-0.1, 0.05, 110.0)
        camera = pyrender.IntrinsicsCamera(fx=5000, fy=5000, cx=size // 2, cy=size // 2, zfar=1000)
        scene.add(camera, pose=camera_pose)
        light, light_pose = pyrender.DirectionalLight(color=[1.0, 1.0, 1.0], intensity=1), np.eye(4)
        for position in ([0, -1, 1], [0, 1, 1], [1, 1, 2]):
            light_pose[:3, 3] = position
            scene.add(light, pose=light_pose)
        color, depth = renderer.render(scene, flags=pyrender.RenderFlags.RGBA)
        sides = ray_cast.pinhole(5000, 5000, size // 2, size // 2, (size, size))
        expected = self.check_depth(depth, mesh.triangles, sides, camera_pose, far=1000)
        share = color.astype(np.float32) / 255.0
        self.assertTrue((share[ray_cast.outer(expected)] == 1).all())  # the white background is opaque
        body = share[ray_cast.inner(expected)]
        self.assertTrue((body[:, 0] > 1.3 * body[:, 1]).all())

    def test_prohmr_draws_a_body_with_raymond_lights_over_a_photograph(self):
        # nkolot/ProHMR, prohmr/utils/renderer.py, as shubham-goel/4D-Humans and geopavlakos/hamer have it.
        image = np.random.default_rng(1).random((60, 80, 3))
        renderer = pyrender.OffscreenRenderer(viewport_width=image.shape[1], viewport_height=image.shape[0], point_size=1.0)
        material = pyrender.MetallicRoughnessMaterial(metallicFactor=0.0, alphaMode="OPAQUE", baseColorFactor=(1.0, 1.0, 0.9, 1.0))
        mesh = stand_ins.body().apply_transform(stand_ins.rotation(np.radians(180), [1, 0, 0]))
        scene = pyrender.Scene(bg_color=[0.0, 0.0, 0.0, 0.0], ambient_light=(0.3, 0.3, 0.3))
        scene.add(pyrender.Mesh.from_trimesh(mesh, material=material), "mesh")
        camera_pose = np.eye(4)
        camera_pose[:3, 3] = (0.2, 0.1, 3.5)
        center = [image.shape[1] / 2.0, image.shape[0] / 2.0]
        scene.add(pyrender.IntrinsicsCamera(fx=100, fy=100, cx=center[0], cy=center[1]), pose=camera_pose)
        for node in raymond_lights():
            scene.add_node(node)
        color, depth = renderer.render(scene, flags=pyrender.RenderFlags.RGBA)
        color = color.astype(np.float32) / 255.0
        valid = (color[:, :, -1] > 0)[:, :, np.newaxis]
        made = color[:, :, :3] * valid + (1 - valid) * image
        renderer.delete()
        expected = self.check_depth(depth, mesh.triangles, ray_cast.pinhole(100, 100, *center, (80, 60)), camera_pose)
        self.assertTrue((made[ray_cast.outer(expected)] == image[ray_cast.outer(expected)]).all())
        self.assertGreater(made[ray_cast.inner(expected)][:, 0].mean(), 0.6)  # lit from the camera's side

    def test_voca_draws_a_face_with_a_texture_with_colours_and_plain(self):
        # TimoBolkart/voca, utils/rendering.py, which EvelynFan/FaceFormer and others borrowed.
        frustum = {"near": 0.01, "far": 3.0, "height": 80, "width": 80}
        focal, center = 4754.97941935 / 20, 40
        mesh = stand_ins.uv_sphere(0.12, 12).apply_transform(stand_ins.rotation(np.pi / 2, [1, 0, 0]))
        uv = mesh.vertices[:, :2] / 0.24 + 0.5
        picture = np.zeros((8, 8, 3), np.uint8)
        picture[:4], picture[4:] = (250, 10, 10), (10, 10, 250)  # red on top
        pictures = {}
        for look in ("texture", "colors", "plain"):
            if look == "texture":
                texture = pyrender.Texture(source=picture, source_channels="RGB")
                shown = mesh.copy()
                shown.visual = stand_ins.Part(defined=True, kind="texture", uv=uv, material=stand_ins.Part(image=None))
                material = pyrender.material.MetallicRoughnessMaterial(baseColorTexture=texture)
                render_mesh = pyrender.Mesh.from_trimesh(shown, material=material)
            else:
                rgb = np.tile([0.1, 0.9, 0.1], (len(mesh.vertices), 1)) if look == "colors" else None
                tri_mesh = stand_ins.Trimesh(vertices=mesh.vertices, faces=mesh.faces, vertex_colors=rgb)
                render_mesh = pyrender.Mesh.from_trimesh(tri_mesh, smooth=True)
            scene = pyrender.Scene(ambient_light=[0.2, 0.2, 0.2], bg_color=[255, 255, 255])
            camera = pyrender.IntrinsicsCamera(fx=focal, fy=focal, cx=center, cy=center, znear=frustum["near"], zfar=frustum["far"])
            scene.add(render_mesh, pose=np.eye(4))
            camera_pose = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]]
            scene.add(camera, pose=camera_pose)
            light = pyrender.PointLight(color=np.array([1.0, 1.0, 1.0]), intensity=5.0 if look == "plain" else 0.5)
            light_pose = np.eye(4)
            light_pose[:3, 3] = (0, 0, 1)
            scene.add(light, pose=light_pose.copy())
            r = pyrender.OffscreenRenderer(viewport_width=frustum["width"], viewport_height=frustum["height"])
            pictures[look], depth = r.render(scene, flags=pyrender.RenderFlags.SKIP_CULL_FACES)
            sides = ray_cast.pinhole(focal, focal, center, center, (80, 80))
            self.check_depth(depth, mesh.triangles, sides, np.array(camera_pose, float), near=0.01, far=3.0, cull=False)
            self.assertTrue((pictures[look][0] == 255).all())
        self.assertGreater(int(pictures["texture"][30, 40, 0]), 2 * int(pictures["texture"][30, 40, 2]))
        self.assertGreater(int(pictures["texture"][50, 40, 2]), 2 * int(pictures["texture"][50, 40, 0]))
        self.assertGreater(int(pictures["colors"][40, 40, 1]), 1.5 * int(pictures["colors"][40, 40, 0]))
        self.assertLessEqual(np.ptp(pictures["plain"][40, 40].astype(int)), 1)

    def test_contactpose_moves_the_camera_around_an_object(self):
        # facebookresearch/ContactPose, utilities/rendering.py: depth maps of an object for poses of a camera of computer vision.
        mesh = stand_ins.box([80, 120, 200]).apply_transform(np.diag([1e-3, 1e-3, 1e-3, 1]))
        scene = pyrender.Scene()
        scene.add(pyrender.Mesh.from_trimesh(mesh), pose=np.eye(4))
        fx, fy, cx, cy = 150.0, 151.0, 47.0, 26.0
        camera = pyrender.IntrinsicsCamera(fx, fy, cx, cy, znear=0.1, zfar=2.0)
        camera_node = pyrender.Node(camera=camera, matrix=np.eye(4))
        scene.add_node(camera_node)
        renderer = pyrender.OffscreenRenderer(96, 54)
        for angle in (0.3, 1.2, 2.8):
            camera_from_object = stand_ins.rotation(angle, [0.2, 1, 0.4])
            camera_from_object[:3, 3] = (0.02, -0.01, 0.6)
            pose = np.linalg.inv(camera_from_object) @ TURN
            scene.set_pose(camera_node, pose)
            _, depth = renderer.render(scene)
            self.check_depth(depth, mesh.triangles, ray_cast.pinhole(fx, fy, cx, cy, (96, 54)), pose, near=0.1, far=2.0)

    def test_atlas_evaluates_depths_of_a_room_in_a_scene_that_is_cleared(self):
        # magicleap/Atlas, evaluate.py: one scene and one mesh for all frames, whose size may change.
        renderer, scene = pyrender.OffscreenRenderer(64, 48), pyrender.Scene()
        room = stand_ins.box([4.0, 3.0, 5.0])
        room.faces = room.faces[:, ::-1]  # seen from inside
        mesh = pyrender.Mesh.from_trimesh(room)
        for frame, (width, height) in enumerate([(64, 48), (64, 48), (48, 36)]):
            intrinsics = np.array([[0.9 * width, 0, width / 2], [0, 0.9 * width, height / 2], [0, 0, 1]])
            pose = stand_ins.rotation(0.7 * frame, [0, 1, 0.1])
            pose[:3, 3] = (0.3, 0.1, -0.2)
            renderer.viewport_height = height
            renderer.viewport_width = width
            scene.clear()
            scene.add(mesh)
            camera = pyrender.IntrinsicsCamera(cx=intrinsics[0, 2], cy=intrinsics[1, 2], fx=intrinsics[0, 0], fy=intrinsics[1, 1])
            scene.add(camera, pose=pose @ TURN)
            _, depth = renderer.render(scene)
            self.assertEqual(depth.shape, (height, width))
            sides = ray_cast.pinhole(intrinsics[0, 0], intrinsics[1, 1], intrinsics[0, 2], intrinsics[1, 2], (width, height))
            self.check_depth(depth, room.triangles, sides, pose @ TURN)
            self.assertTrue((depth > 0).all())
        renderer.delete()

    def test_contact_graspnet_labels_the_objects_on_a_table(self):
        # NVlabs/contact_graspnet, contact_graspnet/scene_renderer.py: nodes are copied and removed by their names, meshes hidden and shown.
        scene = pyrender.Scene()
        table = stand_ins.box([1.0, 1.2, 0.6])
        table_node = pyrender.Node(mesh=pyrender.Mesh.from_trimesh(table), name="table")
        scene.add_node(table_node)
        table_pose = np.eye(4)
        table_pose[2, 3] = -0.3
        scene.set_pose(table_node, table_pose)
        camera = pyrender.IntrinsicsCamera(61.6, 61.6, 31.0, 23.7, 0.04, 20)
        camera_node = scene.add(camera, pose=np.eye(4), name="camera")
        renderer = pyrender.OffscreenRenderer(viewport_width=64, viewport_height=48, point_size=1.0)
        objects = {"can": stand_ins.uv_sphere(0.12), "box": stand_ins.box([0.2, 0.15, 0.2])}
        cache = {name: {"node": pyrender.Node(mesh=pyrender.Mesh.from_trimesh(mesh), name=name)} for name, mesh in objects.items()}
        pose = look_at((0.1, -0.9, 0.8), (0, 0, 0), up=(0, 0, 1))
        for shift in (0.0, 0.1):
            poses = {"can": np.eye(4), "box": np.eye(4)}
            poses["can"][:3, 3], poses["box"][:3, 3] = (-0.15 + shift, 0, 0.12), (0.15, shift, 0.1)
            for node in scene.get_nodes():
                if node.name not in ["table", "camera", "parent"]:
                    scene.remove_node(node)
            for name in objects:
                context = copy.deepcopy(cache[name])
                scene.add_node(context["node"])
                scene.set_pose(context["node"], poses[name])
            scene.set_pose(camera_node, pose.copy())
            color, full = renderer.render(scene)
            triangles = {name: placed(mesh, poses[name]) for name, mesh in objects.items()}
            everything = np.concatenate([placed(table, table_pose), *triangles.values()])
            sides = ray_cast.pinhole(61.6, 61.6, 31.0, 23.7, (64, 48))
            self.check_depth(full, everything, sides, pose, near=0.04, far=20)
            shown = []
            for node in scene.get_nodes():
                if node.name not in ["camera", "parent"]:
                    node.mesh.is_visible = False
                    if node.name != "table":
                        shown.append(node)
            labels = np.zeros(full.shape, np.uint8)
            for node in shown:
                node.mesh.is_visible = True
                depth = renderer.render(scene)[1]
                mask = np.logical_and(np.abs(depth - full) < 1e-6, np.abs(full) > 0)
                self.assertFalse(labels[mask].any())
                labels[mask] = 1 + list(objects).index(node.name)
                node.mesh.is_visible = False
            for node in scene.get_nodes():
                if node.name not in ["camera", "parent"]:
                    node.mesh.is_visible = True
            for label, name in enumerate(objects, 1):
                alone = ray_cast.depths(triangles[name], sides, pose, (64, 48), near=0.04, far=20)
                whole = ray_cast.depths(everything, sides, pose, (64, 48), near=0.04, far=20)
                self.assertLess(np.mean((labels == label) != ((alone > 0) & (np.abs(alone - whole) < 1e-9))), 0.004)

    def test_dex_ycb_draws_segmentations_of_hands_and_objects(self):
        # NVlabs/dex-ycb-toolkit, examples/render.py: colours of nodes, a wireframe over a hand, and joints as instances of one ball.
        colors = {"can": (255, 0, 0), "box": (0, 128, 128), "hand": (255, 255, 255)}
        size, K = (64, 48), (70.0, 70.0, 32.0, 24.0)  # noqa: N806
        renderer = pyrender.OffscreenRenderer(viewport_width=size[0], viewport_height=size[1])
        scene = pyrender.Scene(bg_color=np.array([0.0, 0.0, 0.0, 0.0]), ambient_light=np.array([1.0, 1.0, 1.0]))
        scene.add(pyrender.IntrinsicsCamera(*K), pose=np.eye(4))
        things = {"can": stand_ins.uv_sphere(0.15), "box": stand_ins.box([0.3, 0.2, 0.1])}
        seg_node_map, triangles = {}, {}
        for name, x in (("can", -0.15), ("box", 0.15)):
            pose = stand_ins.rotation(0.5, [1, 1, 0])
            pose[:3, 3] = (x, 0.05, 1.0)
            pose[1] *= -1
            pose[2] *= -1
            seg_node_map[scene.add(pyrender.Mesh.from_trimesh(things[name]), pose=pose)] = colors[name]
            triangles[name] = placed(things[name], pose)
        hand = stand_ins.uv_sphere(0.1)
        hand.vertices = (hand.vertices + (0, 0.1, 0.8)) * (1, -1, -1)
        solid, wire = pyrender.Mesh.from_trimesh(hand), pyrender.Mesh.from_trimesh(hand, wireframe=True)
        solid.primitives[0].material.baseColorFactor = [0.7, 0.7, 0.7, 1.0]
        wire.primitives[0].material.baseColorFactor = [0.0, 0.0, 0.0, 1.0]
        seg_node_map[scene.add(solid)] = colors["hand"]
        scene.add(wire)
        triangles["hand"] = hand.triangles
        color, _ = renderer.render(scene)
        seg, depth = renderer.render(scene, pyrender.RenderFlags.SEG, seg_node_map=seg_node_map)
        sides = ray_cast.pinhole(*K, size)
        everything = np.concatenate(list(triangles.values()))
        expected = self.check_depth(depth, everything, sides, np.eye(4))
        found = {tuple(code) for code in seg.reshape(-1, 3)}
        self.assertEqual(found, {*colors.values(), (0, 0, 0)})
        for name, code in colors.items():
            alone = ray_cast.depths(triangles[name], sides, np.eye(4), size)
            wanted = (alone > 0) & (np.abs(alone - expected) < 1e-9)
            self.assertLess(np.mean((seg == code).all(axis=2) != wanted), 0.004, name)
        self.assertFalse(color[ray_cast.outer(expected)].any())
        mask, _ = renderer.render(scene, pyrender.RenderFlags.SEG, seg_node_map={next(iter(seg_node_map)): 1})
        self.assertEqual(set(mask.ravel().tolist()), {0, 1})

        joints = np.tile(np.eye(4), (21, 1, 1))
        joints[:, :3, 3] = np.random.default_rng(3).uniform((-0.3, -0.2, -1.2), (0.3, 0.2, -0.8), (21, 3))
        ball = stand_ins.uv_sphere(radius=0.05)
        ball.visual.vertex_colors = [1.0, 0.0, 0.0]
        scene = pyrender.Scene(bg_color=np.array([0.0, 0.0, 0.0, 0.0]), ambient_light=np.array([1.0, 1.0, 1.0]))
        scene.add(pyrender.IntrinsicsCamera(*K), pose=np.eye(4))
        scene.add(pyrender.Mesh.from_trimesh(ball, poses=joints))
        color, depth = renderer.render(scene)
        self.check_depth(depth, np.concatenate([placed(ball, joint) for joint in joints]), sides, np.eye(4))
        self.assertGreater(int(color[depth > 0][:, 0].mean()), 100)
        self.assertLess(int(color[depth > 0][:, 1].max()), 110)

    def test_tacto_draws_a_sensor_by_several_cameras_with_their_own_lights(self):
        # facebookresearch/tacto, tacto/renderer.py, with pybullet: cameras, gel and lights move together; lights are removed and added.
        scene = pyrender.Scene()
        corners = [[0.02, 0.015, 0.02], [0.02, 0.015, -0.02], [0.02, -0.015, -0.02], [0.02, -0.015, 0.02]]
        gel = stand_ins.Trimesh(corners, [[0, 1, 2], [2, 3, 0]])
        gel_node = pyrender.Node(mesh=pyrender.Mesh.from_trimesh(gel, smooth=False), matrix=np.eye(4))
        scene.add_node(gel_node)
        camera = pyrender.PerspectiveCamera(yfov=np.deg2rad(80), znear=0.001)
        zero_poses = [look_at((0, y, 0), (0.02, y / 2, 0), up=(0, 0, 1)) for y in (-0.004, 0.004)]
        camera_nodes = [pyrender.Node(camera=camera, matrix=pose) for pose in zero_poses]
        light_nodes, light_poses = [], []
        # Whole numbers are 255ths, as in pyrender: the sensor's own settings have them.
        for color, y in (([1, 0, 0], -0.01), ([0, 1, 0], 0.0), ([0, 0, 1], 0.01)):
            pose = np.eye(4)
            pose[:3, 3] = (0, y, 0.01)
            light_poses.append(pose)
            light_nodes.append(pyrender.Node(light=pyrender.PointLight(color=color, intensity=1.0), matrix=pose))
        for node in camera_nodes + light_nodes:
            scene.add_node(node)
        ball = stand_ins.uv_sphere(0.006)
        ball_node = pyrender.Node(mesh=pyrender.Mesh.from_trimesh(ball), matrix=np.eye(4))
        renderer = pyrender.OffscreenRenderer(48, 64)
        current = list(light_nodes)
        for step in range(2):
            place = stand_ins.rotation(0.5 * step, [0, 0, 1])
            place[:3, 3] = (0.1 * step, 0, 0)
            for node, zero in zip(camera_nodes, zero_poses):
                node.matrix = place.dot(zero)
            gel_node.matrix = place
            for node, zero in zip(light_nodes, light_poses):
                node.matrix = place.dot(zero)
            ball_pose = place.copy()
            ball_pose[:3, 3] = (place @ (0.019, 0.002, 0.001, 1))[:3]
            if not scene.has_node(ball_node):
                scene.add_node(ball_node)
            scene.set_pose(ball_node, pose=ball_pose)
            for camera_node, lights in zip(camera_nodes, ([0, 1], [2])):
                scene.main_camera_node = camera_node
                for node in current:
                    scene.remove_node(node)
                current = [light_nodes[i] for i in lights]
                for node in current:
                    scene.add_node(node)
                color, depth = renderer.render(scene)
                triangles = np.concatenate([placed(gel, place), placed(ball, ball_pose)])
                sides = ray_cast.perspective(np.deg2rad(80), (48, 64))
                expected = self.check_depth(depth, triangles, sides, camera_node.matrix, near=0.001)
                seen = color[ray_cast.inner(expected)].mean(axis=0)
                self.assertEqual([channel > 20 for channel in seen], [i in lights for i in range(3)])

    def test_shapenet_pyrender_draws_a_model_from_many_sides(self):
        # nicolaihaeni/shapenet-pyrender, pyrenderer.py: a new scene of trimesh's and a new renderer for each side.
        textured = stand_ins.box([0.3, 0.4, 0.2])
        corners = np.array([[i >> 0 & 1, i >> 1 & 1] for i in range(8)], float)
        picture = np.full((4, 4, 3), (30, 200, 60), np.uint8)
        textured.visual = stand_ins.Part(defined=True, kind="texture", uv=corners, material=stand_ins.Part(image=picture))
        ball_pose = np.eye(4)
        ball_pose[:3, 3] = (0, 0.3, 0)
        ball = stand_ins.uv_sphere(0.15)
        model = stand_ins.scene((textured, np.eye(4)), (ball, ball_pose))
        light = pyrender.SpotLight(color=np.ones(3), intensity=3.0, innerConeAngle=np.pi / 16.0, outerConeAngle=np.pi / 6.0)
        camera = pyrender.IntrinsicsCamera(fx=65.6, fy=65.6, cx=32.0, cy=32.0, znear=0.01, zfar=100)
        for angle in range(0, 360, 120):
            pose = look_at((np.sin(np.radians(angle)), 0.5, np.cos(np.radians(angle))), (0, 0.1, 0))
            scene = pyrender.Scene.from_trimesh_scene(model, ambient_light=(1, 1, 1))
            scene.add(camera, pose=pose)
            scene.add(light, pose=pose)
            r = pyrender.OffscreenRenderer(64, 64)
            color, depth = r.render(scene)
            mask = (depth != 0).astype(int)
            triangles = np.concatenate([textured.triangles, placed(ball, ball_pose)])
            expected = self.check_depth(depth, triangles, ray_cast.pinhole(65.6, 65.6, 32.0, 32.0, (64, 64)), pose, near=0.01)
            self.assertEqual(mask.sum(), (depth > 0).sum())
            self.assertTrue((color[ray_cast.outer(expected)] == 255).all())
            r.delete()


if __name__ == "__main__":
    unittest.main()
