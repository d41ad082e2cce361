"""Copies of what a mjvScene shows, by addresses of its memory, or by its attributes."""
from __future__ import annotations

import ctypes
import functools
import sys
import weakref
from typing import Any, Dict, List, Tuple, Union

import numpy as np

from halflit import _c
from halflit._errors import UsageError

from ._layouts import Layout, Version, layout_of, version_of

#: Members of mjvScene and of halflit_mujoco_scene that are arrays of numbers.
_ARRAYS = {"skinvert": "f4", "skinnormal": "f4", "flexfaceused": "i4", "flexface": "f4", "flexnormal": "f4"}
#: Numbers of flags, as the library counts them.
_WIREFRAME, _SEGMENT = 1, 7
_STRUCTS = {"geoms": "geom", "lights": "light", "camera": "camera"}


class _Elsewhere(Exception):
    """The objects' arrays are not in one piece of memory, or it has another layout."""


def version_of_scene(scene: Any) -> Version:
    """Of the module that the object is from, else of `mujoco`, else 2.2.2."""
    for name in (type(scene).__module__.partition(".")[0], "mujoco"):
        version = getattr(sys.modules.get(name), "__version__", None)
        if isinstance(version, str) and name != "halflit":
            return version_of(version)
    return (2, 2, 2)


def address_of(array: Any) -> int:
    """Of an array's memory."""
    try:
        return int(array.__array_interface__["data"][0])
    except AttributeError:
        raise _Elsewhere from None


class _Memory:
    """Where a scene's structs and arrays are, which does not change in its life. Addresses are those of the views of numpy that its objects
    have; each of the members that the library reads is compared with the object's attribute."""

    def __init__(self, scene: Any, layout: Layout) -> None:
        self.base = {name: self._base(getattr(scene, name), layout.types[struct], layout.read[struct]) for name, struct in _STRUCTS.items()}
        self.arrays: List[Tuple[str, int, int]] = []
        for name in _ARRAYS:
            array = getattr(scene, name, None)
            if array is not None and array.size:
                self.arrays.append((name, address_of(array), array.nbytes))
        self.flags = (ctypes.c_uint8 * (layout.flags[-1] + 1)).from_address(address_of(scene.flags))
        self.translate, self.rotate = address_of(scene.translate), address_of(scene.rotate)

    @staticmethod
    def _base(things: Any, kind: np.dtype[Any], members: List[str]) -> int:
        if len(things) == 0:
            return 0
        fields: Any = kind.fields
        base = address_of(things[0].pos) - int(fields["pos"][1])
        for i, thing in enumerate(things[:2]):
            for name in members:
                value, at = getattr(thing, name), base + i * kind.itemsize + int(fields[name][1])
                if getattr(value, "ndim", 0):
                    if address_of(value) != at:
                        raise _Elsewhere
                    continue
                here = np.frombuffer((ctypes.c_uint8 * fields[name][0].itemsize).from_address(at), fields[name][0])[0]
                if here != value and value == value:
                    raise _Elsewhere
        return base


#: Memory of scenes by their id; None: by attributes.
_KNOWN: Dict[int, Tuple[Any, Any]] = {}


def _forget(key: int, _: Any) -> None:
    _KNOWN.pop(key, None)


def _memory_of(scene: Any, layout: Layout) -> Any:
    known = _KNOWN.get(id(scene))
    if known is not None and known[0]() is scene:
        return known[1]
    try:
        memory: Any = _Memory(scene, layout)
    except (_Elsewhere, AttributeError, TypeError):
        memory = None
    try:
        _KNOWN[id(scene)] = weakref.ref(scene, functools.partial(_forget, id(scene))), memory
    except TypeError:  # it has no weak references: it is looked at each time
        pass
    return memory


def _packed(things: Any, kind: np.dtype[Any], members: List[str]) -> Any:
    rows = np.zeros(len(things), kind)
    for name in members:
        column = rows[name]
        for i, thing in enumerate(things):
            column[i] = np.reshape(getattr(thing, name), column.shape[1:])
    return rows


