"""Motion between two pictures. This module imports numpy."""
from __future__ import annotations

from typing import Any
import ctypes

import numpy as np

from . import _c
from ._errors import UsageError
from ._setup import given_camera
from ._types import Array

_NEEDED = {"id": "int32", "triangle": "int32", "barycentric": "float32"}


def motion(scene: Any, picture: Any, camera: Any, other: Any) -> Array:
    """See Scene.motion()."""
    aovs, drawn = getattr(picture, "aovs", {}), getattr(picture, "camera", None)
    missing = [name for name in _NEEDED if name not in aovs]
    if missing or drawn is None:
        raise UsageError(f"picture: expected one drawn with aovs {', '.join(_NEEDED)}, found none of {', '.join(missing)}")
    if picture.settings["region"][2] > 0:
        raise UsageError("picture: expected one of the whole view, found a region")
    planes = [np.ascontiguousarray(aovs[name], kind) for name, kind in _NEEDED.items()]
    height, width = planes[0].shape
    found = np.empty((height, width, 2), np.float32)
    views = [given_camera(view) for view in (drawn, camera)]
    first, second = (ctypes.byref(view._c) for view in views)
    pointers = [plane.ctypes.data for plane in planes]
    for one in (scene, other):
        one._check_open()
    _c.call("motion", scene._handle, first, other._handle, second, width, height, *pointers, width * height, found.ctypes.data)
    return found
