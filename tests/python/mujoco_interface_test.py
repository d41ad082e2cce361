"""halflit.compat.mujoco: arrays of every version are read, pictures have the places, ids and codes that the scene says."""
import sys
import types
import unittest
import unittest.mock
import warnings

import numpy as np

import halflit.compat.mujoco as drawn
from halflit.compat.mujoco import _context
from halflit.compat.mujoco._layouts import layout_of
from halflit.compat.mujoco._scenes import Snapshot
from mujoco_scenes import BOX, FLAGS, MESH, SPHERE, Scene, model

SIZE = 32
#: Bytes of mjvGeom, mjvLight and mjvGLCamera, the place of mjvGeom.rgba, and the numbers of skin and flex, by a C compiler.
COMPILED = {
    (2, 2, 2): (248, 84, 56, 104, 104, -1), (2, 3, 7): (248, 84, 56, 104, 104, -1), (3, 0, 0): (248, 84, 60, 104, 105, 104),
    (3, 1, 6): (248, 88, 60, 104, 106, 105), (3, 2, 7): (236, 88, 64, 92, 106, 105), (3, 3, 2): (236, 88, 64, 92, 106, 105),
    (3, 3, 3): (236, 104, 64, 92, 106, 105), (3, 3, 7): (236, 108, 64, 92, 106, 105), (3, 12, 0): (252, 112, 64, 100, 106, 105),
}  # fmt: skip


def of_version(version):
    """`mujoco` as a module of that version, and without anything else."""
    return unittest.mock.patch.dict(sys.modules, {"mujoco": types.SimpleNamespace(__version__=".".join(map(str, version)))})


def draw(scene, width=SIZE, height=SIZE, context=None, depth=True, **options):
    """Colours, and depth or None, bottom row first."""
    context = context or drawn.MjrContext(model(**options))
    rect = drawn.MjrRect(0, 0, width, height)
    drawn.mjr_render(rect, scene, context)
    rgb, depths = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32) if depth else None
    drawn.mjr_readPixels(rgb, depths, rect, context)
    return rgb, depths


def two_boxes(version=(2, 2, 2)):
    """A grey one above the middle and a red one below it, both of whose nearest sides are 8 from the camera."""
    scene = Scene(version).shine(ambient=0.25, diffuse=0.5)
    scene.add(BOX, (2, 1, 1), (0, 3, 1), (0.5, 0.5, 0.5, 1))
    return scene.add(BOX, (2, 1, 1), (0, -3, 1), (1, 0, 0, 1), objid=7, objtype=1)


