"""One frame. This module imports numpy."""
from __future__ import annotations

import ctypes
import html
from typing import Any, Dict, Iterator, List

import numpy as np

from . import _c
from ._errors import UsageError, warn
from ._execution import Execution
from ._options import KNOWN, VIEW, apply_settings, check_names
from ._picture import Picture
from ._setup import Setup, choose, exposure_of, given_camera, kept
from ._target import Target
from ._values import checked_size, real, shown
from ._views import USUAL_SIZE, views_of


_QUALITIES = {"fast": (2, 99), "draft": (8, 95)}
_MEASURED = ("samples", "anisotropy", "shadow_size")


class Views(Dict[Any, Picture]):
    """Pictures by their views, which notebooks show side by side."""

    def _repr_html_(self) -> str:
        figure = '<figure style="display:inline-block; margin:4px"><figcaption>{}</figcaption>{}</figure>'
        names = {view: view if isinstance(view, str) else "{:g}°, {:g}°".format(*view) for view in self}
        return "".join(figure.format(html.escape(names[view]), picture._repr_html_()) for view, picture in self.items())


def draw(scene: Any, size: Any, options: Dict[Any, Any]) -> Picture:
    """The frame that the keywords ask for. The scene is locked."""
    check_names(options)
    return draw_setup(scene, (choose if options.get("setup") is None else kept)(scene, size, options), options)


def draw_batch(scene: Any, cameras: List[Any], size: Any, light: str, options: Dict[Any, Any]) -> Iterator[Picture]:
    """A picture for each camera, drawn when it is asked for. The scene is locked meanwhile."""
    check_names(options, [name for name in KNOWN if name not in ("camera", "azimuth", "elevation", "view", "fit", "setup", "out")], "render_batch")
    if light not in ("fixed", "viewer"):
        raise UsageError(f"light: expected 'fixed' or 'viewer', found {shown(light)}")
    views = [view_of(camera) for camera in cameras]
    return frames(scene, views, size, light == "fixed", options)


def frames(scene: Any, views: List[Any], size: Any, is_fixed: bool, options: Dict[Any, Any]) -> Iterator[Picture]:
    """The pictures of render_batch(). All have the size, and if is_fixed the light and exposure, of the first."""
    first = None
    for view in views:
        with scene._lock:
            given = view.get("camera")
            if first is not None and is_fixed and given is not None and not isinstance(given, (str, int, np.integer)):
                setup = first._seen_by(given_camera(given).copy())
            else:
                setup = choose(scene, size, {**options, **view})
                if first is not None and is_fixed:
                    setup = first._seen_by(setup.camera)
            if first is None:
                first, size = setup, setup.size
            picture = draw_setup(scene, setup, options)
        yield picture


def draw_views(scene: Any, views: List[Any], size: Any, light: str, options: Dict[Any, Any]) -> Dict[Any, Picture]:
    """The pictures of render_views(), by their views."""
    names = [tuple(view) if isinstance(view, list) else view for view in views]
    return Views(zip(names, view_frames(scene, views, size, light, options)))


def view_frames(scene: Any, views: List[Any], size: Any, light: str, options: Dict[Any, Any]) -> Iterator[Picture]:
    """The same, each drawn when it is asked for."""
    lens = {name: options.pop(name) for name in ("zoom", "fov", "orthographic", "fit") if name in options}
    check_names(options, [name for name in KNOWN if name not in (*VIEW[: VIEW.index("exposure")], "out")], "render_views")
    if not views:
        raise UsageError("views: expected one or more")
    size = USUAL_SIZE if size is None else checked_size(size)
    with scene._lock:
        cameras = views_of(scene, views, size, lens)
    return draw_batch(scene, cameras, size, light, options)


def view_of(camera: Any) -> Dict[str, Any]:
    """The keywords of render() for an entry of render_batch(cameras)."""
    if isinstance(camera, (tuple, list)) and len(camera) == 2:
        return {"azimuth": real(camera[0], "azimuth"), "elevation": real(camera[1], "elevation")}
    return {"camera": camera}


