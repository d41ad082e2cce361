"""Colours: the sRGB curve, and what a caller may give as a colour."""
from __future__ import annotations

import ctypes
import math
from typing import Any, List, Optional

from . import _c
from ._errors import UsageError
from ._lazy import np
from ._types import Array, Color
from ._values import shown

#: Largest number of a colour that is not light. Floats above it are taken for codes from 0 to 255, which would be far too bright.
BRIGHTEST = 16.0


def linear_from_srgb(share: Any) -> Array:
    """Light of an sRGB value, both 0 to 1."""
    share = np.asarray(share, dtype=np.float64)
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(light: Any) -> Array:
    """The sRGB value of light, both 0 to 1."""
    light = np.asarray(light)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def linear_from_codes(codes: Any) -> Array:
    """Linear colours of uint8 sRGB codes; a fourth channel is alpha, which is linear already."""
    share = np.asarray(codes) / 255.0
    return np.concatenate([linear_from_srgb(share[..., :3]), share[..., 3:]], axis=-1)


def color(value: Color, name: str, count: int, most: Optional[float] = None) -> List[Any]:
    """`count` numbers of linear light, the fourth being alpha, 1 if it is left out.

    Texts and uint8 are sRGB. most: largest number of red, green and blue. None: it is light, which has no limit.
    """
    try:
        array = _read(value, name)[:count] if isinstance(value, str) else np.asarray(value)
    except ValueError as error:  # rows of different lengths
        raise error if isinstance(error, UsageError) else UsageError(f"{name}: expected numbers, found {shown(value)}") from None
    if array.dtype == np.uint8 and array.ndim == 1:
        array = linear_from_codes(array)
    if array.ndim != 1 or len(array) not in (3, count) or array.dtype.kind not in "fiu":
        raise UsageError(f"{name}: expected {'3 or 4' if count == 4 else 3} numbers or \"#rrggbb\", found {shown(value)}")
    if most is not None:
        limit = 1 if array.dtype.kind in "iu" else most
        if not (array >= 0).all() or not (array[:3] <= limit).all() or not (array[3:] <= 1).all():
            largest = f"to {most:g}" if math.isfinite(most) else "on"
            raise UsageError(
                f'{name}: expected linear light from 0 {largest}, where 1 is white, "#rrggbb" or uint8 sRGB codes, found {shown(value)}'
            )
    numbers = [float(x) for x in array]
    if not all(math.isfinite(x) for x in numbers):
        raise UsageError(f"{name}: a number is not finite: {shown(value)}")
    if min(numbers) < 0:
        raise UsageError(f"{name}: expected light from 0 on, found {shown(value)}")
    return numbers + [1.0] * (count - len(numbers))


def _read(text: str, name: str) -> Array:
    """A colour as the program reads it."""
    numbers = (ctypes.c_float * 4)()
    try:
        _c.call("read_color", _c.bytes_of(text, name), ctypes.addressof(numbers))
    except UsageError as error:
        raise UsageError(f"{name}: {error}") from None
    return np.array(numbers, np.float64)
