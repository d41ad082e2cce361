"""Materials as halflit has them."""
from __future__ import annotations

from typing import Any, Callable, Dict, NamedTuple, Optional

import numpy as np

from halflit._types import TextureEncoding

from ._shapes import is_surface
from ._values import Array
from .constants import GLTF
from .material import Material, MetallicRoughnessMaterial, SpecularGlossinessMaterial
from .primitive import Primitive
from .texture import Texture

#: Exponent of pyrender's pictures: a code is 255 times light to the power of 1 / 2.2.
GAMMA = 2.2
#: Least roughness of pyrender, and reflectance of its dielectrics.
_LEAST = 0.04
_WRAPS = {GLTF.REPEAT: "repeat", GLTF.MIRRORED_REPEAT: "mirror", GLTF.CLAMP_TO_EDGE: "clamp"}
#: Minifying filter -> within a level, between levels.
_FILTERS = {
    GLTF.NEAREST: ("nearest", "none"),
    GLTF.LINEAR: ("linear", "none"),
    GLTF.NEAREST_MIPMAP_NEAREST: ("nearest", "nearest"),
    GLTF.LINEAR_MIPMAP_NEAREST: ("linear", "nearest"),
    GLTF.NEAREST_MIPMAP_LINEAR: ("nearest", "linear"),
    GLTF.LINEAR_MIPMAP_LINEAR: ("linear", "linear"),
}
#: Gives the index of a texture that is uploaded with these colours.
Uploads = Callable[[Texture, TextureEncoding], int]


class Style(NamedTuple):
    """How a scene is uploaded."""

    kind: str  # "lit", "ambient" (without lights), "flat" (base colours alone) or "depth" (nothing blends)
    wire: str  # edges alone: "own" (of the materials that say so), "flip" (of all others), "all" or "none"
    back: bool  # back faces of all materials are drawn
    normals: int  # flags of the normals that lines show


    @property
    def is_shaded(self) -> bool:
        """Colours are light."""
        return self.kind in ("lit", "ambient")


def light_of(shares: Array) -> Array:
    """Light that appears as these shares of 255: their power of GAMMA, float64. numpy's own power differs in its last bits from processor to
    processor; what is used here is rounded alike by all of them.

    shares: in [0, 1]. The power of 2.2 is the square times the fifth root.
    """
    shares = np.asarray(shares, np.float64)
    x = np.maximum(shares, 1e-12)  # no picture shows what is darker
    root = np.sqrt(np.sqrt(x))
    for _ in range(3):  # the root r is (x^3 r)^(1/16): each time a 16th of the relative error is left
        root = np.sqrt(np.sqrt(np.sqrt(np.sqrt(x * x * x * root))))
    for _ in range(2):  # Newton
        root = (4 * root + x / ((root * root) * (root * root))) / 5
    return np.asarray(shares * shares * root)


def is_wireframe(primitive: Primitive, style: Style) -> bool:
    """Whether the style shows the primitive's edges alone."""
    own = primitive.material.wireframe
    return {"own": own, "flip": not own, "all": True, "none": False}[style.wire]


def is_unlit(primitive: Primitive, style: Style) -> bool:
    """Points and lines without normals have no side that light falls on."""
    return style.kind == "flat" or (primitive.normals is None and not is_surface(primitive))


def blends(primitive: Primitive, style: Style) -> bool:
    """Whether something behind the primitive shows through. from_trimesh() lets all materials blend, most of them with an alpha of 1."""
    return style.kind != "depth" and primitive.material.alphaMode == "BLEND" and primitive.is_transparent


def colors_of(primitive: Primitive, style: Style) -> Optional[Array]:
    """Vertex colours as linear light."""
    colors = primitive.color_0
    if colors is None or style.kind == "depth":
        return None
    colors = np.clip(np.nan_to_num(colors), 0, 1)
    if style.is_shaded and is_unlit(primitive, style):
        colors[:, :3] = light_of(colors[:, :3])  # they appear in the picture as given
    return colors


