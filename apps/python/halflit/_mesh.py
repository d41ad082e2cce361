"""The arrays of a mesh, checked, as the library reads them. This module imports numpy."""
from __future__ import annotations

import ctypes
from typing import Any, Dict, Optional

import numpy as np

from . import _arrays, _c
from ._errors import UsageError
from ._splats import Splats
from ._types import Array

#: Topology -> vertices of a primitive.
CORNERS = {"triangles": 3, "lines": 2, "points": 1}


def is_unlit(vertices: Any, topology: Any, normals: Any) -> bool:
    """Whether a mesh without a material is drawn without light, as those of files are: lines and points without normals have no side that
    light falls on."""
    return isinstance(vertices, Splats) or (topology != "triangles" and normals is None)


class MeshArrays:
    """Arguments of add_mesh() and set_mesh(). Everything is checked here, so that a mesh that is refused leaves nothing in the scene."""

    def __init__(self, name: Optional[str], topology: str, vertices: Any, faces: Any, normals: Any, **attributes: Any) -> None:
        if not isinstance(topology, str) or topology not in CORNERS:
            raise UsageError(f"topology: expected one of {', '.join(CORNERS)}, found {topology!r}")
        self.is_unlit = is_unlit(vertices, topology, normals)
        self.splats = None
        if isinstance(vertices, Splats):
            for argument, value in {"faces": faces, "normals": normals, **attributes}.items():
                if value is not None:
                    raise UsageError(f"{argument}: expected none beside Splats")
            self.splats, topology, vertices = vertices.struct(), "points", vertices.positions
        self.topology = topology
        self.name = _c.bytes_of(name, "name")
        positions = _arrays.positions(vertices, f"mesh {name!r}" if name else "a mesh")
        self.count = len(positions)
        self.corners = None if faces is None else _arrays.indices(faces, CORNERS[topology], self.count)
        if faces is None and self.count % CORNERS[topology]:
            raise UsageError(f"vertices: {self.count} without faces, expected {CORNERS[topology]} for each of the {topology}")
        self.is_smooth = isinstance(normals, str)
        if isinstance(normals, str):
            if normals != "smooth" or topology != "triangles":
                raise UsageError(f'normals: expected an array, or "smooth" for triangles, found {normals!r}')
            normals = None
        #: member of halflit_mesh -> array or None
        self.arrays: Dict[str, Optional[Array]] = {"positions": positions, "indices": self.corners}
        named = (("normals", "normals", normals, 3), ("uv0", "uv", attributes["uv"], 2), ("uv1", "uv1", attributes["uv1"], 2))
        for member, argument, value, columns in (*named, ("tangents", "tangents", attributes["tangents"], 4)):
            self.arrays[member] = None if value is None else _arrays.finite(value, columns, argument, self.count)
        colors = attributes["colors"]
        if colors is None and attributes["colors_space"] is not None:
            raise UsageError("colors_space: has no effect without colors")
        self.arrays["colors"] = None if colors is None else _arrays.colors(colors, self.count, attributes["colors_space"])

    def struct(self, material: int) -> Any:
        """The halflit_mesh, which points to the arrays of this object."""
        mesh = _c.make("mesh")
        for member, array in self.arrays.items():
            setattr(mesh, member, None if array is None else array.ctypes.data)
        mesh.vertex_count, mesh.index_count = self.count, 0 if self.corners is None else self.corners.size
        mesh.topology = _c.CONSTANTS["HALFLIT_TOPOLOGY_" + self.topology.upper()]
        mesh.splats = None if self.splats is None else ctypes.addressof(self.splats)
        mesh.name, mesh.smooth = self.name, self.is_smooth
        mesh.put("material", material, "material")
        return mesh
