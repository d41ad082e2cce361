"""The camera of MuJoCo over halflit: the pictures of MuJoCo's classic renderer, without OpenGL, EGL, OSMesa and a display.

    import halflit.compat.mujoco
    halflit.compat.mujoco.install()          # mujoco.Renderer, Gymnasium's and robosuite's renderers draw by halflit

or, beside an unchanged `mujoco`,

    from halflit.compat.mujoco import Renderer          # in place of mujoco.Renderer

GLContext, MjrContext, MjrRect and the functions mjr_... have the names and arguments of the module `mujoco`. Simulation and mjvScene stay
MuJoCo's: their arrays are read where they are, of versions 2.2.2 to 3.12. render_batch() draws many scenes at once. docs/mujoco.md says
which pictures are equal, and to what.

What differs:
    Texts, figures, rectangles, labels, wireframes, frame borders, stereo and auxiliary buffers are not drawn.
    There is one buffer, without a size: mjFB_WINDOW and mjFB_OFFSCREEN mean the same, and no window shows it.
    A picture is drawn when it is read, from a copy of the scene that mjr_render() took.
    Samples: 1, or 4 in place of any other number.
"""
from ._context import (
    GLContext, MjrContext, MjrRect, mjr_addAux, mjr_blitAux, mjr_blitBuffer, mjr_changeFont, mjr_drawPixels, mjr_figure, mjr_findRect,
    mjr_finish, mjr_getError, mjr_label, mjr_maxViewport, mjr_overlay, mjr_readPixels, mjr_rectangle, mjr_render, mjr_resizeOffscreen,
    mjr_restoreBuffer, mjr_setAux, mjr_setBuffer, mjr_text, mjr_uploadHField, mjr_uploadMesh, mjr_uploadTexture, mjtDepthMap, mjtFont,
    mjtFontScale, mjtFramebuffer, mjtGridPos,
)  # fmt: skip
from ._install import install, uninstall
from ._renderer import Renderer, render_batch

__all__ = [
    *("GLContext", "MjrContext", "MjrRect", "Renderer", "install", "render_batch", "uninstall", "mjr_addAux", "mjr_blitAux"),
    *("mjr_blitBuffer", "mjr_changeFont", "mjr_drawPixels", "mjr_figure", "mjr_findRect", "mjr_finish", "mjr_getError"),
    *("mjr_label", "mjr_maxViewport", "mjr_overlay", "mjr_readPixels", "mjr_rectangle", "mjr_render", "mjr_resizeOffscreen"),
    *("mjr_restoreBuffer", "mjr_setAux", "mjr_setBuffer", "mjr_text", "mjr_uploadHField", "mjr_uploadMesh"),
    *("mjr_uploadTexture", "mjtDepthMap", "mjtFont", "mjtFontScale", "mjtFramebuffer", "mjtGridPos"),
]
