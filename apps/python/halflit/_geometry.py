"""Textures, materials, meshes and instances of a scene."""
from __future__ import annotations

import ctypes
import math
from typing import Any, Dict, List, Literal, Optional, Tuple, Union, cast

from . import _c
from ._errors import UsageError
from ._lazy import np
from ._color import color as color_of
from ._material import Material
from ._members import MaterialMembers
from ._record import chosen
from ._scene_base import SceneBase
from ._types import Array, Encoding, Part, TextureEncoding, Topology, Unpack
from ._values import shown, truth, whole

_COLORS = {"srgb": "SRGB", "linear": "LINEAR", "srgb_by_alpha": "SRGB_BY_ALPHA", "normal": "NORMAL"}

MaterialOf = Union[int, Material, MaterialMembers, None]


class MeshIndex(int):
    """The index of a mesh, an int, as Scene.add_mesh() returns it. instance: index of the instance that places it; None: it is not placed."""

    instance: Optional[int]

    def __new__(cls, index: int, instance: Optional[int] = None) -> MeshIndex:
        made = super().__new__(cls, index)
        made.instance = instance
        return made


def plain_material(is_unlit: bool) -> Material:
    """The material of a mesh that is given none, as that of models without materials. is_unlit: see _mesh.py."""
    return Material(roughness=0.6, double_sided=True, unlit=is_unlit)


