"""One pass over a halflit scene: colours, or depths and numbers of instances."""
from __future__ import annotations

from typing import Any, Dict, Tuple

import numpy as np

from halflit import _frame
from halflit._camera import Camera
from halflit._execution import Execution
from halflit._members import CameraMembers
from halflit._setup import request_of, set_up
from halflit._target import Target

from ._values import Array
from ._world import World

Size = Tuple[int, int]


class View:
    """A camera of halflit for a projection matrix and a pose. scale: a length of the camera's space in world units."""

    def __init__(self, projection: Array, pose: Array) -> None:
        self.key = (projection.tobytes(), pose.tobytes())
        lengths = np.linalg.norm(pose[:3, :3], axis=0)
        self.scale = float(lengths.mean())
        rigid = np.array(pose, np.float64)
        rigid[:3, :3] /= self.scale
        if not np.abs(rigid[:3, :3].T @ rigid[:3, :3] - np.eye(3)).max() < 1e-3 or np.linalg.det(rigid[:3, :3]) < 0:
            raise ValueError("main_camera_node: expected a pose of a rotation, a translation and one scale, found another")
        is_perspective = np.array_equal(projection[3], (0, 0, -1, 0))
        if not is_perspective and not np.array_equal(projection[3], (0, 0, 0, 1)):
            raise ValueError(f"get_projection_matrix: expected 0 0 -1 0 or 0 0 0 1 as the last row, found {projection[3]}")
        if projection[0, 1] or projection[1, 0] or not (projection[0, 0] > 0 and projection[1, 1] > 0):
            raise ValueError("get_projection_matrix: expected a view that neither shears nor mirrors")
        self.camera = Camera(rigid, **_lens(projection, is_perspective, self.scale))
        shift, sign, unit = (projection[:2, 2], 1, 1.0) if is_perspective else (projection[:2, 3], -1, self.scale)
        ends = [unit * (edge + sign * shift[axis]) / projection[axis, axis] for axis in (0, 1) for edge in (-1, 1)]
        self.camera.sides = (ends[0], ends[1], ends[2], ends[3])


def _lens(projection: Array, is_perspective: bool, scale: float) -> CameraMembers:
    """The kind of camera, and the distances of the planes where the depth in OpenGL's cube is -1 and 1."""
    factor, offset = float(projection[2, 2]), float(projection[2, 3])
    if is_perspective:
        far = 0.0 if factor >= -1 else offset / (factor + 1)
        return {"orthographic": False, "near_z": max(offset / (factor - 1) * scale, 1e-6), "far_z": far * scale}
    return {"orthographic": True, "near_z": (offset + 1) / factor * scale, "far_z": (offset - 1) / factor * scale}


class Pass:
    """A world that is drawn by a view. ambient: light from all around. options: keywords of halflit.Scene.render() about the picture."""

    def __init__(self, world: World, view: View, size: Size, ambient: Array, options: Dict[str, Any]) -> None:
        self.world, self.view, self.size, self.options = world, view, size, options
        light_key = (size, ambient.tobytes())
        if world.setup_key is None or world.setup_key[0] != light_key:
            options_of_light = {"camera": view.camera, "exposure": 1.0, "ambient": ambient.tolist(), "studio": "never"}
            request: Any = request_of(world.scene, size, options_of_light)
            request.struct.width, request.struct.height = size
            request.struct.add_lights = 0  # a scene without light is black
            world.setup = set_up(world.scene, request)
            world.settings.clear()
        elif world.setup_key[1] != view.key:
            world.setup = world.setup._seen_by(view.camera)
        world.setup_key = light_key, view.key

    def pixels(self, dtype: Any) -> Array:
        """Colours, (height, width, 4): uint8 sRGB codes or float32 light; linear alpha. The next pass over the world draws into them."""
        shape, kept = (self.size[1], self.size[0], 4), self.world.pixels
        if kept is None or kept.shape != shape or kept.dtype != dtype:
            kept = self.world.pixels = np.empty(shape, dtype)
        self._draw({**self.options, "out": kept})
        return kept

    def planes(self, *names: str) -> Dict[str, Array]:
        """Planes of halflit.AOVS at the middles of the pixels."""
        drawn = self._draw({**self.options, "samples": 1, "aovs": names}, has_pixels=False)
        return {name: drawn.planes[name] for name in names}

    def _draw(self, options: Dict[str, Any], has_pixels: bool = True) -> Any:
        scene: Any = self.world.scene
        key = tuple(sorted((name, str(value)) for name, value in options.items() if name not in ("out", "aovs")))
        with scene._lock:
            settings = self.world.settings.get(key)
            if settings is None:
                if len(self.world.settings) > 16:
                    self.world.settings.clear()
                settings = self.world.settings[key] = _frame.settings_of(scene, self.world.setup, options)
            target: Any = Target(self.size, settings, options)
            if not has_pixels:
                target.struct.pixels = None
            _frame.frame(scene, self.world.setup, settings, target, Execution(options, scene._lock))
        return target
