"""Primitives as the arrays that a halflit scene is given."""
from __future__ import annotations

from typing import Any, Dict, Optional

import numpy as np

from ._values import Array
from .constants import GLTF, RenderFlags
from .primitive import Primitive

#: Length of the lines that show normals, as a share of the primitive's diagonal.
_NORMAL_LENGTH = 0.05


def clean(array: Optional[Array]) -> Optional[Array]:
    """The array without infinite numbers and NaN: meshes with faces without area have such normals."""
    if array is None or np.isfinite(array).all():
        return array
    return np.nan_to_num(array, posinf=0.0, neginf=0.0)


def triangles(primitive: Primitive) -> Array:
    """Vertex numbers of the triangles, (n, 3)."""
    flat = _numbers(primitive)
    if primitive.mode == GLTF.TRIANGLES:
        corners: Array = flat[: len(flat) // 3 * 3].reshape(-1, 3)
        return corners
    if len(flat) < 3:
        return np.zeros((0, 3), np.int64)
    if primitive.mode == GLTF.TRIANGLE_FAN:
        return np.stack([np.broadcast_to(flat[:1], len(flat) - 2), flat[1:-1], flat[2:]], axis=1)
    made: Array = np.stack([flat[:-2], flat[1:-1], flat[2:]], axis=1)
    made[1::2] = made[1::2][:, [1, 0, 2]]  # every second one is the other way round
    return made


def lines(primitive: Primitive) -> Array:
    """Vertex numbers of the lines, (n, 2)."""
    flat = _numbers(primitive)
    if primitive.mode == GLTF.LINES:
        pairs: Array = flat[: len(flat) // 2 * 2].reshape(-1, 2)
        return pairs
    if len(flat) < 2:
        return np.zeros((0, 2), np.int64)
    ends: Array = np.stack([flat[:-1], flat[1:]], axis=1)
    return np.concatenate([ends, flat[[-1, 0]][None]]) if primitive.mode == GLTF.LINE_LOOP else ends


def _numbers(primitive: Primitive) -> Array:
    return np.arange(len(primitive.positions)) if primitive.indices is None else primitive.indices.ravel()


def is_surface(primitive: Primitive) -> bool:
    """Whether it consists of triangles."""
    return primitive.mode >= GLTF.TRIANGLES


def body(primitive: Primitive, wireframe: bool, colors: Optional[Array]) -> Dict[str, Any]:
    """Arguments of Scene.add_mesh() for what a primitive shows, with these vertex colours. wireframe: the edges of its triangles."""
    shape: Dict[str, Any] = {"vertices": primitive.positions, "normals": clean(primitive.normals), "colors": colors}
    for name, uv in (("uv", primitive.texcoord_0), ("uv1", primitive.texcoord_1)):
        shape[name] = None if uv is None else clean(np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1))  # v points up in OpenGL
    if is_surface(primitive) and not wireframe:
        faces = triangles(primitive)
        return {**shape, "topology": "triangles", "faces": faces, "tangents": clean(primitive.tangents)}
    if is_surface(primitive):
        edges = np.sort(triangles(primitive)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        return {**shape, "topology": "lines", "faces": np.unique(edges, axis=0)}
    if primitive.mode == GLTF.POINTS:
        return {**shape, "topology": "points", "faces": _numbers(primitive)}
    return {**shape, "topology": "lines", "faces": lines(primitive)}


def normals(primitive: Primitive, which: int) -> Dict[str, Any]:
    """The same for the lines that show its normals. which: RenderFlags.VERTEX_NORMALS, FACE_NORMALS or both."""
    starts, ways = [], []
    directions = clean(primitive.normals)
    if directions is not None and which & RenderFlags.VERTEX_NORMALS:
        starts.append(primitive.positions)
        ways.append(directions)
    if directions is not None and which & RenderFlags.FACE_NORMALS and is_surface(primitive):
        faces = triangles(primitive)
        way = directions[faces].mean(axis=1)
        length = np.linalg.norm(way, axis=1, keepdims=True)
        starts.append(primitive.positions[faces].mean(axis=1))
        ways.append(way / np.where(length > 0, length, 1))
    start, way = (np.concatenate(arrays) if arrays else np.zeros((0, 3), np.float32) for arrays in (starts, ways))
    ends = start + way * np.float32(_NORMAL_LENGTH * primitive.scale)
    return {"vertices": np.stack([start, ends], axis=1).reshape(-1, 3).astype(np.float32), "topology": "lines"}
