"""Views of the whole scene, by a name or by angles."""
from __future__ import annotations

import ctypes
import functools
from typing import Any, Dict, List, Optional, Sequence, Tuple

from . import _c
from ._camera import Camera
from ._errors import UsageError
from ._options import WHOLE_SCENE, number_text
from ._values import finite, real, shown, truth

#: Pixels of a picture without a size.
USUAL_SIZE = (1280, 720)


@functools.lru_cache(64)
def _check(arguments: str) -> None:
    _c.call("call_check", b"render", arguments.encode())


def check_view_of(options: Dict[Any, Any], size: Optional[Tuple[int, int]]) -> None:
    """Fails as the program does for the keywords of a view."""
    import json  # which takes a tenth of halflit's own import

    arguments = {name: options[name] for name in WHOLE_SCENE if options.get(name) is not None}
    for name in ("azimuth", "elevation", "zoom", "fov"):
        if name in arguments:
            arguments[name] = number_text(finite(arguments[name], name))
    if isinstance(arguments.get("view"), (tuple, list)):
        arguments["view"] = ",".join(number_text(finite(angle, "view")) for angle in arguments["view"])
    if options.get("camera") is not None:
        arguments["camera"] = options["camera"] if isinstance(options["camera"], (str, int)) else 0
    if size is not None:
        arguments["size"] = f"{size[0]}x{size[1]}"
    _check(json.dumps(arguments, default=shown))


def margins(fit: Any, size: Optional[Tuple[int, int]]) -> Tuple[float, float]:
    """Shares of half the picture that `fit` pixels are."""
    width, height = size or USUAL_SIZE
    if not 0 <= real(fit, "fit") < 1e6:
        raise UsageError(f"fit: expected a margin in pixels, found {shown(fit)}")
    return 2 * fit / width, 2 * fit / height


def has_parallel_rays(options: Dict[Any, Any]) -> bool:
    """The keyword orthographic."""
    return truth(options.get("orthographic") or False, "orthographic")


def view_struct(scene: Any, view: Any, size: Optional[Tuple[int, int]], options: Dict[str, Any]) -> Any:
    """A halflit_view: its angles by a name or by (azimuth, elevation), the rest by the keywords zoom, fov, orthographic and fit."""
    struct = _c.make("view")
    if isinstance(view, str):
        scene._call("view_by_name", _c.bytes_of(view, "view"), ctypes.byref(struct))
    elif isinstance(view, (tuple, list)) and len(view) == 2:
        struct.azimuth_deg, struct.elevation_deg = (finite(angle, "view") for angle in view)
    else:
        raise UsageError(f"view: expected a name such as 'front' or 'iso', or (azimuth, elevation) in degrees, found {shown(view)}")
    for name, member in (("zoom", "zoom"), ("fov", "fov_y_deg")):
        if options.get(name) is not None:
            struct.put(member, options[name], name)
    struct.orthographic = has_parallel_rays(options)
    fit = options.get("fit")
    struct.any_side = fit is None
    if fit is not None:
        struct.margin_x, struct.margin_y = margins(fit, size)
    return struct


def views_of(scene: Any, views: Sequence[Any], size: Optional[Tuple[int, int]], options: Dict[str, Any]) -> List[Camera]:
    """Cameras of one distance and scale."""
    check_view_of(options, size)
    width, height = size or USUAL_SIZE
    structs = [view_struct(scene, view, size, options) for view in views]
    view_type: Any = type(structs[0])
    given, made = (view_type * len(structs))(*structs), (_c.STRUCT["halflit_camera"] * len(structs))()
    for camera in made:
        _c.call("camera_init", ctypes.byref(camera), ctypes.sizeof(camera))
    scene._call("camera_views", ctypes.c_float(width / height).value, given, len(structs), made)
    return [Camera._of(type(made[0]).from_buffer_copy(camera)) for camera in made]
