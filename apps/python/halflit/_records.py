"""Lights, materials, uses of textures and lobes: structs of halflit.h whose members are attributes.

A member that is an enumeration has the names of its values ("blend"), a colour or a point is a tuple, truth is a bool.
"""
from __future__ import annotations

import ctypes

from . import _c
from ._errors import UsageError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Sequence, Tuple, Union

    import numpy as np

    Color = Union[Sequence[float], np.ndarray]
    Point = Union[Sequence[float], np.ndarray]


class Record:
    """Base of the classes below: keywords of the constructor and attributes are the members of the struct, with its defaults."""

    _kind = ""  # name of the struct without halflit_
    _truths: frozenset = frozenset()
    _choices: dict = {}  # member -> prefix of its constants
    _has_init = True

    def __init__(self, **members: Any):
        object.__setattr__(self, "_c", _c.make(self._kind, True) if self._has_init else _c.STRUCT["halflit_" + self._kind]())
        for name, value in members.items():
            setattr(self, name, value)

    @classmethod
    def _of(cls, struct):
        """A record around a struct, which it keeps."""
        record = cls.__new__(cls)
        object.__setattr__(record, "_c", struct)
        return record

    @classmethod
    def _members(cls) -> list:
        return [name for name, _ in _c.STRUCT["halflit_" + cls._kind]._fields_ if name not in ("size", "reserved")]

    def __getattr__(self, name: str):
        if name.startswith("_") or name not in self._members():
            raise AttributeError(f"{type(self).__name__} has no member {name}")
        value = getattr(self._c, name)
        if name in self._choices:
            return next((text for text, number in _c.choices(self._choices[name]).items() if number == value), value)
        if name in self._truths:
            return bool(value)
        if isinstance(value, ctypes.Array):
            return tuple(value)
        if isinstance(value, ctypes.Structure):
            return RECORDS[type(value).__name__]._of(value)
        return _c.text_of(value) if name == "name" else value

    def __setattr__(self, name: str, value) -> None:
        if name in ("size", "reserved") or name not in self._members():
            raise UsageError(f"{type(self).__name__} has no member {name}, expected one of {', '.join(self._members())}")
        setattr(self._c, name, self._converted(name, value))

    def _converted(self, name: str, value):
        if name in self._choices and isinstance(value, str):
            return chosen(value, self._choices[name], name)
        field = dict(self._c._fields_)[name]
        if issubclass(field, ctypes.Array):
            return fill(field, value, name, 1.0 if name == "base_color" else None)
        if issubclass(field, ctypes.Structure):
            return RECORDS[field.__name__]._from(value)._c
        if name == "name":
            return _c.bytes_of(value)
        return float(value) if field in (ctypes.c_float, ctypes.c_double) else int(value)

    @classmethod
    def _from(cls, value):
        """The record for what a caller may write in its place."""
        if isinstance(value, cls):
            return value
        if isinstance(value, dict):
            return cls(**value)
        raise UsageError(f"expected a {cls.__name__}, found {value!r}")

    def to_dict(self) -> dict:
        """All members by their names."""
        values = {name: getattr(self, name) for name in self._members()}
        return {name: value.to_dict() if isinstance(value, Record) else value for name, value in values.items()}

    def __reduce__(self):
        """A copy, or a pickle, has a struct of its own."""
        return _remade, (type(self), self.to_dict())

    def __repr__(self) -> str:
        defaults = type(self)().to_dict()
        members = [f"{name}={value!r}" for name, value in self.to_dict().items() if value != defaults[name]]
        return f"{type(self).__name__}({', '.join(members)})"

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.to_dict() == other.to_dict()  # type: ignore[attr-defined]

    __hash__ = None  # type: ignore[assignment]


def _remade(kind, members: dict) -> Record:
    return kind(**members)


def chosen(value: str, prefix: str, name: str) -> int:
    """The number of an enumeration's value by its name; - and _ are the same."""
    known = _c.choices(prefix)
    try:
        return known[value.replace("-", "_")]
    except KeyError:
        raise UsageError(f"{name}: expected one of {', '.join(known)}, found {value!r}") from None


