"""Puts the functions that draw into the module `mujoco`."""
from __future__ import annotations

import importlib
import sys
import types
from typing import Any, List, Optional, Tuple

from . import _context
from ._context import Defaults, GLContext
from ._models import checked_threads, look_of
from ._renderer import Renderer

#: Modules that give a class GLContext by that name, or another. Those of robosuite would import OpenGL.
_MODULES = (
    *(f"mujoco.{name}" for name in ("egl", "osmesa", "glfw", "cgl", "gl_context", "rendering.classic.gl_context")),
    "robosuite.renderers.context.egl_context",
)
_CLASSES = ("GLContext", "EGLGLContext")
_ENUMS = ("mjtFramebuffer", "mjtDepthMap", "mjtFont", "mjtFontScale", "mjtGridPos")
_MISSING = object()
_before: List[Tuple[Any, str, Any]] = []


def _put(owner: Any, name: str, value: Any) -> None:
    if isinstance(owner, dict):
        _before.append((owner, name, owner.get(name, _MISSING)))
        owner[name] = value
    else:
        _before.append((owner, name, getattr(owner, name, _MISSING)))
        setattr(owner, name, value)


def install(*, look: Optional[str] = None, threads: int = 0) -> None:
    """From now on `mujoco` draws by halflit: MjrContext, MjrRect, GLContext and the functions mjr_... of the module are those of this
    package, until uninstall(). So mujoco.Renderer, Gymnasium's renderers and robosuite's draw without OpenGL, whatever MUJOCO_GL says. What
    was imported from `mujoco` by name before stays.

    look: the release whose pictures are made, "2.2" or later; None: by mujoco's own version. threads: 0: all cores.
    """
    look_of(look, (3,))
    checked_threads(threads)
    mujoco = importlib.import_module("mujoco")
    uninstall()
    Defaults.look, Defaults.threads = look, threads
    for owner in (mujoco, getattr(mujoco, "_render", mujoco)):  # the second is what mujoco.Renderer asks
        for name, value in vars(_context).items():
            if name.startswith("mjr_") or name in ("MjrContext", "MjrRect", "GLContext"):
                _put(owner, name, value)
    for owner in (mujoco, getattr(mujoco, "_enums", mujoco)):
        for name in _ENUMS:
            if not hasattr(owner, name):
                _put(owner, name, getattr(_context, name))
    if not hasattr(mujoco, "Renderer"):
        _put(mujoco, "Renderer", Renderer)
    for path in _MODULES:
        parent, _, name = path.rpartition(".")
        module = sys.modules.get(path)
        if module is None or not path.endswith("gl_context"):
            module = types.ModuleType(path, "A module of halflit.compat.mujoco, without OpenGL.")
            _put(sys.modules, path, module)
            if parent in sys.modules:
                _put(sys.modules[parent], name, module)
        for name in _CLASSES:
            _put(module, name, GLContext)


def uninstall() -> None:
    """Undoes install(). Contexts that were made draw by halflit still."""
    Defaults.look, Defaults.threads = None, 0
    while _before:
        owner, name, value = _before.pop()
        if isinstance(owner, dict):
            owner.pop(name) if value is _MISSING else owner.update({name: value})
        elif value is _MISSING:
            delattr(owner, name)
        else:
            setattr(owner, name, value)
