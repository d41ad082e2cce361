"""One frame: what the keywords leave open is chosen, memory is made, the library draws. This module imports numpy."""
from __future__ import annotations

import ctypes
import math
import sys
import warnings

import numpy as np

from . import _c
from ._camera import Camera
from ._errors import UsageError
from ._execution import Execution
from ._options import AOVS, apply_settings, check_names, settings_dict
from ._picture import Picture
from ._records import chosen, fill
from ._scene import Setup

USUAL = (1280, 720)  # the program's size


def checked_size(size) -> tuple:
    if isinstance(size, (int, np.integer)):
        size = (size, size)
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        raise UsageError(f"size: expected (width, height) in pixels, or the side of a square, found {size!r}") from None
    if min(width, height) < 1 or width * height > 2**28:
        raise UsageError(f"size: expected 1 to 2^28 pixels, found {width} x {height}")
    return width, height


def shaped(camera: Camera) -> tuple:
    """The largest size with the camera's aspect ratio that fits into the usual one."""
    aspect = camera._shape()
    if not 1e-3 < aspect < 1e3:
        return USUAL
    fitted = min(float(USUAL[0]), USUAL[1] * aspect)
    return max(1, int(fitted + 0.5)), max(1, int(fitted / aspect + 0.5))


# ---- camera and light ----------------------------------------------------------------------------------------------------


def request_of(scene, options: dict):
    """The halflit_setup_options of the keywords, and the camera that it points to."""
    request, camera = _c.make("setup_options"), options.get("camera")
    whole = [name for name in ("azimuth", "elevation", "zoom", "fov") if options.get(name) is not None]
    if isinstance(camera, str) and camera == "frame":
        request.frame, camera = 1, None
    elif camera is not None:
        if whole:
            raise UsageError(f"camera: cannot be combined with {', '.join(whole)}, which make a camera of their own")
        if isinstance(camera, (str, int, np.integer)):
            camera = find_camera(scene, camera)
        else:
            camera = (camera if isinstance(camera, Camera) else Camera(camera)).placed(scene.origin, scene.scale)
        request.camera = ctypes.addressof(camera._c)
    if whole:
        request.frame = 1
    for name, member in (("azimuth", "azimuth_deg"), ("elevation", "elevation_deg"), ("zoom", "zoom"), ("fov", "fov_y_deg")):
        if name in whole:
            setattr(request, member, options[name])
    if options.get("exposure") is not None:
        if not options["exposure"] > 0:
            raise UsageError(f"exposure: expected a factor above 0, found {options['exposure']!r}")
        request.exposure = options["exposure"]
    # Lights that the caller adds get a share of the studio, as those of the program's --light.
    studio = options.get("studio") or ("under_lights" if scene._own_lights else "for_dark")
    if options.get("ambient") is not None:
        request.own_ambient, request.ambient_color = 1, fill(ctypes.c_float * 3, options["ambient"], "ambient")
        studio = options.get("studio") or "never"
    request.studio = chosen(studio, "STUDIO", "studio")
    request.studio_turn_rad = math.radians(options.get("studio_turn") or 0.0)
    return request, camera


def find_camera(scene, wanted) -> Camera:
    cameras = scene.cameras
    for camera in cameras:
        if camera.name == str(wanted):
            return camera
    if str(wanted).isdigit() and int(wanted) < len(cameras):
        return cameras[int(wanted)]
    raise UsageError(f"camera: expected a name or an index below {len(cameras)}, found {wanted!r}")


def set_up(scene, size: tuple, request, given) -> Setup:
    """Calls halflit_setup, unless the last call was the same."""
    key = (scene._changes, size, bytes(request)[8 + ctypes.sizeof(ctypes.c_void_p) :], bytes(given._c)[16:] if given else None)
    if scene._setup_key == key:
        return scene._last_setup
    camera, settings = Camera(), _c.make("settings")
    width, height = size
    scene._setup_key = None
    scene._call("setup", *size, ctypes.byref(request), ctypes.byref(camera._c), ctypes.byref(settings))
    scene._setup_key, scene._last_setup = key, Setup(camera, settings, (request, given), (width, height))
    scene._setup_light = scene._light_changes
    return scene._last_setup


def choose(scene, size, options: dict) -> Setup:
    check_names(options)
    request, given = request_of(scene, options)
    if size is not None:
        return set_up(scene, checked_size(size), request, given)
    setup = set_up(scene, USUAL, request, given)
    fitted = USUAL if request.frame else shaped(setup.camera)
    return setup if fitted == USUAL else set_up(scene, fitted, request, given)


def set_up_again(scene, size, options: dict) -> Setup:
    """The setup that the caller keeps. Its light is added again if another setup, or a change of light, took it back."""
    setup = options["setup"]
    if size is not None and checked_size(size) != setup.size:
        raise UsageError(f"setup: made for {setup.size[0]} x {setup.size[1]} pixels")
    if scene._setup_key is None or scene._last_setup._request is not setup._request:
        set_up(scene, setup.size, *setup._request)
        scene._last_setup = setup
    return setup


# ---- the frame -----------------------------------------------------------------------------------------------------------


