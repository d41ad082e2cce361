"""The keywords of render() by name, and the settings of halflit.h that they write."""
from __future__ import annotations

import ctypes
from typing import Any, Dict, Iterable, Tuple

from . import _c
from ._color import BRIGHTEST, color
from ._errors import UsageError
from ._material import Lobe
from ._values import real, truth

#: Planes beside the picture: name -> (member of the target, channels, number type). They show what each pixel's first sample sees.
PLANES = {
    "depth": ("depth", 1, "float32"),  # distance along the view axis; infinity where nothing is
    "normal": ("shading_normal", 3, "float32"),  # unit normal that light falls on, normal map included, world space
    "vertex_normal": ("normal", 3, "float32"),  # the same without the normal map
    "albedo": ("albedo", 3, "float32"),  # base colour, linear
    "position": ("position", 3, "float32"),  # world space
    "id": ("instance", 1, "int32"),  # index of the instance plus 1; 0 where nothing is
    "triangle": ("triangle", 1, "int32"),  # number of the triangle in its mesh plus 1
    "coverage": ("coverage", 1, "float32"),  # share of the samples that a surface covers
    "lights": ("lights", 1, "int32"),  # lights that have the surface in their range and cone
    "barycentric": ("barycentric", 2, "float32"),  # weights of the triangle's second and third corner
    "uv": ("uv", 2, "float32"),  # texture coordinates, set 0, before a texture's own transform
}
#: Planes that are made of others: name -> the plane that it is made of, in the same shape.
DERIVED = {
    "depth16": "depth",  # uint16: 1 to 65535 between the least and the largest depth; 0 where nothing is
    "ray": "depth",  # distance from the camera's eye; infinity where nothing is
    "view_normal": "normal",  # in the camera's space: x to the right, y up, z towards the viewer
    "mesh": "id",  # index of the mesh plus 1
    "material": "id",  # index of the material plus 1; 0 for the default material too
    "part": "id",  # number, from 1, of the file's node that places it, among those that place something; 0: none. Without a file, the id
}

#: Names of the planes: render(aovs=...).
AOVS = (*PLANES, *DERIVED)

#: Keywords of a view of the whole scene.
WHOLE_SCENE = ("azimuth", "elevation", "zoom", "fov", "orthographic", "view", "fit")
VIEW = ("camera", *WHOLE_SCENE, "setup", "exposure", "ev", "ambient", "studio", "studio_turn")
PIXELS = ("dtype", "premultiplied", "out", "aovs", "region")
EXECUTION = ("threads", "isa", "tile_size", "time_limit", "memory_limit", "progress", "cancelled")
#: Keyword -> (member of halflit_settings, type or enumeration). Made by apps/c/tables.py of raster/settings_table.def.
SETTINGS: Dict[str, Tuple[str, str]] = {
    "max_error": ("max_error_codes", "float"),
    "environment_tolerance": ("environment_tolerance", "float"),
    "shadow_memory_limit": ("shadow_memory_limit", "int"),
    "samples": ("samples", "int"),
    "tone_curve": ("tone_curve", "TONE"),
    "point_size": ("point_size", "float"),
    "line_width": ("line_width", "float"),
    "accuracy": ("accuracy", "ACCURACY"),
    "texture_detail": ("texture_detail", "DETAIL"),
    "anisotropy": ("anisotropy", "int"),
    "specular": ("specular", "SPECULAR"),
    "normalize_specular": ("normalize_specular", "bool"),
    "normal_scale": ("normal_scale", "float"),
    "shading_rate": ("shading_rate", "RATE"),
    "environment_bands": ("environment_bands", "int"),
    "shadows": ("shadows", "SHADOWS"),
    "shadow_size": ("shadow_size", "int"),
    "soft_shadow_maps": ("soft_shadow_maps", "int"),
    "shadow_fade": ("shadow_fade", "float"),
    "sky_shadows": ("sky_shadows", "int"),
    "shadow_terminator_offset": ("shadow_terminator_offset", "bool"),
    "emission_scale": ("emission_scale", "float"),
    "edges": ("edges", "EDGES"),
    "hidden_edges": ("hidden_edges", "HIDDEN_EDGES"),
    "edge_angle_deg": ("edge_angle_deg", "float"),
    "edge_width": ("edge_width", "float"),
    "max_layers": ("max_layers", "int"),
    "contact_shadow": ("contact_shadow", "float"),
    "alpha": ("alpha", "ALPHA_SPACE"),
    "shadow_softness_deg": ("shadow_softness_deg", "float"),
    "edl": ("edl", "EDL"),
    "edl_strength": ("edl_strength", "float"),
    "edge_contrast": ("edge_contrast", "bool"),
}
#: Keywords that have another place here.
_ELSEWHERE = {
    **dict.fromkeys(("width", "height", "resolution"), "the picture's is size=(width, height)"),
    "up": "it is one of Scene(), Scene.load() and halflit.render()",
}
KNOWN = frozenset((*VIEW, *PIXELS, *EXECUTION, *SETTINGS, "background", "edge_color", "lobe"))


