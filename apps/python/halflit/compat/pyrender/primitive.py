"""The parts of a mesh, each with one material."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._values import Array, Boxed, Checked, colors
from .constants import GLTF
from .material import Material, MetallicRoughnessMaterial


class Primitive(Checked, Boxed):
    """Vertices, and what is drawn of them.

    positions: (n, 3). normals: (n, 3). tangents: (n, 4). texcoord_0, texcoord_1: (n, 2), v = 0 is the last row of a picture.
    color_0: (n, 3) or (n, 4), floats or bytes, times the base colour. indices: vertex numbers, None: 0, 1, 2 and so on. mode: see GLTF.
    poses: (k, 4, 4), where it is drawn in its node; None: once. joints_0, weights_0 and targets are kept and not used.

    An array that is set anew is uploaded by the next picture; what is written into one is not seen.
    """

    material: Material
    mode: int
    positions: Array
    normals: Optional[Array]
    tangents: Optional[Array]
    texcoord_0: Optional[Array]
    texcoord_1: Optional[Array]
    color_0: Optional[Array]
    indices: Optional[Array]
    poses: Optional[Array]
    _box: Optional[Array]
    _moves = 0  # counts changes of the poses

    def __init__(
        self,
        positions: Any,
        normals: Any = None,
        tangents: Any = None,
        texcoord_0: Any = None,
        texcoord_1: Any = None,
        color_0: Any = None,
        joints_0: Any = None,
        weights_0: Any = None,
        indices: Any = None,
        material: Optional[Material] = None,
        mode: Optional[int] = None,
        targets: Any = None,
        poses: Any = None,
    ) -> None:
        given = dict(locals())
        for name in given:
            if name not in ("self", "given"):
                setattr(self, name, given[name])

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "material":
            value = MetallicRoughnessMaterial() if value is None else value
            if not isinstance(value, Material):
                raise TypeError(f"material: expected a Material, found {type(value).__name__}")
        elif name == "mode":
            value = GLTF.TRIANGLES if value is None else int(value)
            if not GLTF.POINTS <= value <= GLTF.TRIANGLE_FAN:
                raise ValueError(f"mode: expected 0 to 6, found {value}")
        elif value is not None:
            value = self._array(name, value)
        if name == "poses":  # nothing has to be uploaded but places
            object.__setattr__(self, name, value)
            object.__setattr__(self, "_moves", self._moves + 1)
        else:
            super().__setattr__(name, value)
        if name in ("positions", "poses"):
            object.__setattr__(self, "_box", None)

    def _array(self, name: str, value: Any) -> Any:
        if name == "color_0":
            return colors(value, len(self.positions))
        if name == "indices":
            array = np.ascontiguousarray(value)
            return array if array.dtype.kind in "iu" else array.astype(np.int64)
        if name == "poses":
            array = np.ascontiguousarray(value, np.float64)
            array = array[None] if array.ndim == 2 else array
            if array.ndim != 3 or array.shape[1:] != (4, 4):
                raise ValueError(f"poses: expected an array of shape (n, 4, 4), found {array.shape}")
            return array
        columns = {"positions": 3, "normals": 3, "tangents": 4, "texcoord_0": 2, "texcoord_1": 2}.get(name)
        if columns is None:
            return value
        array = np.ascontiguousarray(value, np.float32)
        if array.ndim == 2 and name.startswith("texcoord"):
            array = np.ascontiguousarray(array[:, :2])
        count = len(array) if name == "positions" else len(self.positions)
        if array.shape != (count, columns):
            raise ValueError(f"{name}: expected an array of shape ({count}, {columns}), found {array.shape}")
        return array

    @property
    def bounds(self) -> Array:
        """Box, (2, 3), of the vertices where the poses place them."""
        if self._box is not None:
            return self._box
        if not len(self.positions):
            return np.zeros((2, 3))
        box: Array = np.array([self.positions.min(axis=0), self.positions.max(axis=0)], np.float64)
        if self.poses is not None and len(self.poses):
            box = moved(box, self.poses)
        object.__setattr__(self, "_box", box)
        return box

    @property
    def is_transparent(self) -> bool:
        """Whether some of it lets what is behind through."""
        if self.material.is_transparent:
            return True
        return self.material.alphaMode == "BLEND" and self.color_0 is not None and bool((self.color_0[:, 3] != 1).any())

    def delete(self) -> None:
        """Frees nothing: the renderer holds what was uploaded."""


def corners(box: Array) -> Array:
    """The 8 corners of a box, (8, 3)."""
    return np.array([[box[i >> k & 1, k] for k in range(3)] for i in range(8)])


def moved(box: Array, poses: Array) -> Array:
    """Box of the box's corners that are moved by matrices (n, 4, 4)."""
    points = corners(box) @ poses[:, :3, :3].transpose(0, 2, 1) + poses[:, None, :3, 3]
    return np.array([points.min(axis=(0, 1)), points.max(axis=(0, 1))])
