"""mujoco.Renderer's interface, with pictures of many states and cameras at once."""
from __future__ import annotations

import ctypes
import importlib
from typing import Any, Dict, Iterable, List, Optional, Sequence

import numpy as np

from halflit import _c
from halflit._errors import UsageError
from halflit._types import Array

from ._context import DISTANCE, SEGMENT, MjrContext
from ._scenes import Snapshot

#: Plane -> its numbers a pixel, none if there is one, and their type.
_PLANES = {"rgb": ((3,), np.uint8), "depth": ((), np.float32), "segmentation": ((2,), np.int32)}
_POINTERS = {"rgb": "rgb", "depth": "depth", "segmentation": "object"}


def _draw(context: MjrContext, snapshots: Sequence[Snapshot], planes: Dict[str, Array]) -> None:
    """Draws picture i of the snapshots into row i of each plane."""
    pictures = (_c.STRUCT["halflit_mujoco_picture"] * len(snapshots))()
    height, width = next(iter(planes.values())).shape[1:3]
    for i, snapshot in enumerate(snapshots):
        pictures[i] = context.picture(snapshot, width=width, height=height, depth_unit=DISTANCE, depth_pass=SEGMENT)
        for name, array in planes.items():
            setattr(pictures[i], _POINTERS[name], array.ctypes.data + i * array.strides[0])
    if snapshots:
        context.draw(pictures, snapshots)


def _made(name: str, shape: Sequence[int], out: Any) -> Array:
    """The memory of a plane: the caller's, or new."""
    numbers, kind = _PLANES[name]
    shape = (*shape, *numbers)
    if out is None:
        return np.empty(shape, kind)
    if not isinstance(out, np.ndarray) or out.shape != shape:
        raise UsageError(f"out: expected an array of shape {shape}, found {getattr(out, 'shape', type(out).__name__)}")
    return out if out.dtype == kind and out.flags.c_contiguous and out.flags.writeable else np.empty(shape, kind)


def render_batch(
    scenes: Iterable[Any], context: MjrContext, height: int, width: int, *, rgb: bool = True, depth: bool = False,
    segmentation: bool = False,
) -> Dict[str, Array]:  # fmt: skip
    """Pictures of many mjvScene of one model, drawn at once on all cores: arrays whose first index is the scene's, top row first.

    rgb: uint8 (n, height, width, 3). depth: float32 (n, height, width), distance along the view in the model's unit, the far plane's where
    nothing is. segmentation: int32 (n, height, width, 2), objid and objtype, -1 where nothing is.
    """
    snapshots = [context.snapshot(scene) for scene in scenes]
    wanted = [name for name, is_wanted in (("rgb", rgb), ("depth", depth), ("segmentation", segmentation)) if is_wanted]
    planes = {name: _made(name, (len(snapshots), height, width), None) for name in wanted}
    try:
        if planes:
            _draw(context, snapshots, planes)
    finally:
        for snapshot in snapshots:
            context.release(snapshot)
    return planes


