"""The keywords of render() by name, and the settings of halflit.h that they write."""
from __future__ import annotations

import ctypes
from typing import Any, Dict, Iterable

from . import _c
from ._color import BRIGHTEST, color
from ._material import Lobe
from ._record import chosen
from ._values import truth

#: Planes beside the picture: name -> (member of the target, channels, number type). They show what each pixel's first sample sees.
PLANES = {
    "depth": ("depth", 1, "float32"),  # distance along the view axis; infinity where nothing is
    "normal": ("shading_normal", 3, "float32"),  # unit normal that light falls on, normal map included, world space
    "vertex_normal": ("normal", 3, "float32"),  # the same without the normal map
    "albedo": ("albedo", 3, "float32"),  # base colour, linear
    "position": ("position", 3, "float32"),  # world space
    "id": ("instance", 1, "uint32"),  # index of the instance plus 1; 0 where nothing is
    "triangle": ("triangle", 1, "uint32"),  # number of the triangle in its mesh plus 1
    "coverage": ("coverage", 1, "float32"),  # share of the samples that a surface covers
    "lights": ("lights", 1, "uint32"),  # lights that have the surface in their range and cone
}

#: Names of the planes: render(aovs=...).
AOVS = tuple(PLANES)

VIEW = ("camera", "azimuth", "elevation", "zoom", "fov", "setup", "exposure", "ev", "ambient", "studio", "studio_turn")
PIXELS = ("dtype", "premultiplied", "out", "aovs", "region")
EXECUTION = ("threads", "isa", "tile_size", "time_limit", "memory_limit", "progress", "cancelled")
_NAMES = {"max_error": "max_error_codes"}  # keyword -> member of halflit_settings, where they differ
_TRUTHS = ("normalize_specular", "shadow_terminator_offset")
_CHOICES = {
    "accuracy": "ACCURACY",
    "shading_rate": "RATE",
    "texture_detail": "DETAIL",
    "specular": "SPECULAR",
    "shadows": "SHADOWS",
    "tone_curve": "TONE",
}
SETTINGS = (
    "samples background max_error accuracy shading_rate texture_detail anisotropy specular normalize_specular lobe environment_bands"
    " environment_tolerance point_size line_width shadows shadow_size shadow_fade shadow_terminator_offset shadow_memory_limit"
    " soft_shadow_maps sky_shadows tone_curve"
).split()
KNOWN = frozenset((*VIEW, *PIXELS, *EXECUTION, *SETTINGS))


def check_names(options: Iterable[str], known: Iterable[str] = KNOWN, function: str = "render") -> None:
    """Fails as a function does for a keyword that it does not have."""
    for name in options:
        if name not in known:
            import difflib  # takes a tenth of halflit's own import

            near = difflib.get_close_matches(name, sorted(known), 1)
            raise TypeError(f"{function}() has no keyword {name!r}" + (f", did you mean {near[0]!r}?" if near else ""))


def apply_settings(settings, options: dict) -> None:
    """Writes the keywords that were given into a halflit_settings."""
    for name in SETTINGS:
        if options.get(name) is None:
            continue
        value = options[name]
        if name == "background":
            set_background(settings, value)
        elif name == "lobe":
            settings.lobe, settings.override_lobe = Lobe._from(value)._c, 1
        elif name in _CHOICES and isinstance(value, str):
            settings.put(name, chosen(value, _CHOICES[name], name), name)
        else:
            settings.put(_NAMES.get(name, name), truth(value, name) if name in _TRUTHS else value, name)


def set_background(settings, value) -> None:
    if isinstance(value, str) and value in ("environment", "transparent"):
        settings.background_environment = value == "environment"
        if value == "transparent":
            settings.background = (ctypes.c_float * 4)()
        return
    settings.background = (ctypes.c_float * 4)(*color(value, "background", 4, BRIGHTEST))


def settings_dict(settings) -> Dict[str, Any]:
    """All settings by the names of halflit_settings."""
    values: Dict[str, Any] = {}
    for name, _ in settings._fields_:
        value = getattr(settings, name)
        if name in ("size", "reserved"):
            continue
        if name in _CHOICES:
            value = {number: text for text, number in _c.choices(_CHOICES[name]).items()}[value]
        elif name == "lobe":
            value = Lobe._of(value).to_dict()
        elif isinstance(value, ctypes.Structure):
            value = tuple(getattr(value, member) for member, _ in value._fields_)
        values[name] = tuple(value) if isinstance(value, ctypes.Array) else value
    return values
