"""The library's copy of a model's shapes and textures."""
from __future__ import annotations

import ctypes
import re
from typing import Any, Dict, Optional

import numpy as np

from halflit import _c
from halflit._errors import UsageError
from halflit._values import shown

from ._layouts import COLOR_ROLE, Version, layout_of

_TYPES = {"int32_t": "i4", "int64_t": "i8", "uint8_t": "u1", "float": "f4", "double": "f8"}
_ARRAYS = re.findall(r"const (\w+)\* (\w+);", " ".join(_c.STRUCTS["halflit_mujoco_model"].split()))
_VISUAL = {
    "map": ("znear", "zfar", "shadowclip", "shadowscale", "fogstart", "fogend", "haze"),
    "quality": ("shadowsize", "numslices", "numstacks", "numquads"),
    "global_": ("linewidth",),
}
#: Names before 3.0 and 3.2.
_OLDER = {"nmeshnormal": "nmeshvert", "nmeshtexcoord": "nmeshtexvert", "tex_data": "tex_rgb"}
#: First releases of looks, and their names.
LOOKS = (((2, 2), "2.2.2"), ((3, 3), "3.3.2"), ((3, 3, 3), "3.3.3"), ((3, 12), "3.12.0"))


def look_of(look: Optional[str], version: Version) -> str:
    """The look of a release of MuJoCo: of the one that is asked for, or of this version."""
    if look is not None:
        found = re.fullmatch(r"(2|3)\.(\d{1,2})(?:\.(\d{1,2}))?", str(look))
        version = tuple(int(part or 0) for part in found.groups()) if found else ()
        if version < (2, 2):
            raise UsageError(f"look: expected a release of MuJoCo from 2.2 on, below 4, such as {LOOKS[-1][1]}, found {shown(look)}")
    return [name for since, name in LOOKS if since <= max(version, LOOKS[0][0])][-1]


def checked_threads(threads: int) -> int:
    """The number, if it is one that pictures can be drawn by."""
    if not 0 <= threads <= 4096:
        raise UsageError(f"threads: expected 0 to 4096, found {threads}")
    return threads


def handle_of(model: Any, version: Version, look: str, threads: int, scene: Any, changed: Dict[str, Any]) -> Any:
    """A halflit_mujoco. scene: whose flexes have room for as many triangles as the others of this model.
    changed: members of halflit_mujoco_model in place of the model's."""
    struct, kept = _c.make("mujoco_model"), []
    layout = layout_of(version)
    struct.layout = ctypes.addressof(layout.struct)
    struct.extent = model.stat.extent
    for group, names in _VISUAL.items():
        for name in names:
            struct.put(name, getattr(getattr(model.vis, group), name), name)
    struct.fog_rgba[:], struct.haze_rgba[:] = list(model.vis.rgba.fog), list(model.vis.rgba.haze)
    for name, _ in struct._fields_:
        if name.startswith("n") and not name.startswith("num"):
            struct.put(name, int(getattr(model, name, getattr(model, _OLDER.get(name, ""), 0))), name)
    for kind, name in _ARRAYS:
        if kind in _TYPES:
            value: Any = getattr(model, name, None) if name != "flex_facenum" else getattr(scene, "flexfacenum", None)
            if value is None and name in _OLDER:
                value = getattr(model, _OLDER[name], None)
            if name == "mat_texid" and getattr(value, "ndim", 1) == 2:
                value = value[:, COLOR_ROLE]
            if value is not None and np.size(value):
                kept.append(np.ascontiguousarray(value, _TYPES[kind]))
                setattr(struct, name, kept[-1].ctypes.data)
    for name, value in changed.items():
        if name == "fog_rgba":
            struct.fog_rgba[:] = list(value)
        else:
            struct.put(name, value, name)
    execution = _c.make("execution")
    execution.threads, execution.stop_at_interrupt = threads, _c.stops_at_interrupt()
    return _c.Handle("mujoco_create", "mujoco_destroy", ctypes.byref(struct), look.encode(), ctypes.byref(execution))
