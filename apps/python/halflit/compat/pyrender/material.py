"""Materials of glTF."""
from __future__ import annotations

from typing import Any, Callable, ClassVar, Dict, Optional, Set, Tuple

from ._values import Array, Checked, bounded, color, text, truth
from .texture import Texture


def _texture(channels: str) -> Callable[[Any], Optional[Texture]]:
    """A check: a Texture, or what one is made of."""

    def check(value: Any) -> Optional[Texture]:
        return value if value is None or isinstance(value, Texture) else Texture(source=value, source_channels=channels)

    return check


def _alpha_mode(value: Any) -> str:
    if value is None:
        return "OPAQUE"
    if value not in ("OPAQUE", "MASK", "BLEND"):
        raise ValueError(f"alphaMode: expected OPAQUE, MASK or BLEND, found {value!r}")
    return str(value)


class Material(Checked):
    """Base of all materials.

    Textures are Texture, arrays (h, w, c) or pictures of PIL: normalTexture (tangent space, y up), occlusionTexture (red), emissiveTexture
    (sRGB, times emissiveFactor). alphaMode: "OPAQUE", "MASK" (drawn where alpha is at least alphaCutoff) or "BLEND". doubleSided: back
    faces are drawn too. wireframe: edges alone are drawn. smooth is kept and not used.
    """

    _checks: ClassVar[Dict[str, Callable[[Any], Any]]] = {
        "name": text,
        "normalTexture": _texture("RGB"),
        "occlusionTexture": _texture("R"),
        "emissiveTexture": _texture("RGB"),
        "emissiveFactor": color(3, 0.0),
        "alphaMode": _alpha_mode,
        "alphaCutoff": bounded("alphaCutoff", 0, 1, 0.5),
        **{name: truth(name) for name in ("doubleSided", "smooth", "wireframe")},
    }
    name: Optional[str]
    normalTexture: Optional[Texture]
    occlusionTexture: Optional[Texture]
    emissiveTexture: Optional[Texture]
    emissiveFactor: Array
    alphaMode: str
    alphaCutoff: float
    doubleSided: bool
    smooth: bool
    wireframe: bool
    #: Names of the colour with alpha, its texture, and of all textures.
    _base, _base_texture = "baseColorFactor", "baseColorTexture"
    _textures: ClassVar[Tuple[str, ...]] = ("normalTexture", "occlusionTexture", "emissiveTexture")

    def __init__(
        self,
        name: Optional[str] = None,
        normalTexture: Any = None,  # noqa: N803
        occlusionTexture: Any = None,  # noqa: N803
        emissiveTexture: Any = None,  # noqa: N803
        emissiveFactor: Any = None,  # noqa: N803
        alphaMode: Optional[str] = None,  # noqa: N803
        alphaCutoff: Optional[float] = None,  # noqa: N803
        doubleSided: bool = False,  # noqa: N803
        smooth: bool = True,
        wireframe: bool = False,
    ) -> None:
        self._set(locals())

    @property
    def textures(self) -> Set[Texture]:
        """The textures that it has."""
        return {texture for texture in (getattr(self, name) for name in self._textures) if texture is not None}

    @property
    def is_transparent(self) -> bool:
        """Whether some of it lets what is behind through."""
        if self.alphaMode == "OPAQUE":
            return False
        cutoff = 1.0 if self.alphaMode == "BLEND" else self.alphaCutoff
        texture = getattr(self, self._base_texture, None)
        return bool(getattr(self, self._base)[3] < cutoff) or (texture is not None and texture.is_transparent(cutoff))


class MetallicRoughnessMaterial(Material):
    """baseColorFactor (4,), linear, times baseColorTexture (sRGB, linear alpha). metallicFactor, roughnessFactor in [0, 1], times the blue
    and the green channel of metallicRoughnessTexture."""

    _checks = {
        **Material._checks,
        "baseColorFactor": color(4, 1.0),
        "baseColorTexture": _texture("RGBA"),
        "metallicFactor": bounded("metallicFactor", 0, 1, 1.0),
        "roughnessFactor": bounded("roughnessFactor", 0, 1, 1.0),
        "metallicRoughnessTexture": _texture("GB"),
    }
    baseColorFactor: Array
    baseColorTexture: Optional[Texture]
    metallicFactor: float
    roughnessFactor: float
    metallicRoughnessTexture: Optional[Texture]
    _textures = (*Material._textures, "baseColorTexture", "metallicRoughnessTexture")

    def __init__(
        self,
        name: Optional[str] = None,
        normalTexture: Any = None,  # noqa: N803
        occlusionTexture: Any = None,  # noqa: N803
        emissiveTexture: Any = None,  # noqa: N803
        emissiveFactor: Any = None,  # noqa: N803
        alphaMode: Optional[str] = None,  # noqa: N803
        alphaCutoff: Optional[float] = None,  # noqa: N803
        doubleSided: bool = False,  # noqa: N803
        smooth: bool = True,
        wireframe: bool = False,
        baseColorFactor: Any = None,  # noqa: N803
        baseColorTexture: Any = None,  # noqa: N803
        metallicFactor: Optional[float] = 1.0,  # noqa: N803
        roughnessFactor: Optional[float] = 1.0,  # noqa: N803
        metallicRoughnessTexture: Any = None,  # noqa: N803
    ) -> None:
        self._set(locals())


class SpecularGlossinessMaterial(Material):
    """diffuseFactor (4,), linear, times diffuseTexture (sRGB, linear alpha). specularFactor (3,), linear: reflectance at normal incidence.
    glossinessFactor in [0, 1]: 1 is a mirror. specularGlossinessTexture is kept and not used."""

    _checks = {
        **Material._checks,
        "diffuseFactor": color(4, 1.0),
        "diffuseTexture": _texture("RGBA"),
        "specularFactor": color(3, 1.0),
        "glossinessFactor": bounded("glossinessFactor", 0, 1, 1.0),
        "specularGlossinessTexture": _texture("RGBA"),
    }
    diffuseFactor: Array
    diffuseTexture: Optional[Texture]
    specularFactor: Array
    glossinessFactor: float
    specularGlossinessTexture: Optional[Texture]
    _base, _base_texture = "diffuseFactor", "diffuseTexture"
    _textures = (*Material._textures, "diffuseTexture", "specularGlossinessTexture")

    def __init__(
        self,
        name: Optional[str] = None,
        normalTexture: Any = None,  # noqa: N803
        occlusionTexture: Any = None,  # noqa: N803
        emissiveTexture: Any = None,  # noqa: N803
        emissiveFactor: Any = None,  # noqa: N803
        alphaMode: Optional[str] = None,  # noqa: N803
        alphaCutoff: Optional[float] = None,  # noqa: N803
        doubleSided: bool = False,  # noqa: N803
        smooth: bool = True,
        wireframe: bool = False,
        diffuseFactor: Any = None,  # noqa: N803
        diffuseTexture: Any = None,  # noqa: N803
        specularFactor: Any = None,  # noqa: N803
        glossinessFactor: float = 1.0,  # noqa: N803
        specularGlossinessTexture: Any = None,  # noqa: N803
    ) -> None:
        self._set(locals())
