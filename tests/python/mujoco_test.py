"""halflit.compat.mujoco over MuJoCo's own simulation (libmujoco 2.2.2 by mujoco_stand_in.py; the module `mujoco` is not in Debian)."""
import gc
import os
import re
import sys
import tempfile
import time
import unittest
import unittest.mock
import weakref

import numpy as np

import halflit.compat.mujoco as drawn
from halflit.compat.mujoco import _scenes

try:
    import mujoco_stand_in as mujoco
except ImportError as error:
    print(f"skipped: {error}")
    raise unittest.SkipTest(str(error)) from None

WORLD = """<mujoco>
  <visual><global offwidth="320" offheight="240"/><map znear=".05" zfar="30"/><quality shadowsize="1024"/></visual>
  <statistic extent="2" center="0 0 1"/>
  <asset>
    <texture name="grid" type="2d" builtin="checker" width="64" height="64" rgb1=".2 .3 .4" rgb2=".6 .7 .8"/>
    <material name="grid" texture="grid" texrepeat="4 4" reflectance=".2"/>
  </asset>
  <worldbody>
    <light name="lamp" pos="0 -2 4" dir="0 .4 -1" diffuse=".7 .7 .7"/>
    <camera name="side" pos="0 -4 1" xyaxes="1 0 0 0 0 1" fovy="60"/>
    <camera name="top" pos="0 0 5" fovy="50"/>
    <geom name="floor" type="plane" size="5 5 .1" material="grid"/>
    <body name="ball" pos="-.8 0 1"><freejoint/><geom name="ball" type="sphere" size=".5" rgba=".8 .2 .1 1"/></body>
    <body pos=".9 0 1"><joint axis="0 1 0"/><geom name="arm" type="capsule" fromto="0 0 0 0 0 1" size=".15" rgba=".2 .7 .3 1"/>
      <body pos="0 0 1"><joint axis="0 1 0"/><geom name="box" type="box" size=".3 .2 .1" rgba=".3 .4 .9 .5"/></body></body>
  </worldbody>
</mujoco>"""
SIZE = (120, 160)  # height, width
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def world():
    model = mujoco.MjModel.from_xml_string(WORLD)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def geom(model, name):
    return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name)


