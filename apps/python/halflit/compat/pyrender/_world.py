"""A scene of pyrender's kind as a halflit scene, of which the next picture uploads what has changed alone."""
from __future__ import annotations

import math
from typing import Any, Dict, List, Optional, Sequence, Set, Tuple

import numpy as np

from halflit._material import Material
from halflit._scene import Scene
from halflit._types import LightType, TextureEncoding

from . import _shapes
from ._looks import GAMMA, Style, blends, colors_of, is_wireframe, look, texels_of
from ._values import Array
from .light import PointLight, SpotLight
from .node import Node
from .primitive import Primitive
from .texture import Texture

#: A primitive, and whether it is its surface or the lines of its normals that are uploaded.
Part = Tuple[Primitive, bool]
#: Colour of the lines that show normals.
_BLUE = [0.1**GAMMA, 0.1**GAMMA, 1.0]


class World:
    """The halflit scene of one style, and what it was made of."""

    def __init__(self, style: Style) -> None:
        self.style = style
        self.scene = Scene()
        self.setup: Any = None  # see _pass.py
        self.setup_key: Any = None
        self.settings: Dict[Any, Any] = {}  # of the setup's light, by options
        self.pixels: Optional[Array] = None
        self.instance_nodes: List[Tuple[Node, int]] = []  # what is drawn, and its instance
        self.has_blends = False  # something is seen through
        self._key: Any = None
        self._meshes: Dict[Part, Tuple[int, int]] = {}  # mesh, material
        self._made: Dict[Part, Any] = {}  # the key by which a part was uploaded
        self._placed: Dict[Tuple[Node, Part], List[int]] = {}  # instances
        self._textures: Dict[Tuple[Texture, str], Tuple[int, Any]] = {}  # index, and the key by which it was uploaded
        self._free: List[int] = []  # materials that no mesh has
        self._rows: Array = np.zeros(0, np.int64)  # of each instance, that of its node
        self._indices: Array = np.zeros(0, np.int32)
        self._own: List[Tuple[slice, Array]] = []  # instances of a primitive that has poses
        self._matrices: Array = np.zeros((0, 4, 4))
        self._lights: Any = None

    # ---- meshes and places ----------------------------------------------------------------------------------------------

    def update(self, nodes: Sequence[Node], poses: Array, rows: Dict[Node, int], structure: int) -> None:
        """Draws these nodes from now on, each by its row of the poses. structure: counts changes of the rows."""
        key: List[Any] = [structure]
        for node in nodes:
            mesh = node.mesh
            assert mesh is not None
            for primitive in mesh.primitives:
                key.append((node, primitive, _key_of(primitive), primitive._moves))
        if key != self._key:
            self._upload(key[1:], rows)
            self._key = key
        self._place(poses)

    def _upload(self, wanted: List[Tuple[Node, Primitive, Any, int]], rows: Dict[Node, int]) -> None:
        keys: Dict[Part, Any] = {}
        places: Dict[Tuple[Node, Part], int] = {}
        for node, primitive, key, _ in wanted:
            for is_normals in (False, True) if self.style.normals else (False,):
                keys[primitive, is_normals] = key
                places[node, (primitive, is_normals)] = 1 if primitive.poses is None else len(primitive.poses)
        for place in [place for place, instances in self._placed.items() if places.get(place) != len(instances)]:
            for index in self._placed.pop(place):
                self.scene.remove_instance(index)
        for part in [part for part in self._meshes if part not in keys]:
            mesh, material = self._meshes.pop(part)
            del self._made[part]
            self.scene.remove_mesh(mesh)
            self.scene.set_material(material, Material())  # its textures are free
            self._free.append(material)
        for part, key in keys.items():
            if self._made.get(part) != key:
                self._add(part)
                self._made[part] = key
        self._drop_textures(keys)
        for (node, part), count in places.items():
            if (node, part) not in self._placed:
                mesh = self._meshes[part][0]
                self._placed[node, part] = [self.scene.add_instance(mesh) for _ in range(count)]  # one by one, which takes free indices
        self.has_blends = any(blends(primitive, self.style) for primitive, _ in self._meshes)
        self._order(rows)

    def _add(self, part: Part) -> None:
        """Uploads a part, in the place of its older self if there is one."""
        primitive, is_normals = part
        if is_normals:
            shape = _shapes.normals(primitive, self.style.normals)
            members: Dict[str, Any] = {"unlit": True, "base_color": _BLUE}
        else:
            shape = _shapes.body(primitive, is_wireframe(primitive, self.style), colors_of(primitive, self.style))
            members = look(primitive, self.style, self._texture)
        old = self._meshes.get(part)
        if old is not None:
            mesh, material = old
            self.scene.set_material(material, Material(**members))
            self.scene.set_mesh(mesh, material=material, **shape)
            return
        if self._free:
            material = self._free.pop()
            self.scene.set_material(material, Material(**members))
        else:
            material = self.scene.add_material(**members)
        self._meshes[part] = self.scene.add_mesh(material=material, place=False, **shape), material

    def _texture(self, texture: Texture, color: TextureEncoding) -> int:
        key = (texture._version, color)
        found = self._textures.get((texture, color))
        if found is not None and found[1] == key:
            return found[0]
        if found is not None:
            self.scene.set_texture(found[0], texels_of(texture), color)
            index = found[0]
        else:
            index = self.scene.add_texture(texels_of(texture), color)
        self._textures[texture, color] = index, key
        return index

    def _drop_textures(self, parts: Dict[Part, Any]) -> None:
        used: Set[Texture] = set()
        for primitive, _ in parts:
            used |= primitive.material.textures
        for key in [key for key in self._textures if key[0] not in used]:
            self.scene.remove_texture(self._textures.pop(key)[0])

    def _order(self, rows: Dict[Node, int]) -> None:
        """Where the instances take their matrices from."""
        at: List[int] = []
        indices: List[int] = []
        self._own, self.instance_nodes = [], []
        for (node, (primitive, _)), instances in self._placed.items():
            if primitive.poses is not None:
                self._own.append((slice(len(at), len(at) + len(instances)), primitive.poses))
            at += [rows[node]] * len(instances)
            indices += instances
            self.instance_nodes += [(node, index) for index in instances]
        self._rows, self._indices = np.array(at, np.int64), np.array(indices, np.int32)
        self._matrices = np.full((len(at), 4, 4), np.nan)  # all are placed anew

    def _place(self, poses: Array) -> None:
        matrices = poses[self._rows]
        for which, own in self._own:
            matrices[which] = matrices[which] @ own
        moved = np.flatnonzero((matrices != self._matrices).any(axis=(1, 2)))
        if not len(moved):
            return
        # Scene.set_instances() without its checks, which take longer than the call: Node has looked at the matrices.
        places = np.ascontiguousarray(matrices[moved].transpose(0, 2, 1))
        indices = self._indices[moved]
        change: Any = self.scene._change
        change("scene_place_instances_double", indices.ctypes.data, len(places), places.ctypes.data)
        self._matrices = matrices

    # ---- light ----------------------------------------------------------------------------------------------------------

    def light(self, nodes: Sequence[Node], poses: Array, rows: Dict[Node, int]) -> None:
        """Lights the scene by these nodes."""
        key = [(node.light, node.light._version, poses[rows[node]].tobytes()) for node in nodes if node.light is not None]
        if key == self._lights:
            return
        self._lights, self.setup_key = key, None
        self.scene.clear_lights()
        for node in nodes:
            light, pose = node.light, poses[rows[node]]
            assert light is not None
            # A white surface that faces the light reflects 1 / pi of what falls on it, as in pyrender; halflit's colours have that factor.
            members: Dict[str, Any] = {"color": np.maximum(light.color * light.intensity / math.pi, 0).tolist()}
            if isinstance(light, (PointLight, SpotLight)):
                members["position"] = pose[:3, 3].tolist()
            if not isinstance(light, PointLight):
                members["direction"] = (-pose[:3, 2]).tolist()
            if isinstance(light, SpotLight):
                members.update(inner_cone_rad=light.innerConeAngle, outer_cone_rad=light.outerConeAngle)
            kind: LightType = "point" if isinstance(light, PointLight) else "spot" if isinstance(light, SpotLight) else "directional"
            self.scene.add_light(kind, **members)


def _key_of(primitive: Primitive) -> Any:
    """Equal keys: nothing has to be uploaded again. Materials are compared by their values, which scripts change in place."""
    material = primitive.material
    textures = [getattr(material, name) for name in material._textures]
    return (
        primitive._version,
        material,
        material._version,
        [value.tobytes() for value in vars(material).values() if isinstance(value, np.ndarray)],
        [(texture._version, texture.sampler._version) for texture in textures if texture is not None],
    )
