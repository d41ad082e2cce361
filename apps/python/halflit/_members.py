"""Members of materials, lights, cameras and uses of textures as dicts and as keywords, for type checkers."""
from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Tuple, TypedDict

from ._types import AlphaMode, Color, Filter, LightType, MipFilter, Point, Wrap

if TYPE_CHECKING:
    from ._material import LobeOf, TextureOf


class LobeMembers(TypedDict, total=False):
    """See halflit.Lobe."""

    wrap: float
    power: float
    normalize: bool


class TextureUseKeywords(TypedDict, total=False):
    """See halflit.TextureUse."""

    uv_set: int
    wrap_u: Wrap
    wrap_v: Wrap
    mag_filter: Filter
    min_filter: Filter
    mip_filter: MipFilter
    row_u: Tuple[float, float, float]
    row_v: Tuple[float, float, float]


class TextureUseMembers(TextureUseKeywords, total=False):
    """The same with its texture."""

    texture: int


class LightKeywords(TypedDict, total=False):
    """See halflit.Light."""

    # Made by apps/c/tables.py: light
    color: Color
    position: Point
    direction: Point
    range: float
    source_radius: float
    inner_cone_rad: float
    outer_cone_rad: float
    cone_power: float
    shadow_radius: float


class LightMembers(LightKeywords, total=False):
    """The same with its type."""

    type: LightType


class CameraMembers(TypedDict, total=False):
    """See halflit.Camera; without its matrix."""

    name: str
    sides: Optional[Tuple[float, float, float, float]]
    # Made by apps/c/tables.py: camera
    orthographic: bool
    fov_y_rad: float
    aspect: float
    half_height: float
    half_width: float
    near_z: float
    far_z: float


class MaterialMembers(TypedDict, total=False):
    """See halflit.Material."""

    name: str
    alpha_mode: AlphaMode
    double_sided: bool
    unlit: bool
    own_lobe: bool
    lobe: LobeOf
    shadow_catcher: bool
    # Made by apps/c/tables.py: material
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
    base_color_texture: TextureOf
    metallic_roughness_texture: TextureOf
    normal_texture: TextureOf
    occlusion_texture: TextureOf
    emissive_texture: TextureOf
    specular_texture: TextureOf
    specular_color_texture: TextureOf
    transmission_texture: TextureOf
    thickness_texture: TextureOf
    clearcoat_texture: TextureOf
    clearcoat_roughness_texture: TextureOf
    clearcoat_normal_texture: TextureOf
    sheen_color_texture: TextureOf
    sheen_roughness_texture: TextureOf
    iridescence_texture: TextureOf
    iridescence_thickness_texture: TextureOf
    anisotropy_texture: TextureOf
    dispersion: float
    diffuse_transmission: float
    diffuse_transmission_color: Color
    diffuse_transmission_texture: TextureOf
    diffuse_transmission_color_texture: TextureOf
