"""halflit: models in, pictures out, on the CPU.

    import halflit
    picture = halflit.render("model.glb", size=(512, 512))    # a numpy array, uint8 (512, 512, 4); notebooks show it
    picture.save("model.png")

render() draws a file, its bytes, arrays, a trimesh or a Scene. Scene is for what render() does not know in one call: several meshes,
instances, textures, lights, many pictures. Lengths are world units, angles in degrees unless a name ends in _rad, times in seconds.
"""
from __future__ import annotations

from . import _c
from ._camera import Camera
from ._errors import BadInputError, CancelledError, Error, FileError, LimitError, UsageError
from ._options import AOVS
from ._records import Light, Lobe, Material, TextureUse
from ._render import render
from ._scene import Scene, Setup

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ._picture import Picture as Picture
    from ._picture_options import PictureOptions as PictureOptions

__version__ = _c.VERSION
__all__ = (
    "AOVS BadInputError Camera CancelledError Error FileError Light LimitError Lobe Material Picture"
    " PictureOptions Scene Setup TextureUse UsageError pixel_epoch render version"
).split()


def version() -> str:
    """Version of the library, as "0.1.0"."""
    return _c.function("version")().decode()


def pixel_epoch() -> int:
    """Libraries of equal pixel epoch give equal pixels."""
    return _c.function("pixel_epoch")()


def __getattr__(name: str) -> Any:
    # Picture is a numpy array, and numpy takes longer to import than all else. PictureOptions needs typing.
    if name == "Picture":
        from ._picture import Picture

        return Picture
    if name == "PictureOptions":
        from ._picture_options import PictureOptions

        return PictureOptions
    raise AttributeError(f"module 'halflit' has no attribute {name!r}")