def check_names(options: Iterable[str], known: Iterable[str] = KNOWN, function: str = "render") -> None:
    """Fails as a function does for a keyword that it does not have."""
    for name in options:
        if name not in known:
            import difflib  # takes a tenth of halflit's own import

            near = difflib.get_close_matches(name, sorted(known), 1)
            hint = _ELSEWHERE.get(name) or (f"did you mean {near[0]!r}?" if near else "")
            raise TypeError(f"{function}() has no keyword {name!r}" + (f", {hint}" if hint else ""))


def apply_settings(settings: Any, options: Dict[Any, Any]) -> None:
    """Writes the keywords that were given into a halflit_settings."""
    for name in (*SETTINGS, "background", "edge_color", "lobe"):
        value = options.get(name)
        if value is None:
            continue
        if name == "background":
            set_background(settings, value)
        elif name == "edge_color":
            settings.edge_color = (ctypes.c_float * 3)(*color(value, name, 3, 1))
            if options.get("edge_contrast") is None:
                settings.edge_contrast = 0
        elif name == "lobe":
            settings.lobe, settings.override_lobe = Lobe._from(value)._c, 1
        else:
            member, kind = SETTINGS[name]
            if kind.isupper() and not isinstance(value, str):
                settings.put(member, value, name)
            else:
                try:
                    _c.call("settings_read", ctypes.byref(settings), member.encode(), text_of_setting(value, kind, name))
                except UsageError as error:
                    raise UsageError(str(error).replace(member, name, 1)) from None


def number_text(number: float) -> str:
    """The shortest digits."""
    text = repr(number)
    return text[:-2] if text.endswith(".0") else text


def text_of_setting(value: Any, kind: str, name: str) -> bytes:
    """A value as the engine reads it."""
    if kind == "bool" and not isinstance(value, str):
        value = "on" if truth(value, name) else "off"
    elif not isinstance(value, str):
        value = str(value) if kind == "int" else number_text(real(value, name))
    if value == "":
        raise UsageError(f"{name}: expected a value, found nothing")
    return _c.bytes_of(value, name) or b""


def set_background(settings: Any, value: Any) -> None:
    if isinstance(value, str) and value == "auto":
        return
    if isinstance(value, str) and value in ("environment", "transparent"):
        settings.background_environment = value == "environment"
        if value == "transparent":
            settings.background = (ctypes.c_float * 4)()
        return
    settings.background = (ctypes.c_float * 4)(*color(value, "background", 4, BRIGHTEST))


def settings_dict(settings: Any) -> Dict[str, Any]:
    """All settings by the names of halflit_settings."""
    values: Dict[str, Any] = {}
    kinds = dict(SETTINGS.values())
    for name, _ in settings._fields_:
        value: Any = getattr(settings, name)
        if name in ("size", "reserved"):
            continue
        if kinds.get(name, "").isupper():
            value = {number: text for text, number in _c.choices(kinds[name]).items()}[value]
        elif name == "lobe":
            value = Lobe._of(value).to_dict()
        elif isinstance(value, ctypes.Structure):
            fields: Any = value._fields_
            value = tuple(getattr(value, field[0]) for field in fields)
        values[name] = tuple(value) if isinstance(value, ctypes.Array) else value
    return values