def draw_setup(scene: Any, setup: Setup, options: Dict[Any, Any]) -> Picture:
    """The frame of a setup."""
    settings = settings_of(scene, setup, options)
    target = Target(setup.size, settings, options)
    report = frame(scene, setup, settings, target, Execution(options, scene._lock))
    picture = target.picture
    picture.camera, picture.report = setup.camera, report
    picture.aovs = target.derive(scene, picture.camera, settings.region)
    picture._settings = settings
    for line in report["warnings"]:
        if line not in scene._told:  # each once
            scene._told.add(line)
            warn(line)
    return picture


def measure(scene: Any, size: Any, quality: Any, known: Any, options: Dict[Any, Any]) -> Dict[str, Any]:
    """Result of halflit_measure for the view. The scene is locked."""
    check_names(options, function="measure")
    setup = (choose if options.get("setup") is None else kept)(scene, size, options)
    settings = settings_of(scene, setup, options)
    budget = _QUALITIES.get(quality, quality) if isinstance(quality, str) else quality
    if isinstance(budget, str) or not isinstance(budget, (tuple, list)) or len(budget) != 2:
        raise UsageError(f"quality: expected 'fast', 'draft', or (codes, percent), found {quality!r}")
    measured = _c.make("measured")
    measured.codes, measured.asked_percent = (real(x, "quality") for x in budget)
    if known is not None:
        try:
            if tuple(known["asked"]) != (measured.codes, measured.asked_percent):
                raise UsageError(f"known: expected what was measured for {quality!r}, found that for {tuple(known['asked'])}")
            for name in ("percent", "probes", "outside"):
                setattr(measured, name, known[name])
            for name in _MEASURED:
                setattr(measured, name, known["settings"][name])
        except (KeyError, TypeError) as error:
            raise UsageError("known: expected what measure() returned") from error
    execution = Execution(options, scene._lock)
    with execution.calls():
        structs = map(ctypes.byref, (setup._camera._c, settings))
        _c.call("measure", renderer_of(scene, execution), scene._handle, setup._lighting, *structs, *setup.size, ctypes.byref(measured))
    found: Dict[str, Any] = {name: getattr(measured, name) for name in ("percent", "probes", "outside")}
    found["asked"] = (measured.codes, measured.asked_percent)
    found["settings"] = {name: getattr(measured, name) for name in _MEASURED}
    return found


def settings_of(scene: Any, setup: Setup, options: Dict[Any, Any]) -> Any:
    """The halflit_settings: those of the setup, and what the keywords say."""
    settings = type(setup._settings).from_buffer_copy(setup._settings)
    apply_settings(settings, options)
    exposure, compensation_ev = exposure_of(options)
    if options.get("setup") is not None:
        settings.exposure = (settings.exposure if exposure is None else exposure) * 2.0**compensation_ev
    return settings


def frame(scene: Any, setup: Setup, settings: Any, target: Target, execution: Execution) -> Dict[str, Any]:
    """Draws into the target, and returns the report."""
    report = _c.make("report", False)
    renderer = renderer_of(scene, execution)
    structs = (setup._camera._c, settings, target.struct, report)
    try:
        with execution.calls():
            _c.call("render", renderer, scene._handle, setup._lighting, *map(ctypes.byref, structs))
    except Exception:
        if execution.raised is not None:
            raise execution.raised from None
        raise
    finally:
        if execution.has_callbacks:  # nothing may call them later
            scene._executed = None
            _c.call("renderer_set_execution", renderer, None)
    if execution.raised is not None:
        raise execution.raised
    found = {name: getattr(report, name) for name, _ in report._fields_ if name not in ("size", "reserved")}
    found.update(isa=report.isa.decode(), error_within=bool(report.error_within))
    found["warnings"] = scene.warnings + frame_warnings(renderer, report.warnings)
    return found


def renderer_of(scene: Any, execution: Execution) -> Any:
    """The scene's renderer, which keeps what it computed, set to draw in this way."""
    if scene._renderer is None:
        scene._renderer = _c.Handle("renderer_create", "renderer_destroy", ctypes.byref(execution.struct))
    elif scene._executed != execution.key:
        _c.call("renderer_set_execution", scene._renderer, ctypes.byref(execution.struct))
    scene._executed = execution.key
    return scene._renderer


def frame_warnings(renderer: Any, count: int) -> List[Any]:
    text, lines = ctypes.c_char_p(), []
    for i in range(count):
        _c.call("renderer_get_warning", renderer, i, ctypes.byref(text))
        lines.append(_c.text_of(text.value))
    return lines