def draw(scene, size, options: dict) -> Picture:
    check_names(options)
    if options.get("setup") is not None:
        setup = set_up_again(scene, size, options)
    else:
        setup = choose(scene, size, options)
    settings = type(setup._settings).from_buffer_copy(setup._settings)
    apply_settings(settings, options)
    if scene.scale != 1.0 and options.get("shadow_fade"):
        settings.shadow_fade = options["shadow_fade"] * scene.scale
    if options.get("setup") is not None and options.get("exposure") is not None:
        settings.exposure = options["exposure"]
    target, picture, planes = memory(setup.size, settings, options)
    report = _c.make("report", False)
    execution = Execution(options, scene._lock)
    renderer = renderer_of(scene, execution)
    try:
        arguments = (renderer, scene._handle, setup.camera._c, settings, target, report)
        with execution.calls():
            _c.call("render", *arguments[:2], *(ctypes.byref(struct) for struct in arguments[2:]))
    except Exception:
        if execution.raised is not None:
            raise execution.raised from None
        raise
    finally:
        if execution.has_functions:  # nothing may call them later
            scene._executed = None
            _c.call("renderer_set_execution", renderer, None)
    if execution.raised is not None:
        raise execution.raised
    place_back(scene, planes)
    picture.aovs, picture.camera, picture.settings = planes, setup.camera.copy(), settings_dict(settings)
    picture.report = {name: getattr(report, name) for name, _ in report._fields_ if name not in ("size", "reserved")}
    picture.report.update(isa=report.isa.decode(), error_within=bool(report.error_within))
    picture.report["warnings"] = scene.warnings + frame_warnings(renderer, report.warnings)
    tell(scene, picture.report["warnings"])
    return picture


def tell(scene, lines: list) -> None:
    """Shows each warning of a scene once, at the line of the caller that draws."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    for line in lines:
        if line not in scene._told:
            scene._told.add(line)
            warnings.warn(f"halflit: {line}", stacklevel=level)


def renderer_of(scene, execution: Execution):
    """The scene's renderer, which keeps what it computed, set to draw in this way."""
    if scene._renderer is None:
        scene._renderer = _c.Handle("renderer_create", "renderer_destroy", ctypes.byref(execution.struct))
    elif scene._executed != execution.key:
        _c.call("renderer_set_execution", scene._renderer, ctypes.byref(execution.struct))
    scene._executed = execution.key
    return scene._renderer


def frame_warnings(renderer, count: int) -> list:
    text, lines = ctypes.c_char_p(), []
    for i in range(count):
        _c.call("renderer_get_warning", renderer, i, ctypes.byref(text))
        lines.append(_c.text_of(text.value))
    return lines


def memory(size: tuple, settings, options: dict):
    """The halflit_target, the Picture and the planes that it points to."""
    width, height = size
    target = _c.make("target")
    target.width, target.height = size
    if options.get("region") is not None:
        x, y, width, height = (int(value) for value in options["region"])
        if min(x, y) < 0 or min(width, height) < 1 or x + width > size[0] or y + height > size[1]:
            raise UsageError(f"region: expected a part of the {size[0]} x {size[1]} picture, found {options['region']!r}")
        for name, value in zip(("x", "y", "width", "height"), (x, y, width, height)):
            setattr(settings.region, name, value)
        target.region_alone = 1
    asked = options.get("dtype")
    dtype = np.dtype((np.uint8 if asked is None else asked) if options.get("out") is None else options["out"].dtype)
    if dtype not in (np.uint8, np.float32) or (asked is not None and np.dtype(asked) != dtype):
        raise UsageError(f"dtype: expected uint8 or float32, and that of `out`, found {dtype}")
    format_name = "RGBA_F32" if dtype == np.float32 else "RGBA8"
    target.format = _c.CONSTANTS[f"HALFLIT_FORMAT_{format_name}{'_PREMULTIPLIED' if options.get('premultiplied') else ''}"]
    pixels = np.empty((height, width, 4), dtype) if options.get("out") is None else options["out"]
    if pixels.shape != (height, width, 4):
        raise UsageError(f"out: expected an array of shape {(height, width, 4)}, found {pixels.shape}")
    if pixels.strides[1:] != (4 * dtype.itemsize, dtype.itemsize) or pixels.strides[0] < width * 4 * dtype.itemsize:
        raise UsageError("out: expected pixels without gaps, rows one after another")
    if not pixels.flags.writeable or pixels.ctypes.data % dtype.itemsize:
        raise UsageError("out: expected memory that is writeable and aligned")
    target.pixels, target.row_bytes = pixels.ctypes.data, pixels.strides[0]
    planes = {}
    wanted = options.get("aovs") or ()
    for name in AOVS if wanted == "all" else (wanted,) if isinstance(wanted, str) else wanted:
        if name not in AOVS:
            raise UsageError(f"aovs: expected names of {', '.join(AOVS)}, found {name!r}")
        member, channels, kind = AOVS[name]
        planes[name] = np.empty((height, width) if channels == 1 else (height, width, channels), kind)
        setattr(target, member, planes[name].ctypes.data)
    return target, pixels.view(Picture), planes


def place_back(scene, planes: dict) -> None:
    """Depths and positions in the file's own world."""
    if scene.scale == 1.0 and not any(scene.origin):
        return
    if "depth" in planes:
        planes["depth"] *= np.float32(1 / scene.scale)  # infinity stays
    if "position" in planes:
        position = planes["position"]
        drawn = planes["depth"] < 3e38 if "depth" in planes else position.any(axis=2)
        position[drawn] = (position[drawn].astype(np.float64) / scene.scale + scene.origin).astype(np.float32)