def fill(array_type, value, name: str, last: float | None = None):
    """A ctypes array of numbers. last: the number that may be left out at the end, as the alpha of a colour."""
    try:
        numbers = [float(x) for x in value]
    except TypeError:
        raise UsageError(f"{name}: expected {array_type._length_} numbers, found {value!r}") from None
    if last is not None and len(numbers) == array_type._length_ - 1:
        numbers.append(last)
    if len(numbers) != array_type._length_:
        raise UsageError(f"{name}: expected {array_type._length_} numbers, found {len(numbers)}")
    return array_type(*numbers)


class Lobe(Record):
    """Diffuse light as a function of x, the cosine between normal and light: max(0, (x + wrap) / (1 + wrap)) ** power.

    Wherever a lobe is expected, a name does too: "lambert", "green", "half-lambert", "valve", "sloan" or "mcauley", or a name and a
    wrap, as in ("sloan", 0.6).

    Members:
        wrap: 0 (Lambert) to 1
        power: 0 to 10000
        normalize: scale such that a surface receives as much light as by Lambert
    """

    _kind, _has_init, _truths = "lobe", False, frozenset({"normalize"})
    wrap: float
    power: float
    normalize: bool

    def __init__(self, wrap: float = 0.0, power: float = 1.0, normalize: bool = False):
        super().__init__(wrap=wrap, power=power, normalize=normalize)

    @classmethod
    def named(cls, name: str, wrap: float = 0.5) -> Lobe:
        """A lobe of the literature. wrap: 0 to 1, for those that take one."""
        lobe = cls()
        _c.call("lobe_by_name", _c.bytes_of(name), wrap, ctypes.byref(lobe._c))
        return lobe

    @classmethod
    def _from(cls, value):
        if isinstance(value, str):
            return cls.named(value)
        if isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[0], str):
            return cls.named(*value)
        return super()._from(value)


class TextureUse(Record):
    """A material's use of a texture. Wherever one is expected, the texture's index does too.

    Members:
        texture: index; -1: none
        uv_set: 0 or 1
        wrap_u: "repeat", "mirror" or "clamp"
        wrap_v: likewise
        mag_filter: "nearest" or "linear"
        min_filter: likewise
        mip_filter: "none", "nearest" or "linear"
        row_u: u' = row_u[0] u + row_u[1] v + row_u[2]
        row_v: likewise v'
    """

    _kind, _has_init = "texture_use", False
    _choices = {"wrap_u": "WRAP", "wrap_v": "WRAP", "mag_filter": "FILTER", "min_filter": "FILTER", "mip_filter": "MIP"}
    texture: int
    uv_set: int
    wrap_u: str
    wrap_v: str
    mag_filter: str
    min_filter: str
    mip_filter: str
    row_u: Tuple[float, float, float]
    row_v: Tuple[float, float, float]

    def __init__(self, texture: int = -1, **members: Any):
        object.__setattr__(self, "_c", _c.STRUCT["halflit_texture_use"].from_buffer_copy(_c.make("material").base_color_texture))
        for name, value in {"texture": texture, **members}.items():
            setattr(self, name, value)

    @classmethod
    def _from(cls, value):
        return super()._from(value) if isinstance(value, (cls, dict)) else cls(-1 if value is None else int(value))


