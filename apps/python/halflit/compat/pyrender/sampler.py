"""How textures are filtered and repeated."""
from __future__ import annotations

from typing import Optional

from ._values import Checked, text
from .constants import GLTF


class Sampler(Checked):
    """Filters and wraps of a texture, by numbers of GLTF. Filters that are None: the nearest texel, as in pyrender."""

    _checks = {"name": text}
    name: Optional[str]
    magFilter: Optional[int]
    minFilter: Optional[int]
    wrapS: int
    wrapT: int

    def __init__(
        self,
        name: Optional[str] = None,
        magFilter: Optional[int] = None,  # noqa: N803
        minFilter: Optional[int] = None,  # noqa: N803
        wrapS: int = GLTF.REPEAT,  # noqa: N803
        wrapT: int = GLTF.REPEAT,  # noqa: N803
    ) -> None:
        self.name, self.magFilter, self.minFilter, self.wrapS, self.wrapT = name, magFilter, minFilter, wrapS, wrapT
