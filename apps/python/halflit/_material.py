"""Materials, their lobes and their uses of textures."""
from __future__ import annotations

import ctypes
import math
from typing import Any, Dict, Optional, Tuple, Union, cast

from . import _c
from ._lazy import np  # noqa: F401  (in annotations)
from ._members import LobeMembers, MaterialMembers, TextureUseKeywords, TextureUseMembers
from ._record import Record
from ._types import AlphaMode, Color, Filter, LobeName, MipFilter, Unpack, Wrap
from ._values import whole


class Lobe(Record):
    """Diffuse light as a function of x, the cosine between normal and light: max(0, (x + wrap) / (1 + wrap)) ** power.

    Wherever a lobe is expected, a name does too: "lambert", "green", "half-lambert", "valve", "sloan" or "mcauley", or a name and a
    wrap, as in ("sloan", 0.6).

    Members:
        wrap: 0 (Lambert) to 1
        power: 0 to 10000
        normalize: scale such that a surface receives as much light as by Lambert
    """

    _kind, _truths, _ranges = "lobe", frozenset({"normalize"}), {"wrap": (0.0, 1.0), "power": (0.0, 10000.0)}
    wrap: float
    power: float
    normalize: bool

    def __init__(self, wrap: float = 0.0, power: float = 1.0, normalize: bool = False) -> None:
        self._begin(_c.STRUCT["halflit_lobe"]())
        self.wrap, self.power, self.normalize = wrap, power, normalize

    @classmethod
    def named(cls, name: LobeName, wrap: float = 0.5) -> Lobe:
        """A lobe of the literature. wrap: 0 to 1, for those that take one."""
        lobe = cls()
        _c.call("lobe_by_name", _c.required(name, "lobe"), wrap, ctypes.byref(lobe._c))
        return lobe

    @classmethod
    def _from(cls, value: Any, name: str = "lobe", **members: Any) -> Any:
        if isinstance(value, str):
            value = cls.named(cast(Any, value))
        elif isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[0], str):
            value = cls.named(*value)
        return super()._from(value, name, **members)


class TextureUse(Record):
    """A material's use of a texture. Wherever one is expected, the texture's index does too.

    Members:
        texture: index; -1: none (-1)
        uv_set: 0 or 1 (0)
        wrap_u: beyond 0 and 1: "repeat", "mirror" or "clamp" to the edge (repeat)
        wrap_v: likewise (repeat)
        mag_filter: "nearest" or "linear" (linear)
        min_filter: likewise (linear)
        mip_filter: "none", "nearest" or "linear" (linear)
        row_u: u' = row_u[0] u + row_u[1] v + row_u[2] (1, 0, 0)
        row_v: likewise v' (0, 1, 0)
    """

    _kind, _ranges = "texture_use", {"texture": (-1, math.inf), "uv_set": (0, 1)}
    _choices = {"wrap_u": "WRAP", "wrap_v": "WRAP", "mag_filter": "FILTER", "min_filter": "FILTER", "mip_filter": "MIP"}
    texture: int
    uv_set: int
    wrap_u: Wrap
    wrap_v: Wrap
    mag_filter: Filter
    min_filter: Filter
    mip_filter: MipFilter
    row_u: Tuple[float, float, float]
    row_v: Tuple[float, float, float]

    def __init__(self, texture: int = -1, **members: Unpack[TextureUseKeywords]) -> None:
        self._begin(_c.STRUCT["halflit_texture_use"].from_buffer_copy(_c.make("material").base_color_texture))
        self.texture = texture
        for name, value in members.items():
            setattr(self, name, value)

    @classmethod
    def _from(cls, value: Any, name: str = "texture", **members: Any) -> Any:
        if not isinstance(value, (cls, dict)):
            value = cls(-1 if value is None else whole(value, name, -1, 2**31 - 1))
        return super()._from(value, name, **members)


#: Types by which a lobe, or a texture of a material, may be given.
LobeOf = Union[Lobe, LobeMembers, LobeName, Tuple[LobeName, float]]
TextureOf = Union[TextureUse, TextureUseMembers, int, None]


