"""The module of pictures, which imports numpy: it is imported when a name of it is first used."""
from __future__ import annotations

from typing import TYPE_CHECKING

from ._lazy import LazyModule

__all__ = ["pictures"]

if TYPE_CHECKING:
    from . import _picture as pictures
else:
    pictures = LazyModule(__package__ + "._picture")