class Arrays(unittest.TestCase):
    def test_structs_are_where_a_compiler_puts_them(self):
        for version, (geom, light, camera, rgba, skin, flex) in COMPILED.items():
            found = layout_of(version).struct
            sizes = (found.geom_size, found.light_size, found.camera_size, found.geom_rgba, found.type_skin, found.type_flex)
            self.assertEqual(sizes, (geom, light, camera, rgba, skin, flex), version)

    def test_every_version_and_objects_without_memory_give_one_picture(self):
        wanted = None
        for version in COMPILED:
            with of_version(version):
                scene = two_boxes(version)
                for read in (scene, scene.without_memory()):
                    snapshot = Snapshot().take(read)
                    self.assertEqual(snapshot._memory is None, read is not scene)
                    for found, expected in zip(draw(read), wanted or draw(read)):
                        np.testing.assert_array_equal(found, expected)
                wanted = wanted or draw(scene)

    def test_another_layout_than_the_versions_is_noticed(self):
        with of_version((3, 3, 2)):
            scene = two_boxes((2, 2, 2))
            snapshot = Snapshot()
            self.assertRaises(AttributeError, snapshot.take, scene)  # it has no matid
        with of_version((2, 3, 0)):
            scene = two_boxes((2, 2, 2))
            rows = [{name: np.array(getattr(geom, name)) for name in geom.rows.dtype.names} for geom in scene.geoms]
            scene.geoms = tuple(types.SimpleNamespace(**row) for row in rows)
            self.assertIsNone(Snapshot().take(scene)._memory)
            np.testing.assert_array_equal(draw(scene)[0], draw(two_boxes())[0])

    def test_textures_meshes_and_other_arrays_reach_the_picture(self):
        square = np.array([[-2, -2, 1], [2, -2, 1], [2, 2, 1], [-2, 2, 1]], np.float32)
        arrays = {
            "ngeom": 1, "nmat": 1, "nmesh": 1, "nmeshvert": 4, "nmeshtexvert": 4, "nmeshface": 2, "ntex": 1, "ntexdata": 3,
            "geom_type": [MESH], "geom_matid": [0], "geom_size": [[1, 1, 1]], "mat_texid": [0], "mat_texuniform": [0],
            "mat_texrepeat": [[1, 1]], "mesh_vertadr": [0], "mesh_vertnum": [4], "mesh_texcoordadr": [0], "mesh_faceadr": [0],
            "mesh_facenum": [2], "mesh_graphadr": [-1], "mesh_vert": square, "mesh_normal": np.tile([0, 0, 1], (4, 1)),
            "mesh_texcoord": [[0, 0], [1, 0], [1, 1], [0, 1]], "mesh_face": [[0, 1, 2], [0, 2, 3]],
            "tex_type": [0], "tex_width": [1], "tex_height": [1], "tex_adr": [0], "tex_rgb": [255, 102, 0],
        }  # fmt: skip
        scene = Scene().shine(ambient=1.0)
        scene.add(MESH, (1, 1, 1), (0, 0, 1), dataid=0, texid=0, texcoord=1)
        self.assertEqual(draw(scene, **arrays)[0][SIZE // 2, SIZE // 2].tolist(), [255, 102, 0])
        newer = {**arrays, "nmeshnormal": 4, "nmeshtexcoord": 4, "mesh_normaladr": [0], "mesh_facenormal": arrays["mesh_face"],
                 "mesh_facetexcoord": arrays["mesh_face"], "mat_texid": np.array([[-1, 0] + 8 * [-1]]), "tex_data": arrays.pop("tex_rgb"),
                 "tex_nchannel": [3], "tex_colorspace": [0]}  # fmt: skip
        with of_version((3, 3, 3)):
            scene = Scene((3, 3, 3)).shine(ambient=1.0)
            scene.add(MESH, (1, 1, 1), (0, 0, 1), dataid=0, matid=0, texcoord=1)
            self.assertEqual(draw(scene, **newer)[0][SIZE // 2, SIZE // 2].tolist(), [255, 102, 0])

    def test_skins_and_flexes_are_where_the_scene_has_their_vertices(self):
        corners = np.array([[-2, -2, 2], [2, -2, 2], [2, 2, 2], [-2, 2, 2]], np.float32)
        faces, up = np.array([[0, 1, 2], [0, 2, 3]]), np.tile(np.float32([0, 0, 1]), (6, 1))
        skin = {"nskin": 1, "nskinvert": 4, "nskinface": 2, "skin_vertadr": [0], "skin_vertnum": [4], "skin_texcoordadr": [-1],
                "skin_faceadr": [0], "skin_facenum": [2], "skin_face": faces}  # fmt: skip
        for version, of_model, kind in (((2, 2, 2), skin, 104), ((3, 3, 2), skin, 106), ((3, 3, 2), {"nflex": 1}, 105)):
            with of_version(version):
                scene = Scene(version).add(kind, (1, 1, 1), objid=0)
                if kind == 105:
                    scene.flexfacenum, scene.flexfaceused = np.array([2], np.int32), np.array([2], np.int32)
                    scene.flexface, scene.flexnormal = corners[faces].ravel(), up.ravel()
                else:
                    scene.skinvert, scene.skinnormal = corners.ravel(), up[:4].ravel()
                vertices = scene.flexface if kind == 105 else scene.skinvert
                context = drawn.MjrContext(model(**of_model))
                for z in (2, 5):  # moved between two pictures
                    vertices[2::3] = z
                    depth = drawn.render_batch([scene], context, SIZE, SIZE, rgb=False, depth=True)["depth"][0, SIZE // 2, SIZE // 2]
                    self.assertAlmostEqual(float(depth), 10 - z, places=4)


class Pictures(unittest.TestCase):
    def test_colours_and_depths_are_those_of_the_formula(self):
        rgb, depth = draw(two_boxes())
        grey, red = rgb[SIZE // 2 + 7, SIZE // 2], rgb[SIZE // 2 - 7, SIZE // 2]  # at y = 3.75 and -3.25 of the sides, which are 8 away
        np.testing.assert_allclose(grey.astype(int), 255 * 0.75 * 0.5, atol=1)  # (ambient + diffuse) times the colour
        np.testing.assert_allclose(red.astype(int), [255 * 0.75, 0, 0], atol=1)
        self.assertEqual(rgb[SIZE // 2, SIZE // 2].tolist(), [0, 0, 0])
        near, far = 0.2, 40.0
        self.assertAlmostEqual(float(depth[SIZE // 2 + 7, SIZE // 2]), far * (8 - near) / (8 * (far - near)), places=5)
        self.assertEqual(float(depth[SIZE // 2, SIZE // 2]), 1.0)

    def test_reversed_depths_keep_what_is_far(self):
        context = drawn.MjrContext(model())
        context.readDepthMap = drawn.mjtDepthMap.mjDEPTH_ZEROFAR
        near, far = 0.2, 40.0
        scene = Scene().add(BOX, (60, 60, 1), (0, 0, -26))  # 35 away
        _, depth = draw(scene, context=context)
        distance = near / (depth.astype(np.float64) * (1 - near / far) + near / far)
        np.testing.assert_allclose(distance, 35, rtol=1e-6)
        self.assertEqual(draw(Scene(), context=context)[1].tolist(), np.zeros((SIZE, SIZE)).tolist())

    def test_segments_have_numbers(self):
        scene = two_boxes()
        scene.flags[[FLAGS["segment"], FLAGS["idcolor"]]] = 1
        rgb, _ = draw(scene)
        middle = SIZE // 2
        self.assertEqual([rgb[row, middle].tolist() for row in (middle + 7, middle, middle - 7)], [[1, 0, 0], [0, 0, 0], [2, 0, 0]])
        planes = drawn.render_batch([scene], drawn.MjrContext(model()), SIZE, SIZE, rgb=False, depth=True, segmentation=True)
        self.assertEqual(set(planes), {"depth", "segmentation"})
        found = planes["segmentation"][0, :, middle]  # the top row first
        self.assertEqual([found[row].tolist() for row in (middle - 8, middle, middle + 6)], [[0, 5], [-1, -1], [7, 1]])
        np.testing.assert_allclose(planes["depth"][0, (middle - 8, middle), middle], (8, 40), rtol=1e-5)

    def test_many_scenes_at_once_are_those_alone(self):
        scenes = [two_boxes(), Scene().shine(diffuse=1.0).add(SPHERE, (3, 3, 3)), Scene()]
        for threads in (1, 0):
            context = drawn.MjrContext(model(samples=4), threads=threads)
            many = drawn.render_batch(scenes, context, SIZE, SIZE)["rgb"]
            for scene, rgb in zip(scenes, many):
                np.testing.assert_array_equal(draw(scene, context=context)[0][::-1], rgb)
        self.assertEqual(drawn.render_batch([], context, SIZE, SIZE)["rgb"].shape, (0, SIZE, SIZE, 3))

    def test_a_picture_is_of_the_moment_of_mjr_render(self):
        context, scene = drawn.MjrContext(model()), two_boxes()
        wanted, _ = draw(scene, context=context)
        rect = drawn.MjrRect(0, 0, SIZE, SIZE)
        drawn.mjr_render(rect, scene, context)
        scene.geoms[0].rgba, scene.ngeom = (0, 1, 0, 1), 1
        found = np.zeros_like(wanted)
        drawn.mjr_readPixels(found, None, rect, context)
        np.testing.assert_array_equal(found, wanted)
        self.assertGreater((draw(scene, context=context)[0] != wanted).sum(), 20)

    def test_a_picture_keeps_the_model_of_its_moment(self):
        flat = {"ntex": 1, "ntexdata": 3, "tex_type": [0], "tex_width": [1], "tex_height": [1], "tex_adr": [0]}
        changing = model(**flat, tex_rgb=np.array([255, 0, 0], np.uint8))
        context, scene = drawn.MjrContext(changing), Scene().shine(ambient=1.0)
        scene.add(BOX, (1, 1, 1), (0, 0, 1), (1, 1, 1, 1), texid=0, texcoord=0)
        rect, rgb = drawn.MjrRect(0, 0, SIZE, SIZE), np.zeros((SIZE, SIZE, 3), np.uint8)
        drawn.mjr_render(rect, scene, context)
        changing.tex_rgb[:] = (0, 255, 0)
        drawn.mjr_uploadTexture(changing, context, 0)
        for wanted in ([255, 0, 0], [0, 255, 0]):
            drawn.mjr_readPixels(rgb, None, rect, context)
            self.assertEqual(rgb[SIZE // 2, SIZE // 2].tolist(), wanted)
            drawn.mjr_render(rect, scene, context)

    def test_the_buffer_keeps_a_bounded_number_of_pictures(self):
        context, scene = drawn.MjrContext(model()), Scene()
        for i in range(200):
            drawn.mjr_render(drawn.MjrRect(i, 0, 4, 4), scene, context)
            drawn.mjr_render(drawn.MjrRect(-9, i, 4, 4), scene, context)
        self.assertEqual([frame.rect[0] for frame in context._frames], list(range(136, 200)))
        self.assertEqual(len(context._frames) + len(context._spare), 65)

    def test_parts_of_the_buffer(self):
        context = drawn.MjrContext(model())
        one, two = two_boxes(), Scene().shine(ambient=1.0).add(SPHERE, (3, 3, 3))
        for scene, left in ((two, 0), (one, 0), (two, SIZE)):
            drawn.mjr_render(drawn.MjrRect(left, 4, SIZE, SIZE), scene, context)
        self.assertEqual(len(context._frames), 2)  # the first one is covered
        whole, depth = np.full((SIZE + 4, 2 * SIZE, 3), 9, np.uint8), np.empty((SIZE + 4, 2 * SIZE), np.float32)
        drawn.mjr_readPixels(whole, depth, drawn.MjrRect(0, 0, 2 * SIZE, SIZE + 4), context)
        self.assertFalse(whole[:4].any())
        for scene, part in ((one, np.s_[4:, :SIZE]), (two, np.s_[4:, SIZE:])):
            for found, wanted in zip((whole[part], depth[part]), draw(scene)):
                np.testing.assert_array_equal(found, wanted)
        few = np.empty(3 * 5 * 6, np.uint8)
        drawn.mjr_readPixels(few, None, drawn.MjrRect(SIZE - 3, 10, 5, 6), context)
        np.testing.assert_array_equal(few.reshape(6, 5, 3), whole[10:16, SIZE - 3 : SIZE + 2])
        width, height = context.offWidth, context.offHeight
        self.assertEqual(drawn.mjr_maxViewport(context), drawn.MjrRect(0, 0, width, height))
        drawn.mjr_resizeOffscreen(10, 20, context)
        self.assertEqual((context.offWidth, context.offHeight), (10, 20))

    def test_what_is_left_out_warns_once(self):
        context, scene = drawn.MjrContext(model()), two_boxes()
        scene.flags[1] = 1  # wireframe
        _context._warned.clear()
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            wire = [draw(scene, context=context)[0] for _ in range(2)]
            drawn.mjr_text(1, "text", context, 0, 0, 1, 1, 1)
        self.assertEqual([str(one.message).split()[1] for one in told], ["mjRND_WIREFRAME", "mjr_text()"])
        np.testing.assert_array_equal(wire[0], draw(two_boxes())[0])

    def test_arrays_that_cannot_be_written_are_refused(self):
        context, rect = drawn.MjrContext(model()), drawn.MjrRect(0, 0, 4, 4)
        drawn.mjr_render(rect, Scene(), context)
        for wrong in (np.zeros((4, 4, 3), np.int8), np.zeros((4, 4), np.uint8), np.zeros((4, 8, 3), np.uint8)[:, ::2], bytes(48)):
            with self.assertRaisesRegex(ValueError, "^rgb: [^\n]*48"):
                drawn.mjr_readPixels(wrong, None, rect, context)
        self.assertRaises(ValueError, drawn.mjr_readPixels, None, np.zeros((4, 4)), rect, context)
        with self.assertRaisesRegex(ValueError, "^look: [^\n]*3.12.0"):
            drawn.MjrContext(model(), look="4.0")
        context.free()
        with self.assertRaisesRegex(RuntimeError, "freed"):
            drawn.mjr_render(rect, Scene(), context)

    def test_looks_and_settings_of_a_context(self):
        for asked, look in {"2.3.7": "2.2.2", "3.2.7": "2.2.2", "3.3": "3.3.2", "3.3.2": "3.3.2", "3.11": "3.3.3", "3.12": "3.12.0", "3.14.1": "3.12.0"}.items():
            self.assertEqual(drawn.MjrContext(model(), look=asked).look, look)
        looks = {(2, 2, 2): "2.2.2", (3, 1, 6): "2.2.2", (3, 3, 2): "3.3.2", (3, 3, 3): "3.3.3", (3, 12, 0): "3.12.0"}
        for version, look in looks.items():
            with of_version(version):
                self.assertEqual(drawn.MjrContext(model()).look, look)
        context = drawn.MjrContext(model(), drawn.mjtFontScale.mjFONTSCALE_100)
        self.assertEqual((context.fontScale, context.offWidth, context.fogEnd), (100, 640, 40.0))
        drawn.mjr_setBuffer(drawn.mjtFramebuffer.mjFB_OFFSCREEN, context)
        self.assertEqual(context.currentBuffer, 1)
        scene = two_boxes()
        scene.flags[5] = 1  # fog
        plain, _ = draw(scene, context=context)
        context.fogStart, context.fogEnd, context.fogRGBA[:] = 0.0, 8.0, (0, 1, 0, 1)  # all that is seen is in the fog's colour
        self.assertEqual(draw(scene, context=context)[0][SIZE // 2 + 7, SIZE // 2].tolist(), [0, 255, 0])
        self.assertNotEqual(plain[SIZE // 2 + 7, SIZE // 2].tolist(), [0, 255, 0])
        context.offSamples = 4
        self.assertGreater(len(np.unique(draw(two_boxes().look(up=(0.3, 1, 0)), context=context)[0])), len(np.unique(plain)))

    def test_what_is_left_out_says_so_once(self):
        _context._warned.clear()
        context = drawn.MjrContext(model())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for _ in range(2):
                drawn.mjr_overlay(150, 0, drawn.MjrRect(0, 0, 4, 4), b"fps", b"60", context)
                drawn.mjr_figure(drawn.MjrRect(0, 0, 4, 4), None, context)
        self.assertEqual([str(one.message).partition(":")[2].split("(")[0].strip() for one in caught], ["mjr_overlay", "mjr_figure"])
        self.assertEqual({one.filename for one in caught}, {__file__})
        self.assertEqual((drawn.mjr_getError(), drawn.mjr_finish()), (0, None))
        self.assertEqual(drawn.mjr_findRect(5, 1, 2, [drawn.MjrRect(0, 0, 5, 5), drawn.MjrRect(5, 0, 5, 5)]), 1)

    def test_installing_replaces_what_draws_and_nothing_else(self):
        module = types.ModuleType("mujoco")
        module.__version__, module.mjtFramebuffer, module.MjrContext, module.egl = "3.3.2", "own", "own", "own"
        with unittest.mock.patch.dict(sys.modules, {"mujoco": module}):
            drawn.install(look="2.2.2", threads=1)
            self.assertEqual((module.mjtFramebuffer, module.MjrContext, module.Renderer), ("own", drawn.MjrContext, drawn.Renderer))
            import mujoco.egl

            self.assertIs(mujoco.egl.GLContext, drawn.GLContext)
            context = module.MjrContext(model())
            self.assertEqual((context.look, context.threads), ("2.2.2", 1))
            self.assertIsNone(module.GLContext(4, 4).make_current())
            for name in drawn.__all__:
                if name.startswith(("mjr_", "Mjr")):
                    self.assertIs(getattr(module, name), getattr(drawn, name))
            drawn.uninstall()
            self.assertEqual((module.MjrContext, module.egl, hasattr(module, "mjr_render")), ("own", "own", False))
            self.assertEqual(drawn.MjrContext(model()).look, "3.3.2")
        self.assertNotIn("mujoco.egl", sys.modules)
        self.assertRaises(ValueError, drawn.install, look="4.0")


if __name__ == "__main__":
    unittest.main()