class Material(Record):
    """glTF's metallic-roughness material, and a lobe. Defaults in parentheses; textures: none.

    Textures are indices that Scene.add_texture() gave, or TextureUse; textures of normals are added with color="normal". Numbers are
    multiplied by the textures with their names, metallic and roughness by channels of metallic_roughness_texture; c is a texel's colour.
    Colours are linear light with Rec. 709 primaries, "#rrggbb", or uint8 sRGB codes.

    glTF and halflit.h begin with metallic = 1, for the texture's sake. Here it is 0, and becomes 1 when a metallic_roughness_texture is set,
    unless metallic was set.

    Members:
        name: for messages ("")
        alpha_mode: "opaque", "mask" or "blend" (opaque)
        double_sided: back faces are drawn too; without it, what is clockwise as seen is left out (False)
        unlit: base colour alone, without light (False)
        own_lobe: render(lobe=...) does not replace this material's lobe (False)
        lobe: of diffuse light (lambert)
        shadow_catcher: invisible but for the shadows on it (False)
        metallic: in [0, 1] (0; 1 with a metallic_roughness_texture)
        base_color: linear, in [0, 1]; the fourth number is alpha (1, 1, 1, 1)
        roughness: in [0, 1] (1)
        dielectric_reflectance: F0 of dielectrics: reflectance at normal incidence where not metallic, in [0, 1] (0.04)
        emissive: light of its own, linear, from 0 (0, 0, 0)
        normal_scale: factor on x and y of the normal texture (1)
        occlusion_strength: in [0, 1]; 0 ignores the occlusion texture; ambient light alone is occluded (1)
        alpha_cutoff: from 0; where the alpha mode is mask: drawn where alpha is at least this (0.5)
        specular: weight of the specular reflection of dielectrics, in [0, 1] (1)
        specular_color: factor on F0 of dielectrics, linear, from 0; F0 is at most 1 (1, 1, 1)
        transmission: share of light from behind that passes through, in [0, 1]; the rest is diffuse (0)
        thickness: path length of that light inside, world units, from 0 (0)
        attenuation_distance: path length after which white light has attenuation_color, world units; 0: no absorption (0)
        attenuation_color: linear, in [0, 1] (1, 1, 1)
        clearcoat: share of the surface that is coated, in [0, 1] (0)
        clearcoat_roughness: in [0, 1] (0)
        clearcoat_normal_scale: factor on x and y of the coat's normal texture (1)
        sheen_color: of fibres above the surface, linear, in [0, 1]; black: none (0, 0, 0)
        sheen_roughness: in [0, 1]; rougher fibres glow less at grazing views and more elsewhere (0)
        iridescence: share of the surface that the film covers, in [0, 1] (0)
        iridescence_ior: index of refraction of the film, from 1 (1.3)
        iridescence_thickness_min_nm: of the film where its texture is 0, nanometres, from 0 (100)
        iridescence_thickness_max_nm: of the film where its texture is 1, or without a texture (400)
        anisotropy_strength: in [0, 1]: alpha along the direction is roughness^2 + (1 - roughness^2) strength^2 (0)
        anisotropy_rotation_rad: of the direction from the tangent, counter-clockwise, radians (0)
        base_color_texture: sRGB, alpha linear
        metallic_roughness_texture: linear: green is roughness, blue metallic
        normal_texture: linear, in tangent space: (2c - 1) * (normal_scale, normal_scale, 1)
        occlusion_texture: linear: red
        emissive_texture: sRGB
        specular_texture: linear: alpha
        specular_color_texture: sRGB
        transmission_texture: linear: red
        thickness_texture: linear: green
        clearcoat_texture: linear: red
        clearcoat_roughness_texture: linear: green
        clearcoat_normal_texture: linear, in tangent space; without it the coat has the mesh's normals, not the base's normal map
        sheen_color_texture: sRGB
        sheen_roughness_texture: linear: alpha
        iridescence_texture: linear: red
        iridescence_thickness_texture: linear: green, from the least thickness to the greatest
        anisotropy_texture: linear: red and green (2c - 1) turn the direction in tangent space, blue is the strength
        dispersion: spread of the indices of refraction of red and blue, from 0: 20 / Abbe's number (0)
        diffuse_transmission: share of scattered light that leaves on the far side, in [0, 1] (0)
        diffuse_transmission_color: of that light, in place of the base colour, linear, in [0, 1] (1, 1, 1)
        diffuse_transmission_texture: linear: alpha
        diffuse_transmission_color_texture: sRGB
    """

    _kind, _choices = "material", {"alpha_mode": "ALPHA"}
    _truths = frozenset({"double_sided", "unlit", "own_lobe", "shadow_catcher"})
    _nested = {"halflit_lobe": Lobe, "halflit_texture_use": TextureUse}
    _metallic_given = False
    # Made by apps/c/tables.py of shading/material_properties.def.
    _colors: Dict[str, Optional[float]] = {
        "base_color": 1.0,
        "emissive": None,
        "specular_color": math.inf,
        "attenuation_color": 1.0,
        "sheen_color": 1.0,
        "diffuse_transmission_color": 1.0,
    }
    _ranges = {
        "metallic": (0.0, 1.0),
        "roughness": (0.0, 1.0),
        "dielectric_reflectance": (0.0, 1.0),
        "occlusion_strength": (0.0, 1.0),
        "alpha_cutoff": (0.0, math.inf),
        "specular": (0.0, 1.0),
        "transmission": (0.0, 1.0),
        "thickness": (0.0, math.inf),
        "attenuation_distance": (0.0, math.inf),
        "clearcoat": (0.0, 1.0),
        "clearcoat_roughness": (0.0, 1.0),
        "sheen_roughness": (0.0, 1.0),
        "iridescence": (0.0, 1.0),
        "iridescence_ior": (1.0, math.inf),
        "iridescence_thickness_min_nm": (0.0, math.inf),
        "iridescence_thickness_max_nm": (0.0, math.inf),
        "anisotropy_strength": (0.0, 1.0),
        "dispersion": (0.0, math.inf),
        "diffuse_transmission": (0.0, 1.0),
    }
    base_color: Color
    metallic: float
    roughness: float
    dielectric_reflectance: float
    emissive: Color
    normal_scale: float
    occlusion_strength: float
    alpha_cutoff: float
    specular: float
    specular_color: Color
    transmission: float
    thickness: float
    attenuation_distance: float
    attenuation_color: Color
    clearcoat: float
    clearcoat_roughness: float
    clearcoat_normal_scale: float
    sheen_color: Color
    sheen_roughness: float
    iridescence: float
    iridescence_ior: float
    iridescence_thickness_min_nm: float
    iridescence_thickness_max_nm: float
    anisotropy_strength: float
    anisotropy_rotation_rad: float
    base_color_texture: Union[TextureUse, int]
    metallic_roughness_texture: Union[TextureUse, int]
    normal_texture: Union[TextureUse, int]
    occlusion_texture: Union[TextureUse, int]
    emissive_texture: Union[TextureUse, int]
    specular_texture: Union[TextureUse, int]
    specular_color_texture: Union[TextureUse, int]
    transmission_texture: Union[TextureUse, int]
    thickness_texture: Union[TextureUse, int]
    clearcoat_texture: Union[TextureUse, int]
    clearcoat_roughness_texture: Union[TextureUse, int]
    clearcoat_normal_texture: Union[TextureUse, int]
    sheen_color_texture: Union[TextureUse, int]
    sheen_roughness_texture: Union[TextureUse, int]
    iridescence_texture: Union[TextureUse, int]
    iridescence_thickness_texture: Union[TextureUse, int]
    anisotropy_texture: Union[TextureUse, int]
    dispersion: float
    diffuse_transmission: float
    diffuse_transmission_color: Color
    diffuse_transmission_texture: Union[TextureUse, int]
    diffuse_transmission_color_texture: Union[TextureUse, int]
    # Other members.
    name: str
    alpha_mode: AlphaMode
    double_sided: bool
    unlit: bool
    own_lobe: bool
    lobe: Union[Lobe, LobeName, Tuple[LobeName, float]]
    shadow_catcher: bool

    def __init__(self, **members: Unpack[MaterialMembers]) -> None:
        super().__init__()
        self._c.metallic = 0.0
        for name, value in members.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        if name == "metallic":
            object.__setattr__(self, "_metallic_given", True)
        elif name == "metallic_roughness_texture" and self._has_metallic_texture() and not self._metallic_given and self.metallic == 0:
            self._c.metallic = 1.0  # a factor of 0 would hide the texture's

    def _has_metallic_texture(self) -> bool:
        return bool(self._c.metallic_roughness_texture.texture >= 0)

    def _copied(self) -> Any:
        other = super()._copied()
        object.__setattr__(other, "_metallic_given", self._metallic_given)
        return other

    def _defaults(self) -> Dict[str, Any]:
        return {**super()._defaults(), "metallic": 1.0 if self._has_metallic_texture() else 0.0}
