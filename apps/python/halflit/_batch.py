"""Many pictures: frames drawn ahead, arrays of frames, many small meshes. This module imports numpy."""
from __future__ import annotations

import os
import threading
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Deque, Dict, Iterable, Iterator, List, Tuple, TypeVar

import numpy as np

from ._errors import UsageError
from ._execution import draws_for_main
from ._frame import draw_setup, frames, view_of
from ._options import KNOWN, VIEW, check_names
from ._picture import Picture
from ._scene import Scene
from ._setup import Setup, checked_size, choose
from ._target import names_of
from ._types import Array
from ._values import shown, whole

T = TypeVar("T")


def drawn_ahead(pictures: Iterator[T], count: int) -> Iterator[T]:
    """The same pictures; up to `count` are drawn in a thread while the caller uses the last one."""
    nothing = object()
    pool = ThreadPoolExecutor(1, "halflit", draws_for_main)
    waiting: Deque[Future[Any]] = deque()
    try:
        while True:
            while len(waiting) <= count:
                waiting.append(pool.submit(lambda: next(pictures, nothing)))
            picture = waiting.popleft().result()
            if picture is nothing:
                return
            yield picture
    finally:
        for future in waiting:
            future.cancel()
        pool.shutdown(wait=True)


def draw_arrays(scene: Scene, cameras: List[Any], size: Any, light: str, options: Dict[str, Any]) -> Dict[str, Array]:
    """The arrays of Scene.render_arrays()."""
    refused = ("camera", "azimuth", "elevation", "view", "fit", "setup", "out")
    check_names(options, [name for name in KNOWN if name not in refused], "render_arrays")
    if light not in ("fixed", "viewer"):
        raise UsageError(f"light: expected 'fixed' or 'viewer', found {shown(light)}")
    if not cameras:
        raise UsageError("cameras: expected one or more")
    asked, found = names_of(options), {}
    for i, picture in enumerate(frames(scene, [view_of(camera) for camera in cameras], size, light == "fixed", options)):
        if i == 0:
            found = {"color": np.empty((len(cameras), *picture.shape), picture.dtype)}
            found.update((name, np.empty((len(cameras), *picture.aovs[name].shape), picture.aovs[name].dtype)) for name in asked)
        if picture.shape != found["color"].shape[1:]:
            raise UsageError(f"size: expected one for all cameras, as camera {i} has a picture of {picture.shape[1]} x {picture.shape[0]}")
        found["color"][i] = picture
        for name in asked:
            found[name][i] = picture.aovs[name]
    return found


class _MeshDrawer:
    """A scene that has one mesh after another, by the light and exposure of the first: nothing but the mesh is prepared anew."""

    #: Keywords that Scene.frame() knows.
    QUICK = ("azimuth", "elevation", "zoom")

    def __init__(self, size: Tuple[int, int], material: Any, options: Dict[str, Any]) -> None:
        self.scene, self.size, self.material, self.options = Scene(), size, material, options
        self.is_quick = all(name in self.QUICK for name in VIEW if options.get(name) is not None and name not in ("exposure", "ev"))
        self.view = {name: options[name] for name in self.QUICK if options.get(name) is not None}
        self.first: Any = None  # the Setup of the first mesh

    def draw(self, mesh: Any) -> Picture:
        arrays: Dict[str, Any] = dict(mesh) if isinstance(mesh, dict) else dict(zip(("vertices", "faces"), mesh))
        scene = self.scene
        if self.first is None:
            scene.add_mesh(**arrays, material=self.material)
            self.first = choose(scene, self.size, self.options)
            return draw_setup(scene, self.first, self.options)
        scene.set_mesh(0, **arrays)
        if self.is_quick:
            camera = scene.frame(self.size[0] / self.size[1], **self.view)
        else:
            camera = choose(scene, self.size, self.options).camera
        setup: Setup = self.first._seen_by(camera)
        return draw_setup(scene, setup, self.options)


def draw_meshes(meshes: Iterable[Any], size: Any, material: Any, options: Dict[str, Any]) -> Iterator[Picture]:
    """The pictures of halflit.render_meshes(), in order."""
    check_names(options, [name for name in KNOWN if name not in ("camera", "setup", "out")], "render_meshes")
    threads = whole(options.get("threads") or 0, "threads", 0, 4096)
    if threads == 0:
        threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return _drawn_meshes(meshes, checked_size(size), threads, material, {**options, "threads": 1})


def _drawn_meshes(meshes: Iterable[Any], size: Any, threads: int, material: Any, options: Dict[str, Any]) -> Iterator[Picture]:
    own = threading.local()

    def draw(mesh: Any) -> Picture:
        if not hasattr(own, "drawer"):
            own.drawer = _MeshDrawer(size, material, options)
        picture: Picture = own.drawer.draw(mesh)
        return picture

    pool = ThreadPoolExecutor(threads, "halflit", draws_for_main)
    waiting: Deque[Future[Picture]] = deque()
    try:
        for mesh in meshes:
            waiting.append(pool.submit(draw, mesh))
            if len(waiting) > 4 * threads:  # enough for all threads, and no more memory than that
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
        pool.shutdown(wait=True)
