"""Meshes of trimesh. Without it, objects of the same shapes and number types stand in for them."""
import io
import sys
import types
import unittest
import unittest.mock

import numpy as np

import halflit
import halflit.trimesh
import stand_ins
from halflit._trimesh import add_geometry
from support import CORNERS, FACES, moved

try:
    from PIL import Image
except ImportError:
    Image = None

try:
    import trimesh
except ImportError:
    trimesh = None

GREY = np.array([102, 102, 102, 255], np.uint8)  # trimesh's DEFAULT_COLOR
NORMALS = CORNERS / np.float32(3**0.5)


def rgba(color):
    """As trimesh.visual.color.to_rgba: uint8 (4,), floats times 255."""
    if color is None:
        return GREY.copy()
    array = np.asarray(color)
    array = np.round(array * 255).astype(np.uint8) if array.dtype.kind == "f" else array.astype(np.uint8)
    return np.append(array, np.uint8(255)) if len(array) == 3 else array


class Part:
    """Members as attributes."""

    __module__ = "trimesh.base"

    def __init__(self, **members):
        self.__dict__.update(members)


def simple(image=None, diffuse=None):
    return Part(image=image, ambient=rgba(None), diffuse=rgba(diffuse), specular=rgba(None), glossiness=1.0)


def pbr(baseColorFactor=None, emissiveFactor=None, doubleSided=False, **members):  # noqa: N803
    names = "metallicFactor roughnessFactor alphaMode alphaCutoff baseColorTexture metallicRoughnessTexture"
    names += " normalTexture occlusionTexture emissiveTexture"
    return Part(
        baseColorFactor=None if baseColorFactor is None else rgba(baseColorFactor),
        emissiveFactor=None if emissiveFactor is None else np.array(emissiveFactor, np.float64),
        doubleSided=doubleSided,
        **{**dict.fromkeys(names.split()), **members},
    )


class Mesh(Part):
    """A Trimesh: normals are made when they are asked for, and stay in the cache."""

    def __init__(self, visual, normals=None, vertices=CORNERS, faces=FACES):
        super().__init__(vertices=vertices.astype(float), faces=faces.astype(np.int64), visual=visual)
        self._cache = {} if normals is None else {"vertex_normals": normals.astype(float)}

    @property
    def vertex_normals(self):
        return self._cache.setdefault("vertex_normals", NORMALS.astype(float))

    @property
    def smooth_shaded(self):
        """Split at the edges of the cube: each corner has the normal of its face."""
        corners = self.faces.ravel()
        vertices = self.vertices[corners]
        of_faces = np.cross(vertices[1::3] - vertices[::3], vertices[2::3] - vertices[::3])
        normals = np.repeat(of_faces / np.linalg.norm(of_faces, axis=1, keepdims=True), 3, axis=0)
        visual = Part(**vars(self.visual))
        for name in ("uv", "vertex_colors"):
            if getattr(visual, name, None) is not None:
                setattr(visual, name, getattr(visual, name)[corners])
        return Mesh(visual, normals, vertices, np.arange(len(corners)).reshape(-1, 3))


def colored(kind=None, **colors):
    """A mesh with ColorVisuals, which have neither uv nor material."""
    return Mesh(Part(kind=kind, **colors))


def textured(material, uv=None, **mesh):
    return Mesh(Part(kind="texture", uv=uv, material=material), **mesh)


def scene(**mesh):
    made = halflit.Scene()
    made.add_mesh(CORNERS, FACES, **mesh)
    return made.render(64)


