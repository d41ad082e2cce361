"""Numbers that pyrender names: flags, modes and filters, with its values."""
from __future__ import annotations

DEFAULT_Z_NEAR = 0.05  # world units
DEFAULT_Z_FAR = 100.0  # world units
DEFAULT_SCENE_SCALE = 2.0
MAX_N_LIGHTS = 4  # of each type in pyrender; here all lights shine
SHADOW_TEX_SZ = 2048  # texels on a side


class RenderFlags:
    """Flags of OffscreenRenderer.render(), combined by |."""

    NONE = 0
    DEPTH_ONLY = 1  # the depth alone is returned
    OFFSCREEN = 2  # always the case here
    FLIP_WIREFRAME = 4
    ALL_WIREFRAME = 8
    ALL_SOLID = 16
    SHADOWS_DIRECTIONAL = 32
    SHADOWS_POINT = 64
    SHADOWS_SPOT = 128
    SHADOWS_ALL = 32 | 64 | 128
    VERTEX_NORMALS = 256  # blue lines
    FACE_NORMALS = 512
    SKIP_CULL_FACES = 1024  # back faces are drawn
    RGBA = 2048  # four channels
    FLAT = 4096  # base colours without light
    SEG = 8192  # the colours of seg_node_map
    DISABLE_ANTI_ALIASING = 16384


class TextAlign:
    """Where a caption of the Viewer, which is not here, has its origin."""

    CENTER = 0
    CENTER_LEFT = 1
    CENTER_RIGHT = 2
    BOTTOM_LEFT = 3
    BOTTOM_RIGHT = 4
    BOTTOM_CENTER = 5
    TOP_LEFT = 6
    TOP_RIGHT = 7
    TOP_CENTER = 8


class GLTF:
    """Filters, wraps and modes by the numbers of glTF."""

    NEAREST = 9728
    LINEAR = 9729
    NEAREST_MIPMAP_NEAREST = 9984
    LINEAR_MIPMAP_NEAREST = 9985
    NEAREST_MIPMAP_LINEAR = 9986
    LINEAR_MIPMAP_LINEAR = 9987
    CLAMP_TO_EDGE = 33071
    MIRRORED_REPEAT = 33648
    REPEAT = 10497
    POINTS = 0
    LINES = 1
    LINE_LOOP = 2
    LINE_STRIP = 3
    TRIANGLES = 4
    TRIANGLE_STRIP = 5
    TRIANGLE_FAN = 6


__all__ = ["RenderFlags", "TextAlign", "GLTF"]
