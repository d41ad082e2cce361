"""Arrays of a caller as the library reads them. An array that has the right type and order is handed over without a copy."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._color import BRIGHTEST, linear_from_codes, linear_from_srgb
from ._errors import UsageError, warn
from ._types import Array
from ._values import shown

#: Kinds of DLPack's devices: kDLCPU, kDLCUDAHost.
_MAIN_MEMORY = (1, 3)
#: A box whose size is below this share of its middle's distance from the origin is framed as if it were so large.
_SMALLEST = 1e-6


def array_of(value: Any, name: str) -> Array:
    """An array of numbers."""
    if not isinstance(value, np.ndarray):
        value = _in_main_memory(value, name)
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):  # rows of different lengths
        array = np.empty(0, object)
    except RuntimeError as error:  # a tensor that follows gradients
        raise UsageError(f"{name}: {error}") from None
    if array.dtype.kind not in "fiub":
        raise UsageError(f"{name}: expected an array of numbers, found {shown(value)}")
    return array


def _in_main_memory(value: Any, name: str) -> Any:
    """A tensor of another library as numpy's array, by the protocol DLPack if it has no other. One in a GPU's memory is refused."""
    device = getattr(value, "__dlpack_device__", None)
    try:
        is_elsewhere = bool(getattr(value, "is_cuda", False)) or (device is not None and device()[0] not in _MAIN_MEMORY)
    except Exception as error:  # whatever an object of another library raises
        raise _no_tensor(value, name, "__dlpack_device__", error) from None
    if is_elsewhere:
        raise UsageError(f"{name}: expected an array in main memory, found one on a GPU: hand over a copy, as by tensor.cpu()")
    if hasattr(value, "__dlpack__") and not hasattr(value, "__array__") and hasattr(np, "from_dlpack"):
        try:
            return np.from_dlpack(value)
        except Exception as error:
            raise _no_tensor(value, name, "__dlpack__", error) from None
    return value


def _no_tensor(value: Any, name: str, method: str, error: Exception) -> UsageError:
    said = " ".join(str(error).split())
    return UsageError(f"{name}: expected an array of numbers, found {shown(value)}, whose {method} fails: {said}")


def numbers(value: Any, kind: Any, name: str) -> Array:
    """An array of numbers of this kind, without gaps."""
    with np.errstate(over="ignore"):  # infinite numbers are told of where they matter
        return np.ascontiguousarray(array_of(value, name), dtype=kind)


def floats(value: Any, columns: int, name: str, count: Optional[int] = None) -> Array:
    """float32 of shape (n, columns), rows without gaps. count: the n that is expected."""
    array = numbers(value, np.float32, name)
    if array.ndim != 2 or array.shape[1] != columns:
        raise UsageError(f"{name}: expected an array of shape (n, {columns}), found {array.shape}")
    if count is not None and len(array) != count:
        raise UsageError(f"{name}: {len(array)} rows, expected one for each of {count} vertices")
    return array


def finite(value: Any, columns: int, name: str, count: int) -> Array:
    """The same without infinite numbers and NaN."""
    array = floats(value, columns, name, count)
    wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(wrong):
        raise UsageError(f"{name}: row {wrong[0]} is not finite in float32: {shown(array[wrong[0]].tolist())}")
    return array


def positions(value: Any, mesh: str) -> Array:
    """Vertices as floats(). Warns of those that are not finite, and where float32 is too coarse for a shape that is far from the origin.

    mesh: what has them, for the warnings.
    """
    array = floats(value, 3, "vertices")
    is_finite = np.isfinite(array).all(axis=1)
    wrong = np.flatnonzero(~is_finite)
    if len(wrong):
        warn(f"vertices: {mesh} has {len(wrong)} that are not finite, the first in row {wrong[0]}: what has one of them is not drawn")
    if len(wrong) == len(array):
        return array
    seen = array[is_finite] if len(wrong) else array
    low, high = seen.min(axis=0).astype(np.float64), seen.max(axis=0).astype(np.float64)
    size, far = (high - low).max(), np.maximum(np.abs(low), np.abs(high)).max()
    step = np.spacing(np.float32(far))
    cure = "move them to the origin before, as by vertices - vertices.mean(axis=0)"
    is_coarse = getattr(value, "dtype", np.float64) != np.float32 and step > 1e-4 * size
    if is_coarse and not np.array_equal(seen, numbers(value, np.float64, "vertices")[is_finite]):
        warn(f"vertices: float32 rounds them to steps of {step:g}, in a mesh of size {size:g}: {cure}")
    elif size > 0 and not np.linalg.norm(high - low) > _SMALLEST * np.linalg.norm(high + low):
        warn(
            f"vertices: float32, in which cameras are placed, has steps of {step:g} where {mesh} of size {size:g} lies: views of the scene"
            f" show it small: {cure}"
        )
    return array


def colors(value: Any, count: int, space: Optional[str] = None) -> Array:
    """Vertex colours: float32 of shape (n, 4), linear; alpha may be left out. Codes of another type than uint8 are refused.

    space: "srgb" or "linear"; None: bytes are sRGB codes and floats linear light.
    """
    if space not in (None, "srgb", "linear"):
        raise UsageError(f"colors_space: expected 'srgb' or 'linear', found {shown(space)}")
    array = array_of(value, "colors")
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise UsageError(f"colors: expected an array of shape (n, 3) or (n, 4), found {array.shape}")
    if array.dtype == np.uint8:
        array = array / np.float32(255) if space == "linear" else linear_from_codes(array)
    elif space == "srgb":
        if array.size and not (array.min() >= 0 and array.max() <= 1):
            raise UsageError(f"colors: expected sRGB values from 0 to 1, or uint8, found {array.dtype} from {array.min()} to {array.max()}")
        array = np.concatenate([linear_from_srgb(array[:, :3]), array[:, 3:]], axis=1)
    else:
        array = floats(array, array.shape[1], "colors") if array.dtype.kind == "f" else array
        most = BRIGHTEST if array.dtype.kind == "f" else 1
        if array.size and not (array.min() >= 0 and array.max() <= most):
            raise UsageError(
                f"colors: expected uint8 sRGB codes, or linear light from 0, where 1 is white, to {most:g},"
                f" found {array.dtype} from {array.min()} to {array.max()}"
            )
    if array.shape[1] == 3:
        array = np.concatenate([array, np.ones((len(array), 1), array.dtype)], axis=1)
    return floats(array, 4, "colors", count)


def indices(value: Any, columns: int, count: int) -> Array:
    """uint32, `columns` vertex numbers for each primitive, all below count. int32 without negative numbers has the same bytes."""
    array = array_of(value, "faces")
    if not array.size:
        return np.zeros((0, columns), np.uint32)
    if array.dtype.kind not in "iu":
        raise UsageError(f"faces: expected whole numbers, found {array.dtype}")
    if array.ndim != 1 and not (array.ndim == 2 and array.shape[1] == columns):
        raise UsageError(f"faces: expected an array of shape (n, {columns}), found {array.shape}")
    if array.size % columns:
        raise UsageError(f"faces: {array.size} corners, expected {columns} for each")
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= count:
        raise UsageError(f"faces: vertex {low if low < 0 else high}, expected 0 to {count - 1}: the number of vertices is {count}")
    if array.dtype == np.int32 and array.flags.c_contiguous:
        return array.view(np.uint32)
    return np.ascontiguousarray(array, dtype=np.uint32)


def matrix(value: Any, name: str = "matrix") -> Array:
    """float64 (4, 4) whose rows are rows: the translation is value[:3, 3]."""
    array = numbers(value, np.float64, name).copy()
    if array.shape != (4, 4):
        raise UsageError(f"{name}: expected an array of shape (4, 4), found {array.shape}")
    checked: Array = checked_matrices(array[None], name)[0]
    return checked


def matrices(value: Any, name: str = "matrices") -> Array:
    """float64 (n, 4, 4), likewise."""
    array = numbers(value, np.float64, name).copy()
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise UsageError(f"{name}: expected an array of shape (n, 4, 4), found {array.shape}")
    return checked_matrices(array, name)


def checked_matrices(array: Array, name: str) -> Array:
    """Finite ones whose last row is 0 0 0 1, exactly then."""
    if not np.isfinite(array).all():
        raise UsageError(f"{name}: a number is not finite")
    last = (0, 0, 0, 1)
    is_wrong = np.abs(array[:, 3] - last).max(axis=1, initial=0) > 1e-6
    if is_wrong.any():
        found = array[is_wrong.argmax()]
        hint = ": is it transposed?" if np.allclose(found[:, 3], last, rtol=0, atol=1e-6) else ""
        raise UsageError(f"{name}: expected 0 0 0 1 as the last row, and the translation in the last column, found {found[3]}{hint}")
    array[:, 3] = last
    return array


def rgba8(value: Any) -> Array:
    """A texture's pixels: uint8 (height, width, 4), whose pixels have no gaps; rows may have. Grey and RGB are filled up."""
    if hasattr(value, "convert") and hasattr(value, "getbands"):  # a picture of PIL
        value = value.convert("RGBA")
    array = array_of(value, "texture")
    if array.dtype != np.uint8:
        raise UsageError(f"texture: expected uint8, found {array.dtype}")
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4:
        raise UsageError(f"texture: expected an array of shape (height, width) or (height, width, 1 to 4), found {array.shape}")
    if array.shape[2] < 3:  # grey, or grey and alpha
        array = np.concatenate([np.repeat(array[:, :, :1], 3, axis=2), array[:, :, 1:]], axis=2)
    if array.shape[2] == 3:
        array = np.concatenate([array, np.full(array.shape[:2] + (1,), 255, np.uint8)], axis=2)
    return array if array.strides[1:] == (4, 1) and array.strides[0] > 0 else np.ascontiguousarray(array)
