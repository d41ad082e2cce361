"""The nodes of a scene."""
from __future__ import annotations

from typing import Any, List, Optional

import numpy as np

from ._values import Array, Checked, kind, text
from .camera import Camera
from .light import Light
from .mesh import Mesh


class Node(Checked):
    """A place in the scene, relative to its parent, and what is there: a mesh, a camera, a light, children.

    matrix: (4, 4), or translation (3,), rotation (a unit quaternion, x, y, z, w) and scale (3,). skin and weights are kept and not used.
    """

    _checks = {"name": text, "camera": kind("camera", Camera), "mesh": kind("mesh", Mesh), "light": kind("light", Light)}
    name: Optional[str]
    camera: Optional[Camera]
    mesh: Optional[Mesh]
    light: Optional[Light]
    children: List[Node]

    def __init__(
        self,
        name: Optional[str] = None,
        camera: Optional[Camera] = None,
        children: Optional[List[Node]] = None,
        skin: Any = None,
        matrix: Any = None,
        mesh: Optional[Mesh] = None,
        rotation: Any = None,
        scale: Any = None,
        translation: Any = None,
        weights: Any = None,
        light: Optional[Light] = None,
    ) -> None:
        self.name, self.camera, self.mesh, self.light = name, camera, mesh, light
        self.children = [] if children is None else children
        self.skin, self.weights = skin, weights
        self._matrix: Array = np.eye(4)
        if matrix is not None:
            self.matrix = matrix
            return
        for member, value in (("scale", scale), ("rotation", rotation), ("translation", translation)):
            if value is not None:
                setattr(self, member, value)

    @property
    def matrix(self) -> Array:
        """(4, 4); a copy."""
        return np.array(self._matrix)

    @matrix.setter
    def matrix(self, value: Any) -> None:
        array = np.asarray(value)
        if array.shape != (4, 4):
            raise ValueError(f"matrix: expected an array of shape (4, 4), found {array.shape}")
        if array[3].tolist() != [0, 0, 0, 1] and not np.allclose(array[3], (0.0, 0.0, 0.0, 1.0)):
            raise ValueError(f"matrix: expected 0 0 0 1 as the last row, found {array[3]}")
        self._matrix = array  # not a copy: scripts that write into the pose move the node, as in pyrender

    @property
    def translation(self) -> Array:
        """(3,)."""
        return np.array(self._matrix[:3, 3])

    @translation.setter
    def translation(self, value: Any) -> None:
        self._compose(_vector(value, 3, "translation"), self.rotation, self.scale)

    @property
    def rotation(self) -> Array:
        """The unit quaternion x, y, z, w."""
        length = self.scale
        return _quaternion(self._matrix[:3, :3] / np.where(length > 0, length, 1))

    @rotation.setter
    def rotation(self, value: Any) -> None:
        array = _vector(value, 4, "rotation")
        if abs(np.linalg.norm(array) - 1.0) > 1e-3:
            raise ValueError(f"rotation: expected a quaternion of length 1, found {array}")
        self._compose(self.translation, array, self.scale)

    @property
    def scale(self) -> Array:
        """(3,)."""
        return np.asarray(np.linalg.norm(self._matrix[:3, :3], axis=0))

    @scale.setter
    def scale(self, value: Any) -> None:
        self._compose(self.translation, self.rotation, _vector(value, 3, "scale"))

    def _compose(self, translation: Array, rotation: Array, scale: Array) -> None:
        matrix = np.eye(4)
        matrix[:3, :3] = _rotation(rotation) * scale
        matrix[:3, 3] = translation
        self._matrix = matrix


def _vector(value: Any, count: int, name: str) -> Array:
    array = np.asarray(value, np.float64)
    if array.shape != (count,):
        raise ValueError(f"{name}: expected {count} numbers, found an array of shape {array.shape}")
    return array


def _rotation(quaternion: Array) -> Array:
    """The matrix (3, 3) of a quaternion x, y, z, w: v + 2 w (q x v) + 2 q x (q x v)."""
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def _quaternion(turn: Array) -> Array:
    """The quaternion x, y, z, w of a rotation (3, 3): the eigenvector of the matrix of Bar-Itzhack (2000) with the largest eigenvalue."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = turn
    matrix = np.array(
        [
            [xx - yy - zz, yx + xy, zx + xz, zy - yz],
            [yx + xy, yy - xx - zz, zy + yz, xz - zx],
            [zx + xz, zy + yz, zz - xx - yy, yx - xy],
            [zy - yz, xz - zx, yx - xy, xx + yy + zz],
        ]
    )
    found = np.linalg.eigh(matrix)[1][:, 3]
    return np.asarray(found if found[3] >= 0 else -found)