class Installed(unittest.TestCase):
    def setUp(self):
        patch = unittest.mock.patch.dict(sys.modules, {"mujoco": mujoco})
        patch.start()
        self.addCleanup(patch.stop)
        drawn.install()
        self.addCleanup(drawn.uninstall)
        self.model, self.data = world()

    def test_a_scene_is_read_from_its_memory(self):
        scene, option, camera = mujoco.MjvScene(self.model, 50), mujoco.MjvOption(), mujoco.MjvCamera()
        mujoco.mjv_defaultFreeCamera(self.model, camera)
        mujoco.mjv_updateScene(self.model, self.data, option, None, camera, mujoco.mjtCatBit.mjCAT_ALL, scene)
        by_memory, by_attributes = _scenes.Snapshot().take(scene), _scenes.Snapshot()
        self.assertIsNotNone(by_memory._memory)
        with unittest.mock.patch.object(_scenes, "_memory_of", lambda *_: None):
            by_attributes.take(scene)
        layout = _scenes.layout_of((2, 2, 2))
        for name, struct, count in (("geoms", "geom", scene.ngeom), ("lights", "light", scene.nlight), ("camera", "camera", 2)):
            rows = [np.frombuffer(one._buffers[name], layout.types[struct], count) for one in (by_memory, by_attributes)]
            for member in layout.read[struct]:
                np.testing.assert_array_equal(rows[0][member], rows[1][member], member)
        kept = weakref.ref(scene)
        del scene, by_memory
        gc.collect()
        self.assertIsNone(kept())

    def test_planes_are_those_of_the_model(self):
        with mujoco.Renderer(self.model, *SIZE) as renderer:
            self.assertIs(type(renderer), drawn.Renderer)
            self.assertEqual((renderer.height, renderer.width, renderer.model), (*SIZE, self.model))
            renderer.update_scene(self.data, "side")
            rgb = renderer.render()
            self.assertEqual((rgb.shape, rgb.dtype), ((*SIZE, 3), np.uint8))
            renderer.enable_depth_rendering()
            depth = renderer.render()
            self.assertEqual((depth.shape, depth.dtype), (SIZE, np.float32))
            renderer.enable_segmentation_rendering()
            ids = renderer.render()
            self.assertEqual((ids.shape, ids.dtype), ((*SIZE, 2), np.int32))
            renderer.disable_segmentation_rendering()
            np.testing.assert_array_equal(renderer.render(), rgb)
            planes = renderer.render_all()
            self.assertEqual(list(planes), ["rgb", "depth", "segmentation"])
            for found, wanted in zip(planes.values(), (rgb, depth, ids)):
                np.testing.assert_array_equal(found, wanted)
        # The ray through a pixel's middle of the camera "side" meets the ball, the floor, or nothing where the sky is.
        height, width = SIZE
        rows, columns = np.mgrid[:height, :width] + 0.5
        scale = np.tan(np.radians(30)) * 2 / height
        ray = np.stack([(columns - width / 2) * scale, np.ones(SIZE), (height / 2 - rows) * scale], axis=-1)
        ball, middle = geom(self.model, "ball"), np.array([-0.8, 4, 0])  # from the camera
        square, along = (ray**2).sum(axis=-1), ray @ middle
        root = along**2 - square * (middle @ middle - 0.25)
        inside = root > 0.02  # of 28 slices and 16 stacks
        self.assertTrue((ids[inside] == (ball, int(mujoco.mjtObj.mjOBJ_GEOM))).all())
        np.testing.assert_allclose(depth[inside], ((along - np.sqrt(np.maximum(root, 0))) / square)[inside], atol=0.02)
        floor = ids[..., 0] == geom(self.model, "floor")
        self.assertGreater(floor.sum(), 1000)
        away = -1 / ray[floor][:, 2]
        self.assertLess((np.abs(depth[floor] - away) / away**2).max(), scale / 256)  # by which vertices are rounded: 1 / 256 pixel
        nothing = ids[..., 0] < 0
        self.assertTrue(nothing.any() and (ids[nothing] == -1).all())
        np.testing.assert_allclose(depth[nothing], 60, rtol=1e-6)
        self.assertEqual(set(np.unique(ids[..., 0])), {-1, *range(self.model.ngeom)})

    def test_the_functions_draw_what_the_renderer_draws(self):
        renderer = drawn.Renderer(self.model, *SIZE)
        renderer.update_scene(self.data, "side")
        rect, context = mujoco.MjrRect(0, 0, SIZE[1], SIZE[0]), mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_150)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
        rgb, depth = np.empty((*SIZE, 3), np.uint8), np.empty(SIZE, np.float32)
        mujoco.mjr_render(rect, renderer.scene, context)
        mujoco.mjr_readPixels(rgb, depth, rect, context)
        np.testing.assert_array_equal(rgb[::-1], renderer.render())
        renderer.scene.flags[[mujoco.mjtRndFlag.mjRND_SEGMENT, mujoco.mjtRndFlag.mjRND_IDCOLOR]] = 1
        context.readDepthMap = drawn.mjtDepthMap.mjDEPTH_ZEROFAR
        mujoco.mjr_render(rect, renderer.scene, context)
        renderer.scene.flags[[mujoco.mjtRndFlag.mjRND_SEGMENT, mujoco.mjtRndFlag.mjRND_IDCOLOR]] = 0
        mujoco.mjr_readPixels(rgb, depth, rect, context)
        renderer.enable_depth_rendering()
        distances = renderer.render().astype(np.float64)
        near, far = 0.1, 60.0
        np.testing.assert_allclose(near * far / (near + depth[::-1].astype(np.float64) * (far - near)), distances, rtol=1e-5)
        renderer.enable_segmentation_rendering()
        numbers = rgb[::-1].astype(int) @ (1, 256, 65536) - 1
        objects = np.array([(one.objid, one.objtype) for one in renderer.scene.geoms[: renderer.scene.ngeom]] + [(-1, -1)])
        np.testing.assert_array_equal(objects[numbers], renderer.render())
        self.assertEqual(len(np.unique(numbers)), 1 + self.model.ngeom)

    def test_states_and_cameras_at_once(self):
        states = [self.data]
        for i in (1, 2):
            data = mujoco.MjData(self.model)
            data.qpos[2], data.qpos[7] = 1 + i / 4, i / 2
            mujoco.mj_forward(self.model, data)
            states.append(data)
        free = mujoco.MjvCamera()
        mujoco.mjv_defaultFreeCamera(self.model, free)
        free.distance = 2.5
        cameras = ("side", 1, free, -1)
        renderer = drawn.Renderer(self.model, *SIZE)
        for plane, shape in (("rgb", (3,)), ("depth", ()), ("segmentation", (2,))):
            renderer._plane = plane
            out = renderer.render_batch(states, cameras)
            self.assertEqual(out.shape, (3, 4, *SIZE, *shape))
            for row, data in zip(out, states):
                for found, camera in zip(row, cameras):
                    renderer.update_scene(data, camera)
                    np.testing.assert_array_equal(renderer.render(), found)
            self.assertEqual(len({picture.tobytes() for row in out for picture in row}), 12)
            again = np.zeros_like(out)
            self.assertIs(renderer.render_batch(states, cameras, out=again), again)
            np.testing.assert_array_equal(again, out)
        single = np.zeros((*SIZE, 2), np.int64)
        self.assertIs(renderer.render(out=single), single)
        np.testing.assert_array_equal(single, out[-1, -1])

    def test_textures_and_geoms_that_a_program_changes(self):
        renderer = drawn.Renderer(self.model, *SIZE)
        renderer.update_scene(self.data, "top")
        before = renderer.render()
        self.model.tex_rgb[:] = 255
        np.testing.assert_array_equal(renderer.render(), before)
        drawn.mjr_uploadTexture(self.model, renderer._context, 0)
        self.assertGreater((renderer.render() != before).mean(), 0.2)
        scene, number = renderer.scene, renderer.scene.ngeom
        mujoco.mjv_initGeom(scene.geoms[number], mujoco.mjtGeom.mjGEOM_SPHERE, [0.5] * 3, [0, 0, 3], np.eye(3), [1, 0, 1, 1])
        scene.geoms[number].segid, scene.geoms[number].objid, scene.ngeom = number, 77, number + 1
        renderer.enable_segmentation_rendering()
        self.assertEqual(int(renderer.render()[SIZE[0] // 2, SIZE[1] // 2, 0]), 77)

    def test_what_is_wrong_is_named(self):
        for size, name in (((241, 10), "height"), ((10, 321), "width")):
            with self.assertRaisesRegex(ValueError, f"off{name}"):
                drawn.Renderer(self.model, *size)
        renderer = drawn.Renderer(self.model, *SIZE)
        for camera in ("front", 2, -2):
            with self.assertRaisesRegex(ValueError, str(camera)):
                renderer.update_scene(self.data, camera)
        self.assertRaises(ValueError, renderer.render, out=np.zeros((4, 4, 3), np.uint8))
        renderer.close()
        with self.assertRaisesRegex(RuntimeError, "close"):
            renderer.render()

    def test_the_pages_programs_run(self):
        with open(os.path.join(ROOT, "docs", "mujoco.md"), encoding="utf-8") as file:
            programs = re.findall(r"```python\n(.*?)```", file.read(), re.S)
        self.assertEqual(len(programs), 3)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "model.xml"), "w", encoding="utf-8") as file:
                file.write(WORLD)
            os.chdir(folder)
            self.addCleanup(os.chdir, before)
            found = [{"__name__": "page"} for _ in programs]
            for program, scope in zip(programs, found):
                exec(program, scope)  # noqa: S102
        pictures = (found[0]["pixels"], found[1]["objects"], found[2]["pictures"])
        for picture, shape in zip(pictures, ((120, 160, 3), (120, 160, 2), (8, 2, 84, 84, 3))):
            self.assertEqual(picture.shape, shape)
            self.assertGreater(len(np.unique(picture)), 4)

    def test_pythons_share_of_a_frame_is_small(self):
        rect, context = mujoco.MjrRect(0, 0, 84, 84), mujoco.MjrContext(self.model, 150)
        renderer = drawn.Renderer(self.model, 84, 84)
        renderer.update_scene(self.data, "side")
        rgb, spent = np.empty((84, 84, 3), np.uint8), []
        mujoco.mjr_render(rect, renderer.scene, context)
        mujoco.mjr_readPixels(rgb, None, rect, context)
        with unittest.mock.patch.object(drawn.MjrContext, "draw", lambda *_: None):
            for _ in range(200):
                began = time.perf_counter()
                mujoco.mjr_render(rect, renderer.scene, context)
                mujoco.mjr_readPixels(rgb, None, rect, context)
                spent.append(time.perf_counter() - began)
        self.assertLess(min(spent), 0.3e-3)  # 0.05 ms here


if __name__ == "__main__":
    unittest.main()