class OfStandIns(unittest.TestCase):
    def check(self, mesh, expected):
        self.assertEqual(halflit.render(mesh, 64).pixel_hash, expected.pixel_hash)
        self.assertEqual(halflit.render(mesh, 64).pixel_hash, expected.pixel_hash)  # whatever the first call put into its cache

    def test_a_plain_mesh_is_that_of_its_arrays(self):
        self.check(colored(), scene())
        self.assertNotEqual(halflit.render(colored(), 64).pixel_hash, scene(normals=NORMALS).pixel_hash)  # not shaded as a ball

    def test_normals_that_came_with_the_mesh_are_used(self):
        self.check(Mesh(Part(kind=None), normals=CORNERS), scene(normals=CORNERS))

    def test_without_scipy_faces_are_flat(self):
        class Alone(Mesh):
            @property
            def smooth_shaded(self):
                raise ImportError("no module named scipy")

        self.check(Alone(Part(kind=None)), scene())

    def test_colours(self):
        colors = np.tile(np.array([[200, 30, 90, 255], [10, 250, 90, 255]], np.uint8), (4, 1))
        self.check(colored("vertex", vertex_colors=colors), scene(colors=colors))
        one = np.tile(np.array([[200, 30, 90, 255]], np.uint8), (12, 1))
        self.check(colored("face", face_colors=one), scene(colors=np.tile(one[:1], (8, 1))))

    def test_each_face_has_its_own_colour(self):
        # Two triangles make a side of the cube: six sides of six colours, of which a corner shows three.
        sides = np.repeat(np.arange(6), 2)
        palette = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], [0, 255, 255], [255, 0, 255]], np.uint8)
        mesh = colored("face", face_colors=np.pad(palette[sides], ((0, 0), (0, 1)), constant_values=255))
        picture = halflit.render(mesh, 64, samples=1, aovs=["albedo", "triangle"])
        seen = picture.aovs["triangle"] > 0
        numbers = picture.aovs["triangle"][seen] - 1
        self.assertEqual(len(np.unique(sides[numbers])), 3)
        self.assertTrue(np.array_equal(picture.aovs["albedo"][seen], (palette[sides[numbers]] > 0).astype(np.float32)))

    def test_what_was_read_from_stl_has_z_up(self):
        loaded = {"stl": "z", "stl_ascii": "z", "3mf": "z", "glb": "y", None: "y"}
        for kind, up in loaded.items():
            mesh = colored()
            mesh.source = Part(file_type=kind)
            self.assertEqual(halflit.Scene.from_trimesh(mesh).up, up)
            self.assertEqual(halflit.Scene.from_trimesh(mesh, up="x").up, "x")
            bare = halflit.render((CORNERS, FACES), 32, view="top", up=up)
            self.assertEqual(halflit.render(mesh, 32, view="top").pixel_hash, bare.pixel_hash)
        older = colored()
        older.metadata = {"file_name": "part.STL"}
        self.assertEqual(halflit.Scene.from_trimesh(older).up, "z")

    def test_paths_are_lines(self):
        class Entity:
            def __init__(self, points, color=None):
                self.points, self.color = points, color

            def discrete(self, vertices):
                return vertices[self.points]

        vertices = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0]], float)
        for columns in (3, 2):
            path = Part(entities=[Entity([0, 1], np.array([255, 0, 0, 255], np.uint8)), Entity([2, 3])], vertices=vertices[:, :columns])
            made = halflit.Scene.from_trimesh(path)
            self.assertEqual(made.bounds.tolist(), [[-1, -1, 0], [1, 1, 0]])
            picture = made.render(64, camera=halflit.Camera.look_at((0, 0, 4), (0, 0, 0)), background="#00ff00", samples=1, line_width=3)
            self.assertEqual((picture[32, 20, :3].tolist(), picture[20, 32, :3].tolist()), ([255, 0, 0], [0, 0, 0]))
        self.assertIsNone(add_geometry(made, Part(entities=[], vertices=vertices), None, True))

    def test_a_material_without_uv(self):
        red = {"base_color": (1, 0, 0), "metallic": 1, "roughness": 1}
        self.check(textured(pbr(baseColorFactor=[1.0, 0.0, 0.0, 1.0])), scene(material=red))

    def test_pbr_factors_are_linear(self):
        # trimesh keeps them as 255ths: 0.5 is 128.
        factors = {"metallicFactor": 0.25, "roughnessFactor": 0.5, "emissiveFactor": [0.1, 0.0, 0.0]}
        given = pbr(baseColorFactor=[1.0, 0.5, 0.2, 1.0], alphaMode="MASK", alphaCutoff=0.5, doubleSided=True, **factors)
        material = {"base_color": (1, 128 / 255, 0.2), "metallic": 0.25, "roughness": 0.5, "emissive": (0.1, 0, 0)}
        self.check(textured(given), scene(material={**material, "alpha_mode": "mask", "double_sided": True}))

    def test_textures(self):
        texture = np.random.default_rng(3).integers(0, 255, (16, 16, 3), dtype=np.uint8)
        uv = CORNERS[:, :2].astype(float) / 2 + 0.5
        upside_down = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)  # v points up in trimesh

        def expected(**material):
            made = halflit.Scene()
            index = made.add_texture(texture)
            made.add_mesh(CORNERS, FACES, uv=upside_down, material={"base_color_texture": index, **material})
            return made.render(64)

        plain = {"roughness": 0.6, "double_sided": True}
        self.check(textured(simple(image=texture), uv), expected(**plain))  # its grey is what trimesh has for no colour
        self.check(textured(simple(image=texture, diffuse=[200, 0, 0, 255]), uv), expected(base_color=np.uint8([200, 0, 0]), **plain))
        self.check(textured(simple(), uv), scene(material={"base_color": GREY, **plain}))
        self.check(textured(pbr(baseColorTexture=texture, metallicFactor=0.0), uv), expected(metallic=0, roughness=1))

    def test_scenes_and_points(self):
        place = np.eye(4)
        place[:3, 3] = 3, 0, 0

        class Graph:
            nodes_geometry = ["left", "right"]

            def __getitem__(self, node):
                return (np.eye(4) if node == "left" else place), "cube"

        whole = Part(geometry={"cube": colored()}, graph=Graph())
        made = halflit.Scene.from_trimesh(whole)
        self.assertEqual((made.counts["meshes"], made.counts["instances"]), (1, 2))
        self.assertEqual(made.bounds.tolist(), [[-1, -1, -1], [4, 1, 1]])
        cloud = Part(vertices=CORNERS, colors=np.tile(np.array([[255, 0, 0, 255]], np.uint8), (8, 1)))
        self.assertGreater(halflit.render(cloud, 64).report["pixels_visible"], 8)
        with self.assertRaisesRegex(halflit.UsageError, "expected a Trimesh"):
            halflit.Scene.from_trimesh(Part(extents=3))