class Geometry(SceneBase):
    """The methods of a Scene about what reflects light."""

    # ---- textures and materials -----------------------------------------------------------------------------------------

    def add_texture(self, pixels: Any, color: TextureEncoding = "srgb") -> int:
        """Adds a texture of uint8 (height, width) or (height, width, 1 to 4 channels), row 0 on top, or of a PIL picture, and returns its
        index. One channel is grey, two are grey and alpha.

        color: "srgb", "linear", "srgb_by_alpha" (for materials that mask or blend) or "normal" (a normal map).
        """
        index = ctypes.c_int32()
        self._texture("scene_add_texture", (), pixels, color, (ctypes.byref(index),))
        return index.value

    def set_texture(self, index: int, pixels: Any, color: TextureEncoding = "srgb") -> None:
        """Replaces a texture; the size may differ."""
        self._texture("scene_set_texture", (index,), pixels, color, ())

    def remove_texture(self, index: int) -> None:
        """Removes a texture that no material uses; add_texture() may use its index again."""
        self._change("scene_remove_texture", index)

    def _texture(self, name: str, before: Tuple[Any, ...], pixels: Any, color: str, after: Tuple[Any, ...]) -> None:
        from ._arrays import rgba8

        if not isinstance(color, str) or color not in _COLORS:
            raise UsageError(f"color: expected one of {', '.join(_COLORS)}, found {shown(color)}")
        array = rgba8(pixels)
        code = _c.CONSTANTS["HALFLIT_COLOR_" + _COLORS[color]]
        self._change(name, *before, array.ctypes.data, array.shape[1], array.shape[0], array.strides[0], code, *after)

    def add_material(self, material: Union[Material, MaterialMembers, None] = None, **members: Unpack[MaterialMembers]) -> int:
        """Adds a Material with these members, and returns its index: add_material(base_color=(1, 0.4, 0.2), roughness=0.3)."""
        index = ctypes.c_int32()
        made = Material._from({} if material is None else material, **members)
        self._change("scene_add_material", ctypes.byref(made._c), ctypes.byref(index))
        return index.value

    def material(self, index: int) -> Material:
        """A material of the scene. Change a member, then call set_material()."""
        material = Material()
        with self._lock:  # its name is the scene's
            self._call("scene_get_material", index, ctypes.byref(material._c))
            copied: Material = material._copied()
            return copied

    def set_material(self, index: int, material: Union[Material, MaterialMembers, None] = None, **members: Unpack[MaterialMembers]) -> None:
        """Replaces a material in all that has it, or some of its members: set_material(0, roughness=0.3)."""
        with self._lock:
            made = Material._from(self.material(index) if material is None else material, **members)
            self._change("scene_set_material", index, ctypes.byref(made._c))

    # ---- meshes ---------------------------------------------------------------------------------------------------------

    def add_mesh(
        self,
        vertices: Any,
        faces: Any = None,
        *,
        normals: Any = None,
        uv: Any = None,
        uv1: Any = None,
        colors: Any = None,
        colors_space: Optional[Encoding] = None,
        tangents: Any = None,
        material: MaterialOf = None,
        topology: Topology = "triangles",
        name: Optional[str] = None,
        matrix: Any = None,
        place: bool = True,
    ) -> MeshIndex:
        """Adds a mesh and returns its index. It is drawn where `matrix` (4 x 4; the identity) places it, unless place is False.

        The index is an int whose member `instance` is the index of the instance that places the mesh, or None. set_instance(), look()
        and aovs["id"] - 1 mean that one: arm = scene.add_mesh(v, f), then scene.set_instance(arm.instance, matrix).

        vertices: (n, 3) world units; what has a corner that is not finite is left out, with a warning; or halflit.Splats, 3D Gaussians
        without faces, normals, uv, colors and tangents. faces: (m, 3) vertex numbers, counter-clockwise seen from the front; None: 0 1 2, 3 4 5 and so on.
        normals: (n, 3), "smooth" (made from the faces around each position, anew when they move), or None: each triangle is flat.
        uv, uv1: (n, 2), v = 0 is the first row of a texture. tangents: (n, 4), direction and +1 or -1.
        colors: (n, 3) or (n, 4), uint8 sRGB codes, or linear floats, where 1 is white; above 16 they are taken for codes and refused.
        colors_space: "srgb": floats, too, are sRGB values, 0 to 1; "linear": uint8, too, are linear.
        material: index, Material, or a dict of its members; None: white, roughness 0.6, seen from both sides. Lines and points without
        normals have no side that light falls on: None is unlit for them, as in glTF.
        topology: "triangles", "lines" (faces: (m, 2)) or "points" (faces: (m,)).
        """
        from ._mesh import MeshArrays

        with self._lock:
            arrays = MeshArrays(name, topology, vertices, faces, normals, uv=uv, uv1=uv1, colors=colors, colors_space=colors_space,
                                tangents=tangents)  # fmt: skip
            at = self._placement(matrix)
            index = ctypes.c_int32()
            own = isinstance(material, (Material, dict))
            used = self._plain_material(arrays.is_unlit) if material is None else self._material_index(material)
            self._change("scene_add_mesh", ctypes.byref(arrays.struct(used)), ctypes.byref(index))
            self._remember(index.value, arrays, used, own)
            return MeshIndex(index.value, self._add_instance(index.value, at) if place else None)

    def set_mesh(self, index: int, vertices: Any, faces: Any = None, *, normals: Any = None, uv: Any = None, uv1: Any = None,
                 colors: Any = None, colors_space: Optional[Encoding] = None, tangents: Any = None,
                 material: MaterialOf = None, topology: Topology = "triangles", name: Optional[str] = None) -> None:  # fmt: skip
        """Replaces a mesh in all its instances; arguments as in add_mesh(), but material None: the mesh keeps its material, unless
        it was given none.

        A Material or a dict replaces the material that was made for this mesh alone, if it has such a one.
        """
        from ._mesh import MeshArrays

        with self._lock:
            arrays = MeshArrays(name, topology, vertices, faces, normals, uv=uv, uv1=uv1, colors=colors, colors_space=colors_space,
                                tangents=tangents)  # fmt: skip
            if material is None and index not in self._materials:
                raise UsageError(f"material: expected one, as mesh {shown(index)} was not added by add_mesh()")
            own = isinstance(material, (Material, dict))
            self._check_mesh(index)  # before a material is added
            if isinstance(material, (Material, dict)) and index in self._own_materials:
                used = self._own_materials[index]
                self.set_material(used, material)
            else:
                used = self._kept_material(index, arrays.is_unlit) if material is None else self._material_index(material)
            self._change("scene_set_mesh", index, ctypes.byref(arrays.struct(used)))
            self._remember(index, arrays, used, own or (material is None and index in self._own_materials))

    def _remember(self, mesh: int, arrays: Any, material: int, own: bool) -> None:
        self._materials[mesh] = material
        self._own_materials.pop(mesh, None)
        if own:
            self._own_materials[mesh] = material
        (self._smooth.add if arrays.is_smooth else self._smooth.discard)(mesh)

    def _material_index(self, material: Union[int, Material, MaterialMembers]) -> int:
        if isinstance(material, (Material, dict)):
            return self.add_material(material)
        return cast(int, material)

    def _check_mesh(self, index: int) -> None:
        if not 0 <= whole(index, "mesh", -(2**31), 2**31 - 1) < self.counts["meshes"]:
            raise UsageError(f"mesh {index}, but the scene has {self.counts['meshes']}")

    def _plain_material(self, is_unlit: bool) -> int:
        """The material of meshes that are given none."""
        if is_unlit not in self._plain:
            self._plain[is_unlit] = self.add_material(plain_material(is_unlit))
        return self._plain[is_unlit]

    def _kept_material(self, mesh: int, is_unlit: bool) -> int:
        used = self._materials[mesh]
        return self._plain_material(is_unlit) if used in self._plain.values() else used

    def set_vertices(self, mesh: int, vertices: Any, normals: Any = None) -> None:
        """Moves the vertices of a mesh that was added: (n, 3), n as before. Splats are replaced by set_mesh().

        normals: (n, 3), or "smooth" as in add_mesh() if the mesh was added so. None: those of a mesh that was given none are made anew,
        smooth or flat as before; others stay as they are.
        """
        from . import _arrays

        with self._lock:
            positions = _arrays.positions(vertices, f"mesh {shown(mesh)}")
            if isinstance(normals, str) and (normals != "smooth" or mesh not in self._smooth):
                raise UsageError(f'normals: expected an array, or "smooth" for a mesh that was added so, found {normals!r}')
            made = normals is None or isinstance(normals, str)
            directions = None if made else _arrays.finite(normals, 3, "normals", len(positions))
            pointer = None if directions is None else directions.ctypes.data
            self._change("scene_set_vertices", mesh, positions.ctypes.data, pointer, len(positions))
            if not made:
                self._smooth.discard(mesh)

    def remove_mesh(self, mesh: int) -> None:
        """Removes a mesh that no instance places; add_mesh() may use its index again."""
        with self._lock:
            self._change("scene_remove_mesh", mesh)
            self._smooth.discard(mesh)
            self._materials.pop(mesh, None)
            self._own_materials.pop(mesh, None)

    # ---- instances ------------------------------------------------------------------------------------------------------

    def add_instance(self, mesh: int, matrix: Any = None, *, color: Any = None, material: Optional[int] = None, visible: bool = True,
                     name: Optional[str] = None) -> int:  # fmt: skip
        """Places a mesh in the world by a 4 x 4 matrix (the identity), and returns the instance's index.

        color: linear RGB or RGBA, or "#rrggbb", times the material's base colour. material: index, in place of the mesh's.
        visible: False: it is not drawn, casts no shadow, and views do not look at it. name: see name().
        """
        visible = truth(visible, "visible")
        with self._lock:
            index = self._add_instance(mesh, self._placement(matrix))
            if color is not None or material is not None or name is not None or not visible:
                try:
                    self.set_instance(index, color=color, material=material, visible=visible, name=name)
                except Exception:
                    self._change("scene_remove_instance", index)
                    raise
            return index

    def _add_instance(self, mesh: int, place: Array) -> int:
        with np.errstate(over="ignore"):  # the library refuses what is infinite then
            index, coarse = ctypes.c_int32(), place.astype(np.float32)
        self._change("scene_add_instance", mesh, coarse.ctypes.data, ctypes.byref(index))
        if (coarse != place).any():
            self._place(index.value, place)
        return index.value

    def _place(self, index: int, place: Array) -> None:
        which = ctypes.c_int32(whole(index, "index", -(2**31), 2**31 - 1))
        self._change("scene_place_instances_double", ctypes.byref(which), 1, place.ctypes.data)

    def add_instances(self, mesh: int, matrices: Any) -> range:
        """Places a mesh by many matrices, (n, 4, 4), and returns the instances' indices."""
        places, first = self._placements(matrices), ctypes.c_int32()
        self._change("scene_add_instances_double", mesh, len(places), places.ctypes.data, ctypes.byref(first))
        return range(first.value, first.value + len(places))

    def instance(self, index: int) -> Tuple[int, Array]:
        """Mesh and matrix, float64 (4, 4), of an instance."""
        found = self._instance(index)
        matrix = np.array(found.world_from_object, np.float64).reshape(4, 4).T.copy()
        matrix[:3, 3] += found.place_rest
        return found.mesh, matrix

    def look(self, index: int) -> Dict[str, Any]:
        """Other properties of an instance: color (linear RGBA), material (None: the mesh's), visible, name, node (None: it is of no file)."""
        found = self._instance(index)
        return {
            "color": tuple(found.color),
            "material": None if found.material < 0 else found.material,
            "visible": bool(found.visible),
            "name": self.name("instance", index),
            "node": None if found.node < 0 else found.node,
        }

    def _instance(self, index: int) -> Any:
        found = _c.make("instance", False)
        self._call("scene_get_instance", index, ctypes.byref(found))
        return found

    def set_instance(self, index: int, matrix: Any = None, *, color: Any = None, material: Optional[int] = None,
                     visible: Optional[bool] = None, mesh: Optional[int] = None, name: Optional[str] = None) -> None:  # fmt: skip
        """Moves an instance, or changes what else is given: see add_instance(). material -1: the mesh's. The next frame recomputes what
        depends on it alone."""
        with self._lock:
            if all(given is None for given in (color, material, visible, mesh, name)):
                if matrix is not None:
                    self._place(index, self._placement(matrix))
                return
            found = self._instance(index)
            if matrix is not None:
                place = self._placement(matrix).tolist()
                found.world_from_object[:] = place
                found.place_rest[:] = [x - y for x, y in zip(place[12:15], found.world_from_object[12:15])]
            if color is not None:
                found.color = (ctypes.c_float * 4)(*color_of(color, "color", 4, most=math.inf))
            for member, value in (("material", material), ("mesh", mesh)):
                if value is not None:
                    found.put(member, value, member)
            if visible is not None:
                found.visible = truth(visible, "visible")
            self._change("scene_set_instance", index, ctypes.byref(found))
            if name is not None:
                self.set_name("instance", index, name)

    def set_instances(self, matrices: Any, indices: Any = None) -> None:
        """Moves many instances at once by matrices (n, 4, 4). indices: theirs; 0, 1, 2 and so on if they are left out."""
        places = self._placements(matrices)
        which = None if indices is None else np.ascontiguousarray(indices, np.int32)
        if which is not None and which.shape != (len(places),):
            raise UsageError(f"indices: {which.shape}, expected one for each of {len(places)} matrices")
        self._change("scene_place_instances_double", None if which is None else which.ctypes.data, len(places), places.ctypes.data)

    def remove_instance(self, index: int) -> None:
        """Removes an instance; add_instance() may use its index again."""
        self._change("scene_remove_instance", index)

    # ---- names and nodes ------------------------------------------------------------------------------------------------

    def name(self, part: Part, index: int) -> str:
        """Name of a "node", "instance", "mesh", "material" or "camera"; an instance without one has its node's, or else its mesh's."""
        text = ctypes.c_char_p()
        with self._lock:  # the text is the scene's
            self._call("scene_get_name", chosen(part, "PART", "part"), index, ctypes.byref(text))
            if part == "instance" and not text.value:
                return self.name("mesh", self._instance(index).mesh)
            return _c.text_of(text.value)

    def set_name(self, part: Literal["instance", "mesh", "material"], index: int, name: str) -> None:
        """Names an "instance", a "mesh" or a "material"."""
        self._change("scene_set_name", chosen(part, "PART", "part"), index, _c.required(name, "name"))

    @property
    def nodes(self) -> List[Dict[str, Any]]:
        """The file's tree: of each node name, parent (None: a root), instances (indices, which aovs["id"] - 1 has), camera, light."""
        found: List[Dict[str, Any]] = []
        node = _c.make("node", False)
        with self._lock:
            for i in range(self.counts["nodes"]):
                self._call("scene_get_node", i, ctypes.byref(node))
                instances = (ctypes.c_int32 * node.instance_count).from_address(node.instances) if node.instance_count else ()
                places = (("parent", node.parent), ("camera", node.camera), ("light", node.light))
                indices = {key: None if value < 0 else value for key, value in places}
                part: Dict[str, Any] = {"name": _c.text_of(node.name), "instances": list(instances)}
                found.append({**part, **indices})
        return found

    def add_ground(self) -> int:
        """Adds a ground below the scene that is invisible but for the shadows on it, and returns its instance's index."""
        index = ctypes.c_int32()
        self._change("scene_add_ground", ctypes.byref(index))
        return index.value

    def _placement(self, matrix: Any) -> Array:
        """16 float64, column after column."""
        from . import _arrays

        given = np.eye(4) if matrix is None else _arrays.matrix(matrix)
        return given.T.ravel()

    def _placements(self, matrices: Any) -> Array:
        """The same of many matrices: (n, 16)."""
        from . import _arrays

        return np.ascontiguousarray(_arrays.matrices(matrices).transpose(0, 2, 1)).reshape(-1, 16)
