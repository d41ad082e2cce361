"""Pictures on surfaces."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._values import Array, Checked, text
from .sampler import Sampler

#: Channels that a texture keeps of its source: name -> their numbers.
_CHANNELS = {"R": [0], "RG": [0, 1], "GB": [1, 2], "RGB": [0, 1, 2], "RGBA": [0, 1, 2, 3]}


def texels(source: Any, channels: str) -> Optional[Array]:
    """uint8 (height, width, n) of an array or a picture of PIL. Floats are shares of 255; a missing alpha is 255."""
    if source is None:
        return None
    if hasattr(source, "convert") and hasattr(source, "getbands"):  # a picture of PIL
        source = source.convert("RGBA" if "A" in source.getbands() or source.mode == "P" else "RGB")
    array = np.asarray(source)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"texture: expected an array or a picture, found {type(source).__name__}")
    array = (np.clip(array, 0, 1) * 255.0).astype(np.uint8) if array.dtype.kind in "fb" else array.astype(np.uint8)
    array = array[:, :, None] if array.ndim == 2 else array
    if channels not in _CHANNELS:
        raise ValueError(f"texture: expected channels {', '.join(_CHANNELS)}, found {channels!r}")
    wanted = _CHANNELS[channels]
    found = array.shape[2]
    if found == 1:
        array = np.repeat(array, 3, axis=2)
    elif found == 2 and len(wanted) == 2:
        return np.ascontiguousarray(array)
    elif found == 2 and len(wanted) > 2:
        raise ValueError(f"texture: 2 channels, expected 1, 3 or 4 for {channels}")
    if channels == "RGBA" and array.shape[2] < 4:
        array = np.concatenate([array, np.full(array.shape[:2] + (1,), 255, np.uint8)], axis=2)
    return np.ascontiguousarray(array[:, :, wanted])


class Texture(Checked):
    """A picture, row 0 on top, and its sampler.

    source: (h, w, c) uint8 or float in [0, 1], or a picture of PIL. source_channels: "R", "RG", "GB", "RGB" or "RGBA", those that are kept.
    width, height, tex_type and data_format are kept and not used.
    """

    _checks = {"name": text, "sampler": lambda value: Sampler() if value is None else value}
    name: Optional[str]
    sampler: Sampler
    source_channels: str
    width: Optional[int]
    height: Optional[int]

    def __init__(
        self,
        name: Optional[str] = None,
        sampler: Optional[Sampler] = None,
        source: Any = None,
        source_channels: Optional[str] = None,
        width: Optional[int] = None,
        height: Optional[int] = None,
        tex_type: int = 3553,
        data_format: int = 5126,
    ) -> None:
        self.name = name
        self.sampler = sampler  # type: ignore[assignment]
        self.source_channels = source_channels or "RGB"
        self.source = source
        self.width, self.height, self.tex_type, self.data_format = width, height, tex_type, data_format

    @property
    def source(self) -> Optional[Array]:
        """uint8 (height, width, number of source_channels)."""
        return self._source

    @source.setter
    def source(self, value: Any) -> None:
        self._source = texels(value, self.source_channels)

    def is_transparent(self, cutoff: float = 1.0) -> bool:
        """Whether a texel's alpha is below this share."""
        if self.source_channels != "RGBA" or self._source is None:
            return False
        return bool((self._source[:, :, 3] < cutoff * 255.0).any())

    def delete(self) -> None:
        """Frees nothing: a texture has no memory of its own here."""
