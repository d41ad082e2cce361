"""Arrays of a caller as the library reads them. An array that has the right type and order is handed over without a copy."""
from __future__ import annotations

import numpy as np

from ._errors import UsageError


def floats(value, columns: int, name: str, count: int | None = None) -> np.ndarray:
    """float32 of shape (n, columns), rows without gaps. count: the n that is expected."""
    array = np.ascontiguousarray(value, dtype=np.float32)
    if array.ndim != 2 or array.shape[1] != columns:
        raise UsageError(f"{name}: expected an array of shape (n, {columns}), found {array.shape}")
    if count is not None and len(array) != count:
        raise UsageError(f"{name}: {len(array)} rows, expected one for each of {count} vertices")
    return array


def colors(value, count: int) -> np.ndarray:
    """Vertex colours: float32 of shape (n, 4), linear. Bytes are sRGB codes; alpha may be left out. Codes of another type are refused."""
    array = np.asarray(value)
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise UsageError(f"colors: expected an array of shape (n, 3) or (n, 4), found {array.shape}")
    if array.dtype == np.uint8:
        linear = linear_from_srgb(array[:, :3] / 255.0)
        array = np.concatenate([linear, array[:, 3:] / 255.0], axis=1)
    elif (array > (16 if array.dtype.kind == "f" else 1)).any():
        raise UsageError(f"colors: expected uint8 sRGB codes, or linear light where 1 is white, found {array.dtype} up to {array.max()}")
    if array.shape[1] == 3:
        array = np.concatenate([array, np.ones((len(array), 1), array.dtype)], axis=1)
    return floats(array, 4, "colors", count)


def linear_from_srgb(share):
    """Light of an sRGB value, both 0 to 1."""
    share = np.asarray(share, dtype=np.float64)
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def indices(value, columns: int) -> np.ndarray:
    """uint32, one row of vertex numbers for each primitive. int32 without negative numbers has the same bytes."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise UsageError(f"faces: expected whole numbers, found {array.dtype}")
    if array.ndim != 1 and not (array.ndim == 2 and array.shape[1] == columns):
        raise UsageError(f"faces: expected an array of shape (n, {columns}), found {array.shape}")
    if array.dtype.kind == "i" and array.size and int(array.min()) < 0:
        raise UsageError("faces: a negative vertex number")
    if array.size and int(array.max()) > 0xFFFFFFFF:
        raise UsageError("faces: a vertex number above 2^32")
    if array.dtype == np.int32 and array.flags.c_contiguous:
        return array.view(np.uint32)
    return np.ascontiguousarray(array, dtype=np.uint32)


def smooth_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Normals of the surface through the vertices: the mean of the faces around each, by their areas; float32 (n, 3), not normalised.

    A vertex without a face, or whose faces cancel each other, has +y.
    """
    corners = np.asarray(vertices, dtype=np.float64)[np.asarray(faces).reshape(-1, 3)]
    of_faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros((len(vertices), 3))
    for corner in range(3):
        np.add.at(normals, np.asarray(faces).reshape(-1, 3)[:, corner], of_faces)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    flat = ~(length > 0)
    return np.where(flat, (0.0, 1.0, 0.0), normals / np.where(flat, 1, length)).astype(np.float32)


def matrix(value, name: str = "matrix") -> np.ndarray:
    """16 float32, column after column, of a 4 x 4 array whose rows are rows: the translation is value[:3, 3]."""
    array = np.asarray(value, dtype=np.float32)
    if array.shape != (4, 4):
        raise UsageError(f"{name}: expected an array of shape (4, 4), found {array.shape}")
    return np.ascontiguousarray(array.T)


def rgba8(value) -> np.ndarray:
    """A texture's pixels: uint8 (height, width, 4), whose pixels have no gaps; rows may have. Grey and RGB are filled up."""
    if hasattr(value, "convert") and hasattr(value, "getbands"):  # a picture of PIL
        value = value.convert("RGBA")
    array = np.asarray(value)
    if array.dtype != np.uint8:
        raise UsageError(f"texture: expected uint8, found {array.dtype}")
    if array.ndim == 2:
        array = np.repeat(array[:, :, None], 3, axis=2)
    if array.ndim != 3 or array.shape[2] not in (3, 4):
        raise UsageError(f"texture: expected an array of shape (height, width, 3 or 4), found {array.shape}")
    if array.shape[2] == 3:
        array = np.concatenate([array, np.full(array.shape[:2] + (1,), 255, np.uint8)], axis=2)
    return array if array.strides[1:] == (4, 1) and array.strides[0] > 0 else np.ascontiguousarray(array)