class Renderer:
    """Draws a model's states as mujoco.Renderer does, in the same shapes and types: colours, distances after enable_depth_rendering(), and
    (objid, objtype) after enable_segmentation_rendering(). look and threads: see MjrContext."""

    def __init__(
        self, model: Any, height: int = 240, width: int = 320, max_geom: int = 10000, font_scale: Any = 150, *,
        look: Optional[str] = None, threads: Optional[int] = None,
    ) -> None:  # fmt: skip
        self._context: Optional[MjrContext] = None
        for name, size, limit in (("width", width, model.vis.global_.offwidth), ("height", height, model.vis.global_.offheight)):
            if size > limit:
                cure = f'<visual><global off{name}="{size}"/></visual> in the model makes it larger'
                raise ValueError(f"image {name} {size} > framebuffer {name} {limit}: {cure}")
        self._mujoco = importlib.import_module("mujoco")
        self._model, self._height, self._width = model, height, width
        self._scene = self._mujoco.MjvScene(model, max_geom)
        self._option = self._mujoco.MjvOption()
        self._context = MjrContext(model, font_scale, look=look, threads=threads)
        self._plane = "rgb"

    @property
    def model(self) -> Any:
        """The MjModel."""
        return self._model

    @property
    def scene(self) -> Any:
        """The MjvScene that is drawn; its flags may be set, and geoms added."""
        return self._scene

    @property
    def height(self) -> int:
        """Pixels."""
        return self._height

    @property
    def width(self) -> int:
        """Pixels."""
        return self._width

    def enable_depth_rendering(self) -> None:
        """render() gives distances."""
        self._plane = "depth"

    def disable_depth_rendering(self) -> None:
        """render() gives colours."""
        self._plane = "rgb" if self._plane == "depth" else self._plane

    def enable_segmentation_rendering(self) -> None:
        """render() gives (objid, objtype)."""
        self._plane = "segmentation"

    def disable_segmentation_rendering(self) -> None:
        """render() gives colours."""
        self._plane = "rgb" if self._plane == "segmentation" else self._plane

    def update_scene(self, data: Any, camera: Any = -1, scene_option: Any = None) -> None:
        """Takes a state of the model. camera: an MjvCamera, or the name or number of one of the model's; -1: the free camera."""
        mujoco = self._mujoco
        if not isinstance(camera, mujoco.MjvCamera):
            number = camera
            if isinstance(camera, str):
                number = mujoco.mj_name2id(self._model, int(mujoco.mjtObj.mjOBJ_CAMERA), camera)
                if number == -1:
                    raise ValueError(f'The camera "{camera}" does not exist.')
            if not -1 <= number < self._model.ncam:
                raise ValueError(f"The camera id {number} is out of range [-1, {self._model.ncam}).")
            camera = mujoco.MjvCamera()
            camera.fixedcamid = number
            if number == -1:
                camera.type = mujoco.mjtCamera.mjCAMERA_FREE
                mujoco.mjv_defaultFreeCamera(self._model, camera)
            else:
                camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        every = int(mujoco.mjtCatBit.mjCAT_ALL)
        mujoco.mjv_updateScene(self._model, data, scene_option or self._option, None, camera, every, self._scene)

    def render(self, *, out: Optional[Array] = None) -> Array:
        """The picture of the state that was taken last, or `out`, into which it is written."""
        return self._drawn([self._open().snapshot(self._scene)], (), out)

    def render_all(self) -> Dict[str, Array]:
        """All planes of the state that was taken last, drawn at once: render()'s arrays by "rgb", "depth" and "segmentation"."""
        planes = render_batch([self._scene], self._open(), self._height, self._width, depth=True, segmentation=True)
        return {name: plane[0] for name, plane in planes.items()}

    def render_batch(
        self, states: Sequence[Any], cameras: Sequence[Any] = (-1,), scene_option: Any = None, *, out: Optional[Array] = None
    ) -> Array:
        """Pictures of each state (MjData) by each camera, drawn at once on all cores: an array of (states, cameras) arrays of render().
        None depends on the others: MuJoCo centres an infinite floor on the camera of the update before, so each scene is updated twice."""
        snapshots: List[Snapshot] = []
        for data in states:
            for camera in (cameras,) if isinstance(cameras, str) else cameras:
                self.update_scene(data, camera, scene_option)
                self.update_scene(data, camera, scene_option)
                snapshots.append(self._open().snapshot(self._scene))
        return self._drawn(snapshots, (len(states), len(cameras)), out)

    def _open(self) -> MjrContext:
        if self._context is None:
            raise RuntimeError("render cannot be called after close.")
        return self._context

    def _drawn(self, snapshots: List[Snapshot], shape: Sequence[int], out: Optional[Array]) -> Array:
        context = self._open()
        try:
            made = _made(self._plane, (*shape, self._height, self._width), out)
            _draw(context, snapshots, {self._plane: made.reshape(len(snapshots), *made.shape[len(shape) :])})
        finally:
            for snapshot in snapshots:
                context.release(snapshot)
        if out is not None and out is not made:
            out[...] = made
        return made if out is None else out

    def close(self) -> None:
        """Frees what was copied of the model."""
        if self._context is not None:
            self._context.free()
        self._context = None

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
