"""Meshes of the library trimesh, which need not be installed: only what the objects offer is used. This module imports numpy."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

import numpy as np

from ._color import linear_from_codes
from ._errors import UsageError
from ._material import Material

if TYPE_CHECKING:
    from ._scene import Scene
from ._types import Array, Up

#: Formats whose z points up by custom, as trimesh names them.
_Z_UP = frozenset(("stl", "stl_ascii", "3mf"))
#: Diffuse colour of a SimpleMaterial that was given none: trimesh's DEFAULT_COLOR. It would darken a texture.
_NO_DIFFUSE = [102, 102, 102, 255]


def is_trimesh(value: Any) -> bool:
    """A Trimesh, PointCloud or Scene of trimesh."""
    return any(kind.__module__.partition(".")[0] == "trimesh" for kind in type(value).__mro__)


def up_of(value: Any) -> Optional[Up]:
    """The axis that points up by the file that trimesh has read the object from; None: by none."""
    parts = list(value.geometry.values()) if hasattr(value, "geometry") else [value]
    return "z" if parts and all(_file_type(part) in _Z_UP for part in parts) else None


def _file_type(value: Any) -> str:
    """As trimesh names it, such as "stl" or "stl_ascii"; "" for what was made by code."""
    kind = getattr(getattr(value, "source", None), "file_type", None)
    if not kind:  # trimesh before version 4.5
        metadata = getattr(value, "metadata", None)
        kind = os.path.splitext(str(metadata.get("file_name") or ""))[1][1:] if isinstance(metadata, dict) else ""
    return str(kind).lower()


def add(scene: Scene, value: Any, smooth: bool = True) -> None:
    """Adds all that the object has to the scene. smooth: False: triangles are flat."""
    if hasattr(value, "geometry") and hasattr(value, "graph"):
        meshes: Dict[Any, Any] = {}
        for node in value.graph.nodes_geometry:
            matrix, name = value.graph[node]
            if name not in meshes:
                meshes[name] = add_geometry(scene, value.geometry[name], name, smooth)
            if meshes[name] is not None:
                scene.add_instance(meshes[name], matrix)
        return
    mesh = add_geometry(scene, value, None, smooth)
    if mesh is None:
        raise UsageError(f"mesh: expected a Trimesh, PointCloud, Path or Scene of trimesh, found {type(value).__name__}")
    scene.add_instance(mesh)


def add_geometry(scene: Scene, mesh: Any, name: Any, smooth: bool) -> Optional[int]:
    """The index of the mesh; None for what has no triangles, lines or points."""
    if not hasattr(mesh, "faces"):
        if hasattr(mesh, "entities"):
            return add_path(scene, mesh, name)
        if not hasattr(mesh, "vertices"):
            return None
        colors = getattr(mesh, "colors", None)
        colors = colors if colors is not None and len(colors) == len(mesh.vertices) else None
        return scene.add_mesh(mesh.vertices, topology="points", colors=colors, material={"unlit": True}, name=name, place=False)
    kind, uv, colors = getattr(mesh.visual, "kind", None), getattr(mesh.visual, "uv", None), None
    members = material_of(scene, getattr(mesh.visual, "material", None))  # which smooth_shaded does not keep without uv
    if kind == "face" and uv is None:
        # Each face has its own colour: corners are split.
        vertices, faces, normals = corners_of(mesh).reshape(-1, 3), None, corner_normals(mesh) if smooth else None
        colors = np.repeat(np.asarray(mesh.visual.face_colors, dtype=np.uint8), 3, axis=0)
    else:
        mesh, has_normals = shaded(mesh) if smooth else (mesh, False)
        vertices, faces, normals = mesh.vertices, mesh.faces, mesh.vertex_normals if has_normals else None
        uv = getattr(mesh.visual, "uv", None)
        if uv is not None:
            uv = np.asarray(uv, dtype=np.float32) * (1, -1) + (0, 1)  # v points up in trimesh
        elif kind == "vertex":
            colors = np.asarray(mesh.visual.vertex_colors, dtype=np.uint8)
    material = None if members is None else Material(**members)
    return scene.add_mesh(vertices, faces, normals=normals, uv=uv, colors=colors, material=material, name=name, place=False)


def add_path(scene: Scene, path: Any, name: Any) -> Optional[int]:
    """The lines of a Path2D or Path3D, in the colours of its entities, black without them."""
    points: List[Array] = []
    pairs: List[Array] = []
    colors: List[Array] = []
    count = 0
    for entity in path.entities:
        line = np.asarray(entity.discrete(path.vertices), np.float64)
        if len(line) < 2:
            continue
        points.append(np.pad(line, ((0, 0), (0, 3 - line.shape[1]))))
        pairs.append(np.stack([np.arange(count, count + len(line) - 1), np.arange(count + 1, count + len(line))], axis=1))
        color = np.asarray(getattr(entity, "color", None) if getattr(entity, "color", None) is not None else (0, 0, 0, 255))
        codes = np.rint(color * 255.0 if color.dtype.kind == "f" else color).astype(np.uint8)
        colors.append(np.tile(np.append(codes, np.uint8(255))[:4], (len(line), 1)))
        count += len(line)
    if not points:
        return None
    return scene.add_mesh(np.concatenate(points), np.concatenate(pairs), colors=np.concatenate(colors), topology="lines",
                          material={"unlit": True}, name=name, place=False)  # fmt: skip


def corners_of(mesh: Any) -> Array:
    """Positions, (faces, 3, 3)."""
    return np.asarray(np.asarray(mesh.vertices)[np.asarray(mesh.faces)])


def corner_normals(mesh: Any) -> Optional[Array]:
    """Normals of the corners of all faces, in their order, as shaded() has them; None: faces are flat."""
    smooth, has_normals = shaded(mesh)
    if not has_normals:
        return None
    normals = np.asarray(smooth.vertex_normals)[np.asarray(smooth.faces)]
    if smooth is not mesh:  # its faces are in another order
        parts = getattr(smooth, "metadata", {}).get("original_components", [np.arange(len(mesh.faces))])
        order = np.concatenate([np.ravel(part) for part in parts])
        if len(order) != len(normals) or not np.allclose(corners_of(smooth), corners_of(mesh)[order]):
            return None
        normals[order] = normals.copy()
    found: Array = normals.reshape(-1, 3)
    return found


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
        # Defaults of glTF. trimesh keeps baseColorFactor, which is linear, in 255ths.
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