class Snapshot:
    """A copy of what a scene shows, as the library reads it. It is used again for other scenes of that layout: memory grows and stays."""

    def __init__(self) -> None:
        self.struct = _c.make("mujoco_scene")
        self.address = ctypes.addressof(self.struct)
        self._buffers: Dict[str, Any] = {}
        self._memory: Any = None
        self._camera: Any = None
        self.sizes: Dict[str, int] = {}  #: bytes of skins and flexes
        self.handle: Any = None  #: the copy of the model that it is drawn with
        self.rect = (0, 0, 0, 0)

    def take(self, scene: Any) -> "Snapshot":
        layout = layout_of(version_of_scene(scene))
        memory = _memory_of(scene, layout)
        self._camera, struct = layout.types["camera"], self.struct
        counts = {"geoms": int(scene.ngeom), "lights": int(scene.nlight), "camera": 2}
        if not 0 <= counts["geoms"] <= int(getattr(scene, "maxgeom", counts["geoms"])) or not 0 <= counts["lights"] <= 100:
            raise UsageError(f"scene: ngeom is {counts['geoms']}, nlight is {counts['lights']}: more than it has room for, or below 0")
        struct.ngeom, struct.nlight = counts["geoms"], counts["lights"]
        self.sizes = {}
        struct.enabletransform = int(scene.enabletransform)
        if memory is None or memory is not self._memory:
            self._memory = memory
            for name in _ARRAYS:  # that another scene may have had
                self._buffers.pop(name, None)
                setattr(struct, name, None)
        if memory is None:
            self._take_attributes(scene, layout, counts)
        else:
            for name, struct_name in _STRUCTS.items():
                self._copy(name, memory.base[name], counts[name] * layout.types[struct_name].itemsize)
            for name, address, size in memory.arrays:
                self._copy(name, address, size)
                self.sizes[name] = size
            given = bytes(memory.flags)
            self._keep("flags", given if len(given) == 10 else bytes(given[i] for i in layout.flags))
            if struct.enabletransform:
                ctypes.memmove(struct.translate, memory.translate, 12)
                ctypes.memmove(struct.rotate, memory.rotate, 16)
                struct.scale = float(scene.scale)
        return self

    def _take_attributes(self, scene: Any, layout: Layout, counts: Dict[str, int]) -> None:
        for name, struct_name in _STRUCTS.items():
            things = getattr(scene, name)[: counts[name]]
            self._keep(name, _packed(things, layout.types[struct_name], layout.read[struct_name]).tobytes())
        for name, kind in _ARRAYS.items():
            array = np.ascontiguousarray(getattr(scene, name, ()), kind)
            if array.size:
                self._keep(name, array.tobytes())
                self.sizes[name] = array.nbytes
        self._keep("flags", bytes(int(scene.flags[i]) for i in layout.flags))
        if self.struct.enabletransform:
            self.struct.translate[:], self.struct.rotate[:] = list(scene.translate), list(scene.rotate)
            self.struct.scale = float(scene.scale)

    def _keep(self, name: str, data: bytes) -> None:
        self._copy(name, data, len(data))

    def _copy(self, name: str, source: Union[int, bytes], size: int) -> None:
        buffer = self._buffers.get(name)
        if buffer is None or len(buffer) < size:
            buffer = self._buffers[name] = (ctypes.c_uint8 * (size + size // 2 + 8))()
            self.struct.put(name, ctypes.addressof(buffer), name)
        if size:
            ctypes.memmove(buffer, source, size)

    @property
    def is_segment(self) -> bool:
        return bool(self._buffers["flags"][_SEGMENT])

    @property
    def is_wireframe(self) -> bool:
        return bool(self._buffers["flags"][_WIREFRAME])

    def planes(self) -> Tuple[float, float, bool]:
        """Distances of the near and the far plane, and whether the rays are parallel."""
        cameras = np.frombuffer(self._buffers["camera"], self._camera, 2)
        near, far = float(cameras["frustum_near"].mean()), float(cameras["frustum_far"].mean())
        return near, far, "orthographic" in self._camera.names and bool(cameras["orthographic"][0])
