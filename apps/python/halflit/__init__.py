"""halflit: models in, pictures out, on the CPU.

    import halflit
    picture = halflit.render("model.glb", size=(512, 512))    # a numpy array, uint8 (512, 512, 4); notebooks show it
    picture.save("model.png")

render() draws a file, its bytes, arrays, a trimesh or a Scene. Scene is for what render() does not know in one call: several meshes,
instances, textures, lights, many pictures. Lengths are world units, angles in degrees unless a name ends in _rad, times in seconds.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, List

from . import _c
from ._calls import Answer, call, certify, compare, explain, info, look, measure, section
from ._camera import Camera
from ._errors import BadInputError, CancelledError, Error, FileError, LimitError, UsageError
from ._geometry import MeshIndex
from ._light import Light
from ._material import Lobe, Material, TextureUse
from ._options import AOVS
from ._picture_options import PictureOptions
from ._render import render, render_meshes
from ._scene import Scene
from ._setup import Setup
from ._splats import Splats
from ._turntable import Turntable

if TYPE_CHECKING:
    from ._picture import Picture as Picture
    from ._sheet import contact_sheet as contact_sheet

__version__ = _c.VERSION
__all__ = [
    "AOVS",
    "Answer",
    "BadInputError",
    "Camera",
    "CancelledError",
    "Error",
    "FileError",
    "Light",
    "LimitError",
    "Lobe",
    "Material",
    "MeshIndex",
    "Picture",
    "PictureOptions",
    "Scene",
    "Setup",
    "Splats",
    "TextureUse",
    "Turntable",
    "UsageError",
    "call",
    "certify",
    "compare",
    "contact_sheet",
    "explain",
    "info",
    "look",
    "measure",
    "pixel_epoch",
    "render",
    "render_meshes",
    "section",
    "version",
]


def version() -> str:
    """Version of the library, as "0.1.0"."""
    text: bytes = _c.function("version")()
    return text.decode()


def pixel_epoch() -> int:
    """Libraries of equal pixel epoch give equal pixels."""
    return int(_c.function("pixel_epoch")())


def __dir__() -> List[str]:
    # dir() and help() show the names that are imported late, too.
    return sorted({*globals(), *__all__})


def __getattr__(name: str) -> Any:
    # These need numpy, which takes longer to import than all else.
    if name == "Picture":
        from ._picture import Picture

        return Picture
    if name == "contact_sheet":
        from ._sheet import contact_sheet

        return contact_sheet
    raise AttributeError(f"module 'halflit' has no attribute {name!r}")
