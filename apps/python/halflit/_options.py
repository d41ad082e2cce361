"""The keywords of render() by name, and the settings of halflit.h that they write."""
from __future__ import annotations

import ctypes

from . import _c
from ._errors import UsageError
from ._records import Lobe, chosen, fill

#: Planes beside the picture: name -> (member of the target, channels, number type). They show what each pixel's first sample sees.
AOVS = {
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

VIEW = ("camera", "azimuth", "elevation", "zoom", "fov", "setup", "exposure", "ambient", "studio", "studio_turn")
PIXELS = ("dtype", "premultiplied", "out", "aovs", "region")
EXECUTION = ("threads", "isa", "tile_size", "time_limit", "memory_limit", "progress", "cancelled")
_NAMES = {"max_error": "max_error_codes"}  # keyword -> member of halflit_settings, where they differ
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


def check_names(options: dict, known=KNOWN) -> None:
    """Fails as a function does for a keyword that it does not have."""
    for name in options:
        if name not in known:
            import difflib

            near = difflib.get_close_matches(name, sorted(known), 1)
            raise TypeError(f"render() has no keyword {name!r}" + (f", did you mean {near[0]!r}?" if near else ""))


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
            setattr(settings, name, chosen(value, _CHOICES[name], name))
        else:
            setattr(settings, _NAMES.get(name, name), value)


def set_background(settings, value) -> None:
    if isinstance(value, str) and value == "environment":
        settings.background_environment = 1
        return
    settings.background = color_of(value) if isinstance(value, str) else fill(ctypes.c_float * 4, value, "background", 1.0)


def color_of(text: str):
    """Four linear floats for "transparent" or "#rrggbb", which is sRGB."""
    digits = text[1:] if text.startswith("#") else ""
    if len(digits) in (3, 4):
        digits = "".join(2 * digit for digit in digits)
    try:
        codes = [int(digits[i : i + 2], 16) / 255 for i in range(0, len(digits), 2)]
    except ValueError:
        codes = []
    if text == "transparent":
        return (ctypes.c_float * 4)()
    if len(codes) not in (3, 4):
        raise UsageError(f"expected transparent, environment, #rgb, #rrggbb, #rrggbbaa or numbers, found {text!r}")
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in codes[:3]]
    return (ctypes.c_float * 4)(*linear, *(codes[3:] or [1.0]))


def settings_dict(settings) -> dict:
    """All settings by the names of halflit_settings."""
    values = {}
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
