"""The light of a scene."""
from __future__ import annotations

import ctypes
import math
import os
from typing import Any, Optional, Union

from . import _c
from ._color import color
from ._errors import UsageError
from ._lazy import np
from ._light import Light
from ._members import LightKeywords, LightMembers
from ._scene_base import SceneBase
from ._types import Color, LightType, Unpack
from ._values import real, truth


class Lighting(SceneBase):
    """The methods of a Scene about light."""

    def add_light(self, light: Union[Light, LightMembers, LightType] = "directional", **members: Unpack[LightKeywords]) -> int:
        """Adds a Light, or one of this type, with these members: add_light("point", position=(0, 2, 0), color=(4, 4, 4))."""
        index = ctypes.c_int32()
        made = Light(light, **members) if isinstance(light, str) else Light._from(light, **members)
        made._refuse_idle(members)
        made._check()
        self._change("scene_add_light", ctypes.byref(made._c), ctypes.byref(index))
        self._own_lights = True
        return index.value

    def light(self, index: int) -> Light:
        """A light of the scene. Change a member, then call set_light()."""
        light = Light()
        self._call("scene_get_light", index, ctypes.byref(light._c))
        return light

    def set_light(self, index: int, light: Union[Light, LightMembers]) -> None:
        """Replaces a light."""
        made = Light._from(light)
        made._check()
        self._change("scene_set_light", index, ctypes.byref(made._c))

    def remove_light(self, index: int) -> None:
        """Removes a light; add_light() may use its index again."""
        self._change("scene_remove_light", index)

    def set_ambient(self, sky: Color, ground: Optional[Color] = None) -> None:
        """Sets the light from all around, linear: sky from above, ground (the same) from below. An environment replaces it."""
        given = ((sky, "sky"), (sky if ground is None else ground, "ground"))
        self._change("scene_set_ambient", *((ctypes.c_float * 3)(*color(value, name, 3)) for value, name in given))

    def set_environment(self, image: Any, *, rotate: float = 0.0, extract_suns: bool = True, calibrated: bool = False) -> None:
        """Lights the scene by an image of the light from all directions, in the place of ambient light.

        image: floats (height, width, 3), linear, row 0 straight up, the middle column along -z (+y where z is up); a path (.hdr, .pfm,
        .exr); or "sky". rotate: degrees about the vertical, counter-clockwise seen from above. calibrated: the array is made for
        exposure 1.
        """
        how = _c.make("environment_options")
        how.rotate_rad = real(rotate, "rotate") * (math.pi / 180)
        how.extract_suns, how.calibrated = truth(extract_suns, "extract_suns"), truth(calibrated, "calibrated")
        if isinstance(image, str) and image == "sky":
            self._change("scene_set_sky", ctypes.byref(how))
        elif isinstance(image, (str, os.PathLike)):
            self._change("scene_load_environment", _c.bytes_of(image, "environment"), ctypes.byref(how))
        else:
            from ._arrays import array_of

            array = array_of(image, "environment")
            if array.ndim != 3 or array.shape[2] != 3 or array.dtype.kind != "f":
                raise UsageError(
                    "environment: expected an array of shape (height, width, 3), floats of linear light,"
                    f" found {array.dtype} of {array.shape}"
                )
            array = np.ascontiguousarray(array, dtype=np.float32)
            self._change("scene_set_environment", array.ctypes.data, array.shape[1], array.shape[0], ctypes.byref(how))

    def clear_lights(self) -> None:
        """Removes the lights, the ambient light and the environment, those of the file too."""
        self._change("scene_clear_lights")
        self._own_lights = False
