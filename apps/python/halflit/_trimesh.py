"""Meshes of the library trimesh, which need not be installed: only what the objects offer is used."""
from __future__ import annotations

import numpy as np

from ._color import linear_from_srgb
from ._errors import UsageError


def is_trimesh(value) -> bool:
    """A Trimesh, PointCloud or Scene of trimesh."""
    return any(kind.__module__.partition(".")[0] == "trimesh" for kind in type(value).__mro__)


def add(scene, value) -> None:
    """Adds all that the object has to the scene."""
    if hasattr(value, "geometry") and hasattr(value, "graph"):
        meshes: dict = {}
        for node in value.graph.nodes_geometry:
            matrix, name = value.graph[node]
            if name not in meshes:
                meshes[name] = add_geometry(scene, value.geometry[name], name)
            if meshes[name] is not None:
                scene.add_instance(meshes[name], matrix)
        return
    mesh = add_geometry(scene, value, None)
    if mesh is None:
        raise UsageError(f"expected a Trimesh, PointCloud or Scene of trimesh, found {type(value).__name__}")
    scene.add_instance(mesh)


def add_geometry(scene, mesh, name):
    """The index of the mesh; None for what has no triangles and no points."""
    visual = getattr(mesh, "visual", None)
    if not hasattr(mesh, "faces"):
        if not hasattr(mesh, "vertices") or hasattr(mesh, "entities"):
            return None
        colors = getattr(mesh, "colors", None)
        colors = colors if colors is not None and len(colors) == len(mesh.vertices) else None
        return scene.add_mesh(mesh.vertices, topology="points", colors=colors, material={"unlit": True}, name=name, place=False)
    uv, colors = getattr(visual, "uv", None), None
    vertices, faces, normals = mesh.vertices, mesh.faces, mesh.vertex_normals
    if uv is not None:
        uv = np.asarray(uv, dtype=np.float32) * (1, -1) + (0, 1)  # v points up in trimesh
    elif getattr(visual, "kind", None) == "vertex":
        colors = np.asarray(visual.vertex_colors, dtype=np.uint8)
    elif getattr(visual, "kind", None) == "face":
        # Each face has its own colour: corners are split.
        corners = np.asarray(faces).ravel()
        vertices, normals = np.asarray(vertices)[corners], np.asarray(normals)[corners]
        colors = np.repeat(np.asarray(visual.face_colors, dtype=np.uint8), 3, axis=0)
        faces = None
    material = material_of(scene, getattr(visual, "material", None) if uv is not None else None)
    return scene.add_mesh(vertices, faces, normals=normals, uv=uv, colors=colors, material=material, name=name, place=False)


def material_of(scene, material) -> dict:
    """The members of a halflit material for one of trimesh: PBRMaterial or SimpleMaterial."""
    members: dict = {"metallic": 0.0, "roughness": 0.8}
    if material is None:
        return members
    if hasattr(material, "baseColorFactor"):
        members.update(metallic=1.0, roughness=1.0)
        factors = (("base_color", "baseColorFactor"), ("emissive", "emissiveFactor"), ("metallic", "metallicFactor"))
        for member, name in (*factors, ("roughness", "roughnessFactor"), ("alpha_cutoff", "alphaCutoff")):
            factor = getattr(material, name, None)
            if factor is not None:
                members[member] = linear(factor) if member == "base_color" else factor
        members["double_sided"] = bool(getattr(material, "doubleSided", False))
        if getattr(material, "alphaMode", None):
            members["alpha_mode"] = material.alphaMode.lower()
        pictures: tuple = (
            ("base_color_texture", "baseColorTexture", "srgb"),
            ("metallic_roughness_texture", "metallicRoughnessTexture", "linear"),
            ("normal_texture", "normalTexture", "normal"),
            ("occlusion_texture", "occlusionTexture", "linear"),
            ("emissive_texture", "emissiveTexture", "srgb"),
        )
    else:
        if getattr(material, "diffuse", None) is not None:
            members["base_color"] = linear(material.diffuse)
        pictures = (("base_color_texture", "image", "srgb"),)
    for member, name, color in pictures:
        picture = getattr(material, name, None)
        if picture is not None:
            members[member] = scene.add_texture(picture, color)
    return members


def linear(color) -> list:
    """A colour of trimesh: bytes are sRGB codes with linear alpha, floats are linear."""
    array = np.asarray(color)
    if array.dtype.kind not in "iu":
        return array.tolist()
    return [*linear_from_srgb(array[:3] / 255.0).tolist(), *(array[3:] / 255.0).tolist()]
