"""Meshes of trimesh. Without it, objects that offer what trimesh's do stand in for them."""
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES

try:
    import trimesh
except ImportError:
    trimesh = None


class Part:
    """Members as attributes."""

    def __init__(self, **members):
        self.__dict__.update(members)


class StandIn(Part):
    __module__ = "trimesh.base"


NORMALS = CORNERS / np.float32(3**0.5)


def stand_in(**visual):
    arrays = {"vertices": CORNERS.astype(float), "faces": FACES.astype(np.int64), "vertex_normals": NORMALS.astype(float)}
    return StandIn(visual=Part(**visual), **arrays)


def scene(**mesh):
    made = halflit.Scene()
    material = {"metallic": 0.0, "roughness": 0.8, **mesh.pop("material", {})}
    made.add_mesh(CORNERS, FACES, normals=NORMALS, material=material, **mesh)
    return made.render(64)


class OfStandIns(unittest.TestCase):
    def check(self, mesh, expected):
        self.assertEqual(halflit.render(mesh, 64).pixel_hash, expected.pixel_hash)

    def test_geometry_and_colours(self):
        self.check(stand_in(kind=None), scene())
        colors = np.tile(np.array([[200, 30, 90, 255], [10, 250, 90, 255]], np.uint8), (4, 1))
        self.check(stand_in(kind="vertex", vertex_colors=colors), scene(colors=colors))
        one = np.tile(np.array([[200, 30, 90, 255]], np.uint8), (12, 1))
        self.check(stand_in(kind="face", face_colors=one), scene(colors=np.tile(one[:1], (8, 1))))

    def test_textures_and_materials(self):
        texture = np.random.default_rng(3).integers(0, 255, (16, 16, 3), dtype=np.uint8)
        uv = CORNERS[:, :2] / 2 + 0.5
        upside_down = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)  # v points up in trimesh
        simple = Part(image=texture, diffuse=np.array([255, 255, 255, 255], np.uint8))
        expected = halflit.Scene()
        index = expected.add_texture(texture)
        material = {"metallic": 0.0, "roughness": 0.8, "base_color_texture": index}
        expected.add_mesh(CORNERS, FACES, normals=NORMALS, uv=upside_down, material=material)
        self.check(stand_in(kind="texture", uv=uv, material=simple), expected.render(64))
        factors = {"baseColorFactor": [1.0, 0.5, 0.2, 1.0], "metallicFactor": 0.25, "roughnessFactor": 0.5, "emissiveFactor": None}
        pbr = Part(baseColorTexture=None, alphaMode="MASK", alphaCutoff=0.5, doubleSided=True, **factors)
        material = {"base_color": (1, 0.5, 0.2), "metallic": 0.25, "roughness": 0.5, "alpha_mode": "mask", "double_sided": True}
        self.check(stand_in(kind="texture", uv=uv, material=pbr), scene(uv=upside_down, material=material))

    def test_scenes_and_points(self):
        place = np.eye(4)
        place[:3, 3] = 3, 0, 0

        class Graph:
            nodes_geometry = ["left", "right"]

            def __getitem__(self, node):
                return (np.eye(4) if node == "left" else place), "cube"

        whole = StandIn(geometry={"cube": stand_in(kind=None)}, graph=Graph())
        made = halflit.Scene.from_trimesh(whole)
        self.assertEqual((made.counts["meshes"], made.counts["instances"]), (1, 2))
        self.assertEqual(made.bounds.tolist(), [[-1, -1, -1], [4, 1, 1]])
        cloud = StandIn(vertices=CORNERS, colors=np.tile(np.array([[255, 0, 0, 255]], np.uint8), (8, 1)))
        self.assertGreater(halflit.render(cloud, 64).report["pixels_visible"], 8)
        with self.assertRaisesRegex(halflit.UsageError, "expected a Trimesh"):
            halflit.Scene.from_trimesh(StandIn(extents=3))


@unittest.skipUnless(trimesh, "no trimesh")
class OfTrimesh(unittest.TestCase):
    def test_a_box_and_a_scene(self):
        mesh = trimesh.creation.box()
        self.assertEqual(halflit.render(mesh, 64).report["triangles_submitted"], 12)
        whole = trimesh.Scene([mesh, trimesh.creation.icosphere()])
        self.assertGreater(halflit.render(whole, 64).report["triangles_submitted"], 100)
        mesh.visual.vertex_colors = [255, 0, 0, 255]
        picture = halflit.render(mesh, 64).astype(int)
        self.assertGreater(picture[32, 32, 0], picture[32, 32, 2] + 50)


if __name__ == "__main__":
    unittest.main()
