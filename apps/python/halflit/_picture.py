"""A picture: a numpy array that shows itself in notebooks. This module imports numpy."""
from __future__ import annotations

import base64
import contextlib
import ctypes
import html
import io
import math
import os
from typing import TYPE_CHECKING, Any, BinaryIO, Dict, Optional, Tuple, Union, cast

import numpy as np

from . import _c
from ._camera import Camera
from ._color import srgb_from_linear
from ._errors import UsageError
from ._options import settings_dict
from ._types import Array

#: Kinds of files whose pixels are floats; all others have 8-bit codes.
_LINEAR = (".exr", ".hdr", ".pfm")


if TYPE_CHECKING:
    _Base = np.ndarray[Any, np.dtype[Any]]
else:
    _Base = np.ndarray


class Picture(_Base):
    """The pixels of a frame, shape (height, width, 4), row 0 on top.

    uint8: red, green and blue in sRGB codes, linear alpha. float32: linear light after exposure, without a tone curve.
    Copies and pickles keep report, planes, camera and settings. A part of a picture, or an array that is computed from one, is a Picture
    without them. What is computed as one number, as by picture.mean(), is a number of numpy.
    """

    report: Dict[str, Any]  #: times, counts, the bound on the error, warnings: see halflit_report in halflit.h
    aovs: Dict[str, Array]  #: the planes that render(aovs=...) asked for, by name
    camera: Optional[Camera]  #: the camera that drew it
    premultiplied: bool  #: colours are multiplied by alpha; files and notebooks get them divided again

    def __array_finalize__(self, source: Any) -> None:
        self.report, self.aovs, self.camera = {}, {}, None
        self._settings: Any = {}  # a dict, or what settings_dict() takes
        self.premultiplied = getattr(source, "premultiplied", False)

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: Any = False) -> Any:
        if array.ndim == 0:  # of a reduction
            return array[()]
        return array.view(type(self)) if array is not self else array

    @property
    def settings(self) -> Dict[str, Any]:
        """All settings that decided its pixels, by the names of halflit_settings in halflit.h."""
        if not isinstance(self._settings, dict):
            self._settings = settings_dict(self._settings)
        found: Dict[str, Any] = self._settings
        return found

    def _told(self) -> Tuple[Any, ...]:
        """Attributes beside the pixels."""
        return self.report, self.aovs, self.camera, self.settings, self.premultiplied

    def _tell(self, told: Tuple[Any, ...]) -> Any:
        self.report, self.aovs, self.camera, self._settings, self.premultiplied = told
        return self

    def copy(self, order: Any = "C") -> Picture:
        """Another picture that is equal; its planes are copies too."""
        report, aovs, camera, settings, premultiplied = self._told()
        planes = {name: plane.copy() for name, plane in aovs.items()}
        told = dict(report), planes, None if camera is None else camera.copy(), dict(settings), premultiplied
        made: Picture = super().copy(order)._tell(told)
        return made

    def __copy__(self) -> Picture:
        return self.copy()

    def __deepcopy__(self, memo: Any) -> Picture:
        return self.copy()

    def __reduce__(self) -> Any:
        made: Any = super().__reduce__()
        remake, arguments, state = made[:3]
        return remake, arguments, (state, self._told())

    def __setstate__(self, state: Any) -> None:
        pixels, told = state
        super().__setstate__(pixels)
        self._tell(told)

    @property
    def pixel_hash(self) -> str:
        """64-bit hash of the pixels as 16 hexadecimal digits: the program's pixel_hash for the same picture."""
        pixels = np.ascontiguousarray(self)
        return f"{_c.function('pixel_hash')(pixels.ctypes.data, pixels.nbytes):016x}"

    def save(self, path: Union[str, os.PathLike[Any], BinaryIO], format: Optional[str] = None) -> None:
        """Writes .png, .bmp, .tga, .jpg or .webp, or from float32 also .exr, .hdr or .pfm. The file is old or new, never half written.

        path: its name, or a file object that is open in binary mode. format: as in encode(); that of the name if it is left out, and PNG
        for a file object without a name. In 8-bit files floats become sRGB codes; light above 1 is cut off.
        """
        if isinstance(path, io.TextIOBase):
            raise UsageError("path: expected a file that is open in binary mode, found one of text")
        write, named = getattr(path, "write", None), cast(str, path)
        if write is not None or format is not None:
            name = getattr(path, "name", None) if write is not None else named
            ending = "" if not isinstance(name, (str, os.PathLike)) else os.path.splitext(os.fspath(name))[1][1:]
            encoded = self.encode(format or ending or "png")
            if write is not None:
                write(encoded)
                return
            replace_file(os.fsdecode(_c.required(path, "path")), encoded)
            return
        text = _c.required(path, "path")
        pixels, target = self._target(os.path.splitext(os.fsdecode(text))[1].lower(), os.fsdecode(named))
        _c.call("write_image", text, ctypes.byref(target))

    def to_png(self) -> bytes:
        """The picture as the bytes of a PNG. Floats become sRGB codes; light above 1 is cut off."""
        return self.encode("png")

    def encode(self, format: str) -> bytes:
        """The picture as the bytes of a file: "png", "jpg", "webp", "bmp", "tga", or of float32 "exr", "hdr", "pfm". In 8-bit files floats
        become sRGB codes; light above 1 is cut off."""
        taken = []
        write = _c.Write(lambda user, bytes, count: taken.append(ctypes.string_at(bytes, count)))
        name = _c.required(format, "format")
        pixels, target = self._target(f".{format.lower()}", "encode")
        _c.call("encode_image", name, ctypes.byref(target), write, None)
        return taken[0]

    def _target(self, extension: str, name: str) -> Tuple[Any, ...]:
        """The pixels as a file of this kind has them, and the halflit_target that points to them."""
        is_linear = extension in _LINEAR
        if is_linear and self.dtype != np.float32:
            raise UsageError(f"{name}: expected a picture of float32, as by render(dtype=numpy.float32), found {self.dtype}")
        pixels = self._straight(name)
        if not is_linear:
            pixels = codes_of(pixels)
        if pixels.shape[2] == 3:
            solid = np.full(pixels.shape[:2] + (1,), 1 if is_linear else 255, pixels.dtype)
            pixels = np.concatenate([pixels, solid], axis=2)
        pixels = np.ascontiguousarray(pixels)
        target = _c.make("target")
        target.pixels, target.width, target.height = pixels.ctypes.data, pixels.shape[1], pixels.shape[0]
        target.format = _c.CONSTANTS["HALFLIT_FORMAT_RGBA_F32" if is_linear else "HALFLIT_FORMAT_RGBA8"]
        return pixels, target

    def _straight(self, name: str) -> Array:
        """The pixels, colours divided by alpha if they were multiplied by it."""
        pixels = np.asarray(self)
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or 0 in pixels.shape or pixels.dtype not in (np.uint8, np.float32):
            raise UsageError(f"{name}: expected uint8 or float32 of shape (height, width, 3 or 4), found {pixels.dtype} of {pixels.shape}")
        if not self.premultiplied or pixels.shape[2] == 3:
            return pixels
        straight, alpha = pixels.copy(), pixels[:, :, 3:]
        if pixels.dtype == np.float32:
            straight[:, :, :3] = np.where(alpha > 0, pixels[:, :, :3] / np.where(alpha > 0, alpha, 1), 0)
        else:
            wide = alpha.astype(np.uint32)
            divided = (pixels[:, :, :3].astype(np.uint32) * 255 + wide // 2) // np.maximum(wide, 1)
            straight[:, :, :3] = np.where(wide > 0, np.minimum(divided, 255), 0)
        return straight

    def _repr_html_(self) -> Optional[str]:
        """For Jupyter: the picture, with its size and its camera as a text."""
        try:
            data = base64.b64encode(self.to_png()).decode()
        except UsageError:
            return None
        lines = [f"{self.shape[1]} x {self.shape[0]}, {self.dtype}"]
        if self.camera is not None:
            place, name = self.camera.matrix, f"camera {self.camera.name!r}" if self.camera.name else "camera"
            eye, ahead = (", ".join(f"{x + 0.0:.4g}" for x in column) for column in (place[:3, 3], -place[:3, 2]))
            wide = "orthographic" if self.camera.orthographic else f"{math.degrees(self.camera.fov_y_rad):.3g}° high"
            lines.append(f"{name} at ({eye}), looking along ({ahead}), {wide}")
        text = html.escape("; ".join(lines))
        return f'<img src="data:image/png;base64,{data}" alt="{text}" title="{text}"><br><small>{text}</small>'

    def _repr_png_(self) -> Optional[bytes]:
        """For Jupyter; parts that are no picture, such as a row, are shown as numbers."""
        try:
            return self.to_png()
        except UsageError:
            return None


def replace_file(path: str, data: bytes) -> None:
    """Writes a file that is old or new, never half written. Each call has a temporary file of its own."""
    part = f"{path}.{os.urandom(8).hex()}.part"
    try:
        with open(part, "xb") as file:
            file.write(data)
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(part)
        raise


def codes_of(pixels: Array) -> Array:
    """uint8 sRGB codes of light; codes stay. Alpha is linear in both."""
    if pixels.dtype == np.uint8:
        return pixels
    light = np.clip(np.nan_to_num(pixels), 0, 1)
    share = srgb_from_linear(light)
    share[:, :, 3:] = light[:, :, 3:]
    return (share * 255 + 0.5).astype(np.uint8)