@unittest.skipUnless(trimesh, "no trimesh")
class OfTrimesh(unittest.TestCase):
    def test_a_box_and_a_scene(self):
        mesh = trimesh.creation.box()
        self.assertEqual(halflit.render(mesh, 64).report["triangles_submitted"], 12)
        self.assertEqual(halflit.render(mesh, 64).pixel_hash, halflit.render((mesh.vertices, mesh.faces), 64).pixel_hash)
        whole = trimesh.Scene([mesh, trimesh.creation.icosphere()])
        self.assertGreater(halflit.render(whole, 64).report["triangles_submitted"], 100)
        mesh.visual.vertex_colors = [255, 0, 0, 255]
        picture = halflit.render(mesh, 64).astype(int)
        self.assertGreater(picture[32, 32, 0], picture[32, 32, 2] + 50)

    def test_a_material_of_a_file(self):
        material = trimesh.visual.material.PBRMaterial(baseColorFactor=[1.0, 0.0, 0.0, 1.0], metallicFactor=0.0)
        mesh = trimesh.creation.box()
        mesh.visual = trimesh.visual.TextureVisuals(material=material)
        file = trimesh.exchange.gltf.export_glb(trimesh.Scene(mesh))
        again = trimesh.load(trimesh.util.wrap_as_stream(file), file_type="glb")
        for model in (mesh, again, file):
            picture = halflit.render(model, 64).astype(int)
            self.assertGreater(picture[32, 32, 0], picture[32, 32, 2] + 50)


class Camera(Part):
    """A camera of trimesh: a width and a height in pixels, and two angles in degrees."""

    def __init__(self):
        super().__init__(resolution=np.array([48, 36]), fov=np.array([60.0, 45.0]), z_near=0.01, z_far=1000.0)


