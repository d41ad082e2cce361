"""The memory of a frame: the picture, and the planes beside it. This module imports numpy."""
from __future__ import annotations

import ctypes
from typing import Any, Dict, Tuple

import numpy as np

from . import _c
from ._errors import UsageError
from ._options import AOVS, DERIVED, PLANES
from ._picture import Picture
from ._types import Array
from ._values import shown, sized, truth


class Target:
    """A halflit_target, and the arrays that it points to. The region that is asked for is written into the settings."""

    def __init__(self, size: Tuple[int, int], settings: Any, options: Dict[Any, Any]) -> None:
        self.struct = _c.make("target")
        self.struct.width, self.struct.height = size
        width, height = region_of(size, options, settings, self.struct)
        premultiplied = options.get("premultiplied") is not None and truth(options["premultiplied"], "premultiplied")
        pixels = pixels_of((height, width, 4), options)
        format_name = "RGBA_F32" if pixels.dtype == np.float32 else "RGBA8"
        self.struct.format = _c.CONSTANTS[f"HALFLIT_FORMAT_{format_name}{'_PREMULTIPLIED' if premultiplied else ''}"]
        self.struct.pixels, self.struct.row_bytes = pixels.ctypes.data, pixels.strides[0]
        self.picture = pixels.view(Picture)
        self.picture.premultiplied = premultiplied
        self.asked = names_of(options)
        self.planes = planes_of((height, width), self.asked)
        for name, plane in self.planes.items():
            setattr(self.struct, PLANES[name][0], plane.ctypes.data)

    def derive(self, scene: Any, camera: Any, region: Any) -> Dict[str, Array]:
        """The planes that are asked for, of those that were drawn. Everything is in the file's world."""
        found = {}
        for name in self.asked:
            plane = self.planes[DERIVED.get(name, name)]
            if name in DERIVED:
                plane = plane.copy()
                if name == "ray":
                    size = self.struct.width, self.struct.height
                    _c.call("ray_distances", ctypes.byref(camera._c), *size, ctypes.byref(region), plane.ctypes.data)
                elif name == "view_normal":
                    _c.call("view_normals", ctypes.byref(camera._c), plane.ctypes.data, plane.size // 3)
                elif name == "depth16":
                    codes, extent = np.empty(plane.shape, np.uint16), (ctypes.c_double * 2)()
                    _c.call("depth_codes", plane.ctypes.data, plane.size, codes.ctypes.data, ctypes.addressof(extent))
                    plane = codes
                elif name == "part":
                    plane = part_numbers(scene)[plane]
                else:
                    _c.call(f"scene_{name}_numbers", scene._handle, plane.ctypes.data, plane.size)
            found[name] = plane
        return found


def part_numbers(scene: Any) -> Array:
    """The part of each instance, by its index plus 1."""
    counts = scene.counts
    numbers = np.arange(counts["instances"] + 1, dtype=np.int32)
    if counts["nodes"] > 0:
        numbers[:] = 0
        placing = [node["instances"] for node in scene.nodes if node["instances"]]
        for number, instances in enumerate(placing, 1):
            numbers[np.array(instances) + 1] = number
    return numbers


def region_of(size: Tuple[Any, ...], options: Dict[Any, Any], settings: Any, target: Any) -> Tuple[Any, ...]:
    """Width and height of what is drawn."""
    if options.get("region") is None:
        return size
    region = sized(options["region"], "region")
    if len(region) != 4:
        raise UsageError(f"region: expected x, y, width and height, found {shown(options['region'])}")
    x, y, width, height = region
    if min(x, y) < 0 or min(width, height) < 1 or x + width > size[0] or y + height > size[1]:
        found = ",".join(map(str, region))
        raise UsageError(f"region: expected a part of the {size[0]}x{size[1]} picture, found {found}")
    for name, value in zip(("x", "y", "width", "height"), region):
        setattr(settings.region, name, value)
    target.region_alone = 1
    return width, height


def pixels_of(shape: Tuple[Any, ...], options: Dict[Any, Any]) -> Array:
    """The array to draw into: that of the caller, or a new one."""
    asked, out = options.get("dtype"), options.get("out")
    if out is not None and not isinstance(out, np.ndarray):
        raise UsageError(f"out: expected an array, found {shown(out)}")
    try:
        wanted = None if asked is None else np.dtype(asked)
    except (TypeError, ValueError):
        raise UsageError(f"dtype: expected uint8 or float32, found {shown(asked)}") from None
    dtype = out.dtype if out is not None else wanted or np.dtype(np.uint8)
    if dtype not in (np.uint8, np.float32) or wanted not in (None, dtype):
        raise UsageError(f"dtype: expected uint8 or float32, and that of `out`, found {dtype if wanted is None else wanted}")
    if out is None:
        return np.empty(shape, dtype)
    if out.shape != shape:
        raise UsageError(f"out: expected an array of shape {shape}, found {out.shape}")
    item = out.itemsize
    if out.strides[1:] != (4 * item, item) or out.strides[0] < shape[1] * 4 * item:
        raise UsageError("out: expected pixels without gaps, rows one after another")
    if not out.flags.writeable or out.ctypes.data % item:
        raise UsageError("out: expected memory that is writeable and aligned")
    return out


def names_of(options: Dict[Any, Any]) -> Tuple[str, ...]:
    """Names of the planes that are asked for, each once."""
    asked = options.get("aovs")
    if asked is None:
        return ()
    if isinstance(asked, str):
        asked = AOVS if asked == "all" else (asked,)
    listed: Tuple[Any, ...] = tuple(asked) if hasattr(asked, "__iter__") else (asked,)
    for name in listed:
        if not isinstance(name, str) or name not in AOVS:
            raise UsageError(f"aovs: expected names of {', '.join(AOVS)}, found {shown(name)}")
    return tuple(dict.fromkeys(listed))


def planes_of(shape: Tuple[Any, ...], asked: Tuple[str, ...]) -> Dict[str, Array]:
    """New arrays for the planes that are drawn: those that are asked for, or that these are made of."""
    planes = {}
    for name in dict.fromkeys(DERIVED.get(name, name) for name in asked):
        _, channels, kind = PLANES[name]
        planes[name] = np.empty(shape if channels == 1 else (*shape, channels), kind)
    return planes