class Material(Record):
    """glTF's metallic-roughness material, and a lobe. Defaults: white, not metallic, roughness 1, Lambert.

    Textures are indices that Scene.add_texture() gave, or TextureUse. Colours are linear light with Rec. 709 primaries.

    Members:
        name: for messages
        base_color: linear light; 3 numbers, or 4 with alpha
        metallic: 0 to 1, times the texture's (0; 1 if a metallic_roughness_texture is given. In glTF and halflit.h always 1)
        roughness: 0 to 1, times the texture's
        emissive: light of its own
        normal_scale: factor on x and y of the normal texture
        occlusion_strength: 0 to 1
        alpha_cutoff: for "mask": drawn where alpha is at least this
        alpha_mode: "opaque", "mask" or "blend"
        double_sided: back faces are drawn too; without it, what is clockwise as seen is left out
        unlit: base colour alone, without light
        own_lobe: render(lobe=...) does not replace this material's lobe
        lobe: of diffuse light
        base_color_texture: sRGB
        metallic_roughness_texture: linear: green is roughness, blue metallic
        normal_texture: linear, in tangent space; add it with color="normal"
        occlusion_texture: linear: red
        emissive_texture: sRGB
        dielectric_reflectance: where not metallic: light mirrored straight on, 0 to 1 (0.04)
        transmission: share of light from behind that passes through, 0 to 1
        thickness: way of that light inside, world units
        attenuation_distance: way after which white light has attenuation_color, world units; 0: nothing is absorbed
        attenuation_color: 0 to 1
        transmission_texture: linear: red
        thickness_texture: linear: green
        specular: factor of what is mirrored where not metallic, 0 to 1
        specular_color: factor of the light mirrored straight on there
        specular_texture: linear: alpha
        specular_color_texture: sRGB
        shadow_catcher: invisible but for the shadows on it
        clearcoat: share that is coated with varnish, 0 to 1
        clearcoat_roughness: 0 to 1
        clearcoat_normal_scale: factor on x and y of the coat's normal texture
        clearcoat_texture: linear: red
        clearcoat_roughness_texture: linear: green
        clearcoat_normal_texture: linear, in tangent space
        sheen_color: of fibres above the surface; black: none
        sheen_roughness: 0 to 1
        sheen_color_texture: sRGB
        sheen_roughness_texture: linear: alpha
    """

    _kind, _choices = "material", {"alpha_mode": "ALPHA"}
    _truths = frozenset({"double_sided", "unlit", "own_lobe", "shadow_catcher"})
    name: str
    base_color: Color
    metallic: float
    roughness: float
    emissive: Color
    normal_scale: float
    occlusion_strength: float
    alpha_cutoff: float
    alpha_mode: str
    double_sided: bool
    unlit: bool
    own_lobe: bool
    lobe: Union[Lobe, str, Tuple[str, float]]
    base_color_texture: Union[TextureUse, int]
    metallic_roughness_texture: Union[TextureUse, int]
    normal_texture: Union[TextureUse, int]
    occlusion_texture: Union[TextureUse, int]
    emissive_texture: Union[TextureUse, int]
    dielectric_reflectance: float
    transmission: float
    thickness: float
    attenuation_distance: float
    attenuation_color: Color
    transmission_texture: Union[TextureUse, int]
    thickness_texture: Union[TextureUse, int]
    specular: float
    specular_color: Color
    specular_texture: Union[TextureUse, int]
    specular_color_texture: Union[TextureUse, int]
    shadow_catcher: bool
    clearcoat: float
    clearcoat_roughness: float
    clearcoat_normal_scale: float
    clearcoat_texture: Union[TextureUse, int]
    clearcoat_roughness_texture: Union[TextureUse, int]
    clearcoat_normal_texture: Union[TextureUse, int]
    sheen_color: Color
    sheen_roughness: float
    sheen_color_texture: Union[TextureUse, int]
    sheen_roughness_texture: Union[TextureUse, int]

    def __init__(self, **members: Any):
        super().__init__(**members)
        if "metallic" not in members and "metallic_roughness_texture" not in members:
            self.metallic = 0.0


class Light(Record):
    """A light. A directional light of colour 1 makes a white surface that faces it exactly white; other lights do so at distance 1.

    Light("point", position=(0, 2, 0), color=(4, 4, 4)). Defaults: white, directional, straight down.

    Members:
        type: "directional", "point" or "spot"
        color: directional: irradiance / pi; point, spot: the same at distance 1
        position: point, spot: world space
        direction: directional, spot: the way the light travels, of any length above 0
        range: point, spot: no light beyond, world units; 0: no limit
        source_radius: point, spot: smaller distances count as this, world units
        inner_cone_rad: spot: full light up to this angle from the axis
        outer_cone_rad: spot: none from this angle on
        cone_power: spot: factor cos(angle from the axis) ** cone_power
        shadow_radius: size for soft shadows. Directional: angle from middle to rim, radians; others: world units
    """

    _kind, _choices = "light", {"type": "LIGHT"}
    type: str
    color: Color
    position: Point
    direction: Point
    range: float
    source_radius: float
    inner_cone_rad: float
    outer_cone_rad: float
    cone_power: float
    shadow_radius: float

    def __init__(self, type: str = "directional", **members: Any):
        super().__init__(type=type, **members)


RECORDS: dict = {"halflit_" + kind._kind: kind for kind in (Lobe, TextureUse, Material, Light)}  # type: ignore[attr-defined]
