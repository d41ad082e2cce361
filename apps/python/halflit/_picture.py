"""A picture: a numpy array that shows itself in notebooks. This module imports numpy."""
from __future__ import annotations

import ctypes

import numpy as np

from . import _c
from ._errors import UsageError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Dict

    from ._camera import Camera


class Picture(np.ndarray):
    """The pixels of a frame, shape (height, width, 4), row 0 on top.

    uint8: red, green and blue in sRGB codes, linear alpha. float32: linear light after exposure, without a tone curve.
    A part of a picture, or what is computed from one, is a Picture without report and planes.
    """

    report: Dict[str, Any]  #: times, counts, the bound on the error, warnings: see halflit_report in halflit.h
    aovs: Dict[str, np.ndarray]  #: the planes that render(aovs=...) asked for, by name
    camera: Camera  #: the camera that drew it
    settings: Dict[str, Any]  #: all settings that decided its pixels

    def __array_finalize__(self, source) -> None:
        self.report, self.aovs, self.camera, self.settings = {}, {}, None, {}  # type: ignore[assignment]

    @property
    def pixel_hash(self) -> str:
        """64-bit hash of the pixels as 16 hexadecimal digits: the program's pixel_hash for the same picture."""
        pixels = np.ascontiguousarray(self)
        return f"{_c.function('pixel_hash')(pixels.ctypes.data, pixels.nbytes):016x}"

    def save(self, path) -> None:
        """Writes .png, .bmp, .tga or .jpg from uint8, .exr, .hdr or .pfm from float32. The file is old or new, never half written."""
        if self.ndim != 3 or self.shape[2] != 4 or self.dtype not in (np.uint8, np.float32):
            raise UsageError(f"save: expected uint8 or float32 of shape (height, width, 4), found {self.dtype} of {self.shape}")
        pixels = np.ascontiguousarray(self)
        target = _c.make("target")
        target.pixels, target.width, target.height = pixels.ctypes.data, pixels.shape[1], pixels.shape[0]
        target.format = _c.CONSTANTS["HALFLIT_FORMAT_RGBA_F32" if pixels.dtype == np.float32 else "HALFLIT_FORMAT_RGBA8"]
        _c.call("write_image", _c.bytes_of(path), ctypes.byref(target))

    def to_png(self) -> bytes:
        """The picture as the bytes of a PNG. Floats become sRGB codes; light above 1 is cut off."""
        from ._png import encode

        pixels = np.asarray(self)
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or 0 in pixels.shape or pixels.dtype not in (np.uint8, np.float32):
            raise UsageError(f"to_png: expected uint8 or float32 of shape (height, width, 3 or 4), found {pixels.dtype} of {pixels.shape}")
        if pixels.dtype == np.float32:
            light = np.clip(np.nan_to_num(pixels), 0, 1)
            codes = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
            if pixels.shape[2] == 4:
                codes[:, :, 3] = light[:, :, 3]
            pixels = (codes * 255 + 0.5).astype(np.uint8)
        return encode(np.ascontiguousarray(pixels))

    def _repr_png_(self) -> bytes | None:
        """What Jupyter shows; parts that are no picture, such as a row, are shown as numbers."""
        try:
            return self.to_png()
        except UsageError:
            return None
