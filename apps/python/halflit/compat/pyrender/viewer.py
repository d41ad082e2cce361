"""Classes that need a window, which is not here."""
from __future__ import annotations

from typing import Any


class Viewer:
    """pyrender's window. Here it says that there is none."""

    def __init__(self, *_: Any, **__: Any) -> None:
        raise NotImplementedError(f"{type(self).__name__}: halflit has no window: draw the scene by OffscreenRenderer")


class Renderer(Viewer):
    """pyrender's renderer into a context of OpenGL. Here it says that there is none."""
