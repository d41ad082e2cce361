"""Colours and pictures of a caller as arrays."""
from __future__ import annotations

from typing import Any, Optional, Sequence

import numpy as np

from ._values import Array, color, colors
from .texture import texels


def format_color_vector(value: Any, length: int) -> Array:
    """float32 (length,). Whole numbers are 255ths; one number stands for all channels; missing channels are 1."""
    return np.asarray(color(length)(value))


def format_color_array(value: Any, shape: Sequence[int]) -> Array:
    """float32 of this shape, likewise; one colour is repeated."""
    found = colors(value, shape[0])
    return np.ascontiguousarray(found[:, : shape[1]])


def format_texture_source(texture: Any, target_channels: str = "RGB") -> Optional[Array]:
    """uint8 with these channels."""
    return texels(texture, target_channels)


__all__ = ["format_color_array", "format_color_vector", "format_texture_source"]
