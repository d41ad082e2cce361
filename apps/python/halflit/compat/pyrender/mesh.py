"""Meshes."""
from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from ._values import Array, Boxed, Checked, text
from .constants import GLTF
from .material import Material, MetallicRoughnessMaterial
from .primitive import Primitive


class Mesh(Checked, Boxed):
    """Primitives that a node places together. is_visible: False: it is not drawn. weights is kept and not used."""

    _checks = {"name": text}
    name: Optional[str]
    primitives: List[Primitive]
    is_visible: bool

    def __init__(self, primitives: List[Primitive], name: Optional[str] = None, weights: Any = None, is_visible: bool = True) -> None:
        self.primitives, self.name, self.weights, self.is_visible = primitives, name, weights, is_visible

    @property
    def bounds(self) -> Array:
        """Box, (2, 3), of the primitives."""
        boxes = np.array([primitive.bounds for primitive in self.primitives])
        return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    @property
    def is_transparent(self) -> bool:
        """Whether a primitive is."""
        return any(primitive.is_transparent for primitive in self.primitives)

    @staticmethod
    def from_points(points: Any, colors: Any = None, normals: Any = None, is_visible: bool = True, poses: Any = None) -> Mesh:
        """A mesh of points (n, 3), with colours (n, 3) or (n, 4) and normals (n, 3)."""
        points_of = Primitive(positions=points, normals=normals, color_0=colors, mode=GLTF.POINTS, poses=poses)
        return Mesh(primitives=[points_of], is_visible=is_visible)

    @staticmethod
    def from_trimesh(
        mesh: Any,
        material: Optional[Material] = None,
        is_visible: bool = True,
        poses: Any = None,
        wireframe: bool = False,
        smooth: bool = True,
    ) -> Mesh:
        """A mesh of a trimesh.Trimesh, or of several in a list.

        material: in place of the mesh's own. poses: (n, 4, 4), where it is drawn; None: once. smooth: by vertex_normals; else faces are
        flat.
        """
        meshes = list(mesh) if isinstance(mesh, (list, tuple, set, np.ndarray)) else [mesh]
        made = [_primitive(one, material, poses, wireframe, smooth) for one in meshes]
        return Mesh(primitives=made, is_visible=is_visible)


def _primitive(mesh: Any, material: Optional[Material], poses: Any, wireframe: bool, smooth: bool) -> Primitive:
    if not hasattr(mesh, "vertices") or not hasattr(mesh, "faces"):
        raise TypeError(f"mesh: expected a Trimesh or a list of them, found {type(mesh).__name__}")
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    colors, uv, own = _look(mesh, faces, smooth)
    used = material or own
    if used is None:
        used = MetallicRoughnessMaterial(alphaMode="BLEND", baseColorFactor=(0.3, 0.3, 0.3, 1.0), metallicFactor=0.2, roughnessFactor=0.8)
    used.wireframe = wireframe
    arrays: Dict[str, Any] = {"positions": vertices, "normals": np.asarray(mesh.vertex_normals) if smooth else None, "indices": faces}
    if not smooth:
        arrays = {"positions": vertices[faces].reshape(-1, 3), "normals": np.repeat(_face_normals(mesh, vertices, faces), 3, axis=0)}
    return Primitive(color_0=colors, texcoord_0=uv, material=used, mode=GLTF.TRIANGLES, poses=poses, **arrays)


def _face_normals(mesh: Any, vertices: Array, faces: Array) -> Array:
    """Those of trimesh, if there is one for each face: it leaves out faces without area."""
    given = getattr(mesh, "face_normals", None)
    if given is not None and len(given) == len(faces):
        return np.asarray(given)
    made = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    length = np.linalg.norm(made, axis=1, keepdims=True)
    return np.asarray(made / np.where(length > 0, length, 1))


def _look(mesh: Any, faces: Array, smooth: bool) -> Tuple[Optional[Array], Optional[Array], Optional[Material]]:
    """Colours, texture coordinates and material of a mesh's visual."""
    visual = getattr(mesh, "visual", None)
    if visual is None or not getattr(visual, "defined", True):
        return None, None, None
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        colors = np.asarray(visual.vertex_colors)
        return (colors if smooth else colors[faces].reshape(-1, colors.shape[1])), None, None
    if kind == "face":
        if smooth:
            raise ValueError("smooth: expected False for a mesh with colours of faces")
        return np.repeat(np.asarray(visual.face_colors), 3, axis=0), None, None
    if kind != "texture":
        return None, None, None
    uv = None if getattr(visual, "uv", None) is None else np.asarray(visual.uv)
    if uv is not None and not smooth:
        uv = uv[faces].reshape(-1, uv.shape[1])
    return None, uv, _material(visual.material)


def _material(given: Any) -> Optional[Material]:
    """The material of a PBRMaterial or a SimpleMaterial of trimesh."""
    if hasattr(given, "baseColorFactor"):
        names = "normalTexture occlusionTexture emissiveTexture emissiveFactor baseColorFactor baseColorTexture metallicFactor"
        names += " roughnessFactor metallicRoughnessTexture alphaCutoff"
        members: Dict[str, Any] = {name: getattr(given, name, None) for name in names.split()}
        return MetallicRoughnessMaterial(alphaMode="BLEND", doubleSided=bool(getattr(given, "doubleSided", False)), **members)
    if hasattr(given, "image"):
        return MetallicRoughnessMaterial(alphaMode="BLEND", baseColorTexture=given.image)
    return None
