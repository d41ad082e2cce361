"""trimesh.Scene.save_image() without a window.

    import trimesh
    import halflit.trimesh

    halflit.trimesh.register()
    png = trimesh.load("model.glb", force="scene").save_image(resolution=(640, 480))

register() lets the scenes of trimesh be drawn by halflit, unregister() lets them be drawn by trimesh's viewer again. save_image() here
draws one scene.
"""
from __future__ import annotations

import importlib
import math
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._camera import Camera
from ._errors import UsageError, warn
from ._members import CameraMembers
from ._picture_options import PictureOptions
from ._scene import Scene
from ._trimesh import add, up_of

#: Keywords of trimesh's viewer that decide nothing in a picture without a window.
_OF_WINDOWS = frozenset(
    "visible start_loop callback callback_period caption fixed offset_lines window_conf profile record fullscreen resizable vsync display"
    " screen style".split()
)
#: save_image() of trimesh.Scene as it was before register().
_original: Any = None


def register() -> None:
    """Draws the scenes of trimesh by halflit: trimesh.Scene.save_image() is save_image() here. A second call changes nothing."""
    global _original
    kind = importlib.import_module("trimesh").Scene
    if _original is None:
        _original = kind.save_image
        kind.save_image = save_image


def unregister() -> None:
    """Undoes register()."""
    global _original
    if _original is not None:
        importlib.import_module("trimesh").Scene.save_image = _original
        _original = None


def save_image(scene: Any, resolution: Any = None, background: Any = None, **keywords: Any) -> bytes:
    """A picture of a trimesh.Scene by its camera, as the bytes of a PNG, which has alpha if not all pixels are opaque.

    resolution: width and height in pixels, which become those of scene.camera, as in trimesh; None: those of scene.camera. background:
    (3,) or (4,), bytes or floats (white). Lights that were set as scene.lights shine from where they are, as bright at any distance, as in
    trimesh's viewer; without them light is chosen as in halflit.render(). smooth: False: triangles are flat. line_settings: line_width and
    point_size, pixels. Of the viewer's flags, axis, grid and wireframe are warned of, as they are not drawn. Its other keywords, such as
    visible, are taken and decide nothing.
    """
    smooth, sizes = bool(keywords.pop("smooth", True)), keywords.pop("line_settings", None) or {}
    undrawn = [name for name in ("wireframe", "axis", "grid") if (keywords.get("flags") or {}).get(name)]
    if undrawn:
        warn(f"flags: {', '.join(undrawn)} not drawn")
    unknown = [name for name in keywords if name not in _OF_WINDOWS and name != "flags"]
    if unknown:
        raise TypeError(f"save_image() has no keyword {unknown[0]!r}")
    if resolution is not None:
        scene.camera.resolution = resolution
    size = tuple(int(side) for side in scene.camera.resolution)
    made = Scene(up_of(scene))
    add(made, scene, smooth)
    _add_lights(made, scene)
    options: PictureOptions = {"camera": _camera(scene), "background": _codes(background), "contact_shadow": 0}
    if "line_width" in sizes:
        options["line_width"] = float(sizes["line_width"])
    if "point_size" in sizes:
        options["point_size"] = float(sizes["point_size"])
    pixels = made.render((size[0], size[1]), **options)
    return pixels.to_png()


def _camera(scene: Any) -> Camera:
    given = scene.camera
    members: CameraMembers = {"fov_y_rad": math.radians(float(given.fov[1]))}
    if getattr(given, "z_near", None) is not None:
        members["near_z"] = float(given.z_near)
    if getattr(given, "z_far", None) is not None:
        members["far_z"] = float(given.z_far)
    return Camera(np.asarray(scene.camera_transform, np.float64), **members)


def _codes(background: Any) -> npt.NDArray[np.uint8]:
    """sRGB codes and alpha of a background."""
    if background is None:
        return np.full(4, 255, np.uint8)
    array = np.asarray(background)
    if array.shape not in ((3,), (4,)) or array.dtype.kind not in "fiu":
        raise UsageError(f"background: expected 3 or 4 numbers, found {background!r}")
    shown = np.clip(np.rint(array * 255.0 if array.dtype.kind == "f" else array), 0, 255)
    codes: npt.NDArray[np.uint8] = shown.astype(np.uint8)
    return codes if len(codes) == 4 else np.append(codes, np.uint8(255))


def _add_lights(made: Scene, scene: Any) -> None:
    given: Optional[Any] = getattr(scene, "_lights", None)  # scene.lights would make some
    bounds = made.bounds
    if not given or bounds is None:
        return
    centre = bounds.mean(axis=0)
    for light in given:
        matrix = np.asarray(scene.graph[light.name][0], np.float64)
        color = np.asarray(light.color)
        shares: Any = (color / 255.0 if color.dtype.kind in "iu" else color)[:3]
        way: Any = -matrix[:3, 2] if "Directional" in type(light).__name__ else centre - matrix[:3, 3]
        if np.linalg.norm(way) > 0:
            made.add_light("directional", color=shares.tolist(), direction=way.tolist())
