"""Meshes of the library trimesh, which need not be installed: only what the objects offer is used. This module imports numpy."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Optional, Tuple

import numpy as np

from ._color import linear_from_codes
from ._errors import UsageError
from ._material import Material

if TYPE_CHECKING:
    from ._scene import Scene
from ._types import Array

#: Diffuse colour of a SimpleMaterial that was given none: trimesh's DEFAULT_COLOR. It would darken a texture.
_NO_DIFFUSE = [102, 102, 102, 255]


def is_trimesh(value: Any) -> bool:
    """A Trimesh, PointCloud or Scene of trimesh."""
    return any(kind.__module__.partition(".")[0] == "trimesh" for kind in type(value).__mro__)


def add(scene: Scene, value: Any) -> None:
    """Adds all that the object has to the scene."""
    if hasattr(value, "geometry") and hasattr(value, "graph"):
        meshes: Dict[Any, Any] = {}
        for node in value.graph.nodes_geometry:
            matrix, name = value.graph[node]
            if name not in meshes:
                meshes[name] = add_geometry(scene, value.geometry[name], name)
            if meshes[name] is not None:
                scene.add_instance(meshes[name], matrix)
        return
    mesh = add_geometry(scene, value, None)
    if mesh is None:
        raise UsageError(f"mesh: expected a Trimesh, PointCloud or Scene of trimesh, found {type(value).__name__}")
    scene.add_instance(mesh)


def add_geometry(scene: Scene, mesh: Any, name: Any) -> Optional[int]:
    """The index of the mesh; None for what has no triangles and no points."""
    if not hasattr(mesh, "faces"):
        if not hasattr(mesh, "vertices") or hasattr(mesh, "entities"):
            return None
        colors = getattr(mesh, "colors", None)
        colors = colors if colors is not None and len(colors) == len(mesh.vertices) else None
        return scene.add_mesh(mesh.vertices, topology="points", colors=colors, material={"unlit": True}, name=name, place=False)
    mesh, has_normals = shaded(mesh)
    visual, uv, colors = mesh.visual, getattr(mesh.visual, "uv", None), None
    vertices, faces, normals = mesh.vertices, mesh.faces, mesh.vertex_normals if has_normals else None
    kind = getattr(visual, "kind", None)
    if uv is not None:
        uv = np.asarray(uv, dtype=np.float32) * (1, -1) + (0, 1)  # v points up in trimesh
    elif kind == "vertex":
        colors = np.asarray(visual.vertex_colors, dtype=np.uint8)
    elif kind == "face":
        # Each face has its own colour: corners are split.
        corners = np.asarray(faces).ravel()
        vertices, normals = np.asarray(vertices)[corners], None if normals is None else np.asarray(normals)[corners]
        colors = np.repeat(np.asarray(visual.face_colors, dtype=np.uint8), 3, axis=0)
        faces = None
    members = material_of(scene, getattr(visual, "material", None))
    material = None if members is None else Material(**members)
    return scene.add_mesh(vertices, faces, normals=normals, uv=uv, colors=colors, material=material, name=name, place=False)


def shaded(mesh: Any) -> Tuple[Any, ...]:
    """The mesh, and whether its vertex_normals are to be used.

    Those that came with it are in its cache, which is how trimesh's exporters know them. Of another mesh trimesh would make means over all
    faces of a vertex, as of a ball; its smooth_shaded has the vertices split at edges. Without scipy, which that needs, faces are flat.
    """
    if "vertex_normals" in getattr(mesh, "_cache", ()):
        return mesh, True
    try:
        return mesh.smooth_shaded, True
    except (AttributeError, ImportError):
        return mesh, False


def material_of(scene: Scene, material: Any) -> Optional[Dict[str, Any]]:
    """The members of a halflit material for a PBRMaterial or SimpleMaterial of trimesh; None: that of a mesh without one."""
    if material is None:
        return None
    members: Dict[str, Any] = {}
    if hasattr(material, "baseColorFactor"):
        # What glTF begins with. trimesh keeps baseColorFactor, which is linear, in 255ths.
        members.update(metallic=1.0, roughness=1.0, double_sided=bool(getattr(material, "doubleSided", False)))
        if getattr(material, "baseColorFactor", None) is not None:
            members["base_color"] = shares(material.baseColorFactor).tolist()
        named = (("emissive", "emissiveFactor"), ("metallic", "metallicFactor"), ("roughness", "roughnessFactor"))
        for member, name in (*named, ("alpha_cutoff", "alphaCutoff")):
            if getattr(material, name, None) is not None:
                members[member] = getattr(material, name)
        if getattr(material, "alphaMode", None):
            members["alpha_mode"] = material.alphaMode.lower()
        pictures: Tuple[Any, ...] = (
            ("base_color_texture", "baseColorTexture", "srgb"),
            ("metallic_roughness_texture", "metallicRoughnessTexture", "linear"),
            ("normal_texture", "normalTexture", "normal"),
            ("occlusion_texture", "occlusionTexture", "linear"),
            ("emissive_texture", "emissiveTexture", "srgb"),
        )
    else:
        members.update(roughness=0.6, double_sided=True)
        diffuse = getattr(material, "diffuse", None)
        if diffuse is not None and not (getattr(material, "image", None) is not None and list(diffuse) == _NO_DIFFUSE):
            codes = np.asarray(diffuse)
            members["base_color"] = (linear_from_codes(codes) if codes.dtype.kind in "iu" else codes).tolist()
        pictures = (("base_color_texture", "image", "srgb"),)
    for member, name, color in pictures:
        picture = getattr(material, name, None)
        if picture is not None:
            members[member] = scene.add_texture(picture, color)
    return members


def shares(color: Any) -> Array:
    """Bytes as shares of 255; floats stay."""
    array = np.asarray(color)
    return array / 255.0 if array.dtype.kind in "iu" else array
