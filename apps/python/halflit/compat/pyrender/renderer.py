"""pyrender's renderer into a context of OpenGL, and what an OffscreenRenderer has in its place."""
from __future__ import annotations

from typing import Any, Optional

from .constants import GLTF, RenderFlags, TextAlign
from .shader_program import ShaderProgramCache, shows_normals
from .viewer import Renderer


class Backend:
    """OffscreenRenderer._renderer. Scripts set its _program_cache to a cache of their own, which gives programs: see shader_program.py."""

    def __init__(self) -> None:
        self._program_cache: Any = ShaderProgramCache()

    def space_of_normals(self) -> Optional[str]:
        """"world" or "view" where the cache's program shows normals in that space; None: it is pyrender's own."""
        cache = self._program_cache
        if cache is None or isinstance(cache, ShaderProgramCache):
            return None
        return shows_normals(cache.get_program("mesh.vert", "mesh.frag", defines={}))


__all__ = ["GLTF", "RenderFlags", "Renderer", "TextAlign"]