def look(primitive: Primitive, style: Style, upload: Uploads) -> Dict[str, Any]:
    """The members of a halflit material for a primitive in this style."""
    material = primitive.material
    members: Dict[str, Any] = {"double_sided": material.doubleSided or style.back, "metallic": 0.0, "roughness": 1.0}
    if material.alphaMode == "MASK":
        members.update(alpha_mode="mask", alpha_cutoff=material.alphaCutoff)
    elif blends(primitive, style):
        members["alpha_mode"] = "blend"
    base = np.clip(getattr(material, material._base, np.ones(4)), 0, 1).astype(np.float64)
    if is_unlit(primitive, style):
        members["unlit"] = True
        if style.is_shaded:
            base[:3] = light_of(base[:3])
    elif style.kind == "ambient":  # which the base colour reflects whole, of metals too, without a highlight
        members["emissive"] = material.emissiveFactor.tolist()
    elif style.kind == "lit":
        members.update(_reflection(material), emissive=material.emissiveFactor.tolist())
        if isinstance(material, MetallicRoughnessMaterial):
            base[:3] *= 1 - _LEAST * (1 - material.metallicFactor)  # what pyrender takes from diffuse light beside Fresnel's share
    members["base_color"] = base.tolist()
    for member, texture, color in _pictures(material, style):
        if texture is not None and texture.source is not None and primitive.texcoord_0 is not None:
            members[member] = {"texture": upload(texture, color), **_use(texture)}
            if member == "emissive_texture" and not any(members.get("emissive", ())):
                del members[member]
    return members


def _reflection(material: Material) -> Dict[str, Any]:
    if isinstance(material, MetallicRoughnessMaterial):
        return {"metallic": material.metallicFactor, "roughness": max(material.roughnessFactor, _LEAST)}
    if isinstance(material, SpecularGlossinessMaterial):
        most = float(np.clip(material.specularFactor.max(), 0, 1))
        share = np.clip(material.specularFactor, 0, 1) / (most or 1.0)
        rough = max(1 - material.glossinessFactor, _LEAST)
        return {"metallic": 0.0, "roughness": rough, "dielectric_reflectance": most, "specular_color": share.tolist()}
    return {}


def _pictures(material: Material, style: Style) -> Any:
    """Member of a halflit material, texture, and its colours."""
    base = getattr(material, material._base_texture, None)
    if style.is_shaded:
        yield "base_color_texture", base, "srgb_by_alpha" if material.alphaMode != "OPAQUE" and material.is_transparent else "srgb"
        yield "normal_texture", material.normalTexture, "normal"
        yield "occlusion_texture", material.occlusionTexture, "linear"
        yield "emissive_texture", material.emissiveTexture, "srgb"
        if isinstance(material, MetallicRoughnessMaterial) and style.kind == "lit":
            yield "metallic_roughness_texture", material.metallicRoughnessTexture, "linear"
    elif style.kind == "flat" or material.alphaMode == "MASK":
        yield "base_color_texture", base, "linear"


def _use(texture: Texture) -> Dict[str, str]:
    """The members of a TextureUse for a sampler. Without filters a texel is shown as it is, as in pyrender."""
    sampler = texture.sampler
    least, between = _FILTERS.get(sampler.minFilter or GLTF.NEAREST, ("linear", "linear"))
    return {
        "wrap_u": _WRAPS.get(sampler.wrapS, "repeat"),
        "wrap_v": _WRAPS.get(sampler.wrapT, "repeat"),
        "mag_filter": "linear" if sampler.magFilter == GLTF.LINEAR else "nearest",
        "min_filter": least,
        "mip_filter": between,
    }


def texels_of(texture: Texture) -> Array:
    """uint8 for halflit: the two channels of metallic and roughness are blue and green there."""
    source = texture.source
    assert source is not None
    if source.shape[2] != 2:
        return source
    filled = np.zeros(source.shape[:2] + (3,), np.uint8)
    filled[:, :, 1:] = source
    return filled
