"""Where the members of mjvGeom, mjvLight and mjvGLCamera are in memory, in each version of MuJoCo."""
from __future__ import annotations

import functools
import re
from typing import Any, Dict, List, Tuple

import numpy as np

from halflit import _c

Version = Tuple[int, ...]

#: Members in their order: type, count, name, and the versions that have it, FROM:BEFORE. i: int, f: float, b: mjtByte, S: char.
_MEMBERS = {
    "geom": """i type, i dataid, i objtype, i objid, i category, i matid 3.2:, i texid :3.2, i texid 3.11:, i texuniform :3.2,
        i texuniform 3.11:, i texcoord, i segid, f2 texrepeat :3.2, f3 size, f3 pos, f9 mat, f4 rgba, f emission, f specular, f shininess,
        f reflectance, f2 texrepeat 3.11:, S100 label, f camdist, f modelrbound, b transparent""",
    "light": """i id 3.3.6:, f3 pos, f3 dir, i type 3.3.3:, i texid 3.3.3:, f3 attenuation, f cutoff, f exponent, f3 ambient, f3 diffuse,
        f3 specular, b headlight, b directional :3.3.3, b castshadow, f bulbradius 3.1.5:, f intensity 3.3.3:, f range 3.3.3:,
        f softness 3.12:""",
    "camera": """f3 pos, f3 forward, f3 up, f frustum_center, f frustum_width 3.0:, f frustum_bottom, f frustum_top, f frustum_near,
        f frustum_far, i orthographic 3.2:""",
}
_TYPES = {"i": "i4", "f": "f4", "b": "u1", "S": "S"}
#: Numbers of mjtGeom from a version on.
_NUMBERS: Tuple[Tuple[Version, Dict[str, int]], ...] = (
    ((2,), {"skin": 104}),
    ((3, 0), {"flex": 104, "skin": 105, "triangle": 107}),
    ((3, 1, 1), {"linebox": 104, "flex": 105, "skin": 106, "triangle": 108}),
)
#: From here on mjtRndFlag has mjRND_DEPTH, its number 7, which halflit does not draw.
_HAS_DEPTH_FLAG = (3, 5)
#: Where one of 3.2 to 3.10 has the texture of the colour, among the textures of a material.
COLOR_ROLE = 1


def version_of(text: str) -> Version:
    return tuple(int(part) for part in re.findall(r"\d+", text)[:3])


def _is_in(version: Version, versions: str) -> bool:
    since, _, before = versions.partition(":")
    return version_of(since or "0") <= version and (not before or version < version_of(before))


def _dtype(struct: str, version: Version) -> np.dtype[Any]:
    fields: List[Any] = []
    for member in _MEMBERS[struct].split(","):
        kind, name, versions = (*member.split(), ":")[:3]
        if _is_in(version, versions):
            count = kind[1:]
            fields.append((name, _TYPES[kind[0]] + count) if kind[0] == "S" else (name, _TYPES[kind[0]], (int(count),) if count else ()))
    return np.dtype(fields, align=True)


class Layout:
    """The structs of a version, as numpy and as the library read them."""

    def __init__(self, version: Version) -> None:
        self.types = {name: _dtype(name, version) for name in _MEMBERS}
        numbers = [row for since, row in _NUMBERS if since <= version][-1]
        self.flags = [i for i in range(11) if i != 7] if version >= _HAS_DEPTH_FLAG else list(range(10))
        self.struct = _c.make("mujoco_layout")
        #: Members of each struct that the library reads.
        self.read: Dict[str, List[str]] = {name: [] for name in _MEMBERS}
        for field, _ in self.struct._fields_[1:]:
            struct, _, member = field.partition("_")
            if struct == "type":
                place = numbers.get(member, -1)
            elif member == "size":
                place = self.types[struct].itemsize
            else:
                place = self._place(struct, member)
            self.struct.put(field, place, field)

    def _place(self, struct: str, member: str) -> int:
        fields: Any = self.types[struct].fields
        for name in ("size" if member == "scale" else member, f"frustum_{member}"):
            if name in fields:
                self.read[struct].append(name)
                return int(fields[name][1])
        return -1


@functools.lru_cache(None)
def layout_of(version: Version) -> Layout:
    return Layout(version)