class PointLight(Part):
    pass


def viewed(lights=None, **mesh):
    """A trimesh.Scene of a cube that its camera sees from z = 5."""
    made = Scene()
    made.__dict__.update(vars(stand_ins.scene((colored(**mesh), np.eye(4)))))
    made.camera, made.camera_transform, made._lights = Camera(), moved(0, 0, 5), lights
    return made


class Scene(Part):
    __module__ = "trimesh.scene.scene"

    def save_image(self, resolution=None, **options):
        return b"a window"


@unittest.skipUnless(Image, "no PIL")
class SaveImage(unittest.TestCase):
    def setUp(self):
        patch = unittest.mock.patch.dict(sys.modules, trimesh=types.SimpleNamespace(Scene=Scene))
        patch.start()
        self.addCleanup(patch.stop)
        self.addCleanup(halflit.trimesh.unregister)

    def pixels(self, scene, **options):
        png = scene.save_image(**options)
        self.assertIsInstance(png, bytes)
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))

    def test_scenes_are_drawn_until_unregister(self):
        original = Scene.save_image
        for _ in range(2):
            halflit.trimesh.register()
        pixels = self.pixels(viewed(), resolution=(40, 30), visible=False)
        self.assertEqual((pixels.shape, pixels.dtype), ((30, 40, 4), np.uint8))
        # The cube's front, 2 wide, is 4 away: 15 / (4 tan 22.5 degrees) pixels from the middle to its rim.
        rim = 15 / (4 * np.tan(np.radians(22.5)))
        shown = (pixels != 255).any(axis=2)
        self.assertEqual(shown.any(axis=0).sum(), 2 * round(rim))
        self.assertTrue(shown[15, 20] and not shown[2].any())
        halflit.trimesh.unregister()
        halflit.trimesh.unregister()
        self.assertIs(Scene.save_image, original)
        self.assertEqual(viewed().save_image(), b"a window")

    def test_resolution_and_background(self):
        halflit.trimesh.register()
        scene = viewed()
        self.assertEqual(self.pixels(scene).shape, (36, 48, 4))
        self.assertEqual(self.pixels(scene, resolution=[20, 10]).shape, (10, 20, 4))
        self.assertEqual(list(scene.camera.resolution), [20, 10])  # as trimesh does
        for background, codes in (([10, 20, 30, 255], (10, 20, 30, 255)), ([0.0, 0.2, 1.0], (0, 51, 255, 255))):
            self.assertEqual(tuple(self.pixels(scene, background=background)[0, 0]), codes)
        self.assertEqual(self.pixels(scene, background=[0, 0, 0, 0])[0, 0, 3], 0)
        with self.assertRaisesRegex(TypeError, "backgruond"):
            scene.save_image(backgruond=3)
        with self.assertRaisesRegex(halflit.UsageError, "background"):
            scene.save_image(background="red")

    def test_lights_of_the_scene_shine_from_where_they_are(self):
        halflit.trimesh.register()
        colors = dict(kind="vertex", vertex_colors=np.full((8, 4), 255, np.uint8))
        plain = self.pixels(viewed(**colors)).astype(int)
        scene = viewed([PointLight(name="lamp", color=np.array([255, 0, 0, 255], np.uint8))], **colors)
        scene.graph.nodes["lamp"] = (moved(0, 0, 5), None)
        red = self.pixels(scene).astype(int)
        self.assertLess(np.ptp(plain[18, 24, :3]), 20)
        self.assertGreater(red[18, 24, 0], red[18, 24, 1] + 20)

    @unittest.skipUnless(trimesh, "no trimesh")
    def test_the_real_one(self):
        with unittest.mock.patch.dict(sys.modules, trimesh=trimesh):
            halflit.trimesh.register()
            scene = trimesh.Scene(trimesh.creation.box())
            self.assertEqual(self.pixels(scene, resolution=(32, 24)).shape, (24, 32, 4))
            halflit.trimesh.unregister()


if __name__ == "__main__":
    unittest.main()
