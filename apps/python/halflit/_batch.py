"""Many pictures: frames drawn ahead, arrays of frames, many small meshes. This module imports numpy."""
from __future__ import annotations

import os
import threading
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Callable, Deque, Dict, Iterable, Iterator, List, Tuple, TypeVar

import numpy as np

from ._errors import CancelledError, UsageError
from ._frame import draw_setup, frames, view_of
from ._geometry import plain_material
from ._mesh import is_unlit
from ._options import KNOWN, check_names
from ._picture import Picture
from ._setup import choose
from ._splats import Splats
from ._target import names_of
from ._threads import begins_helper
from ._types import Array
from ._values import checked_size, shown, whole

T = TypeVar("T")


def drawn_ahead(pictures: Iterator[T], count: int) -> Iterator[T]:
    """The same pictures; up to `count` are drawn in a thread while the caller uses the last one."""
    nothing = object()
    pool = ThreadPoolExecutor(1, "halflit", begins_helper())
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


def draw_arrays(scene: Any, cameras: List[Any], size: Any, light: str, options: Dict[str, Any]) -> Dict[str, Array]:
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
    """A scene that has one mesh after another. Each is set up as render() does, so that no picture depends on the mesh before. The renderer
    keeps what does not depend on the mesh."""

    def __init__(self, scene: Any, size: Tuple[int, int], material: Any, options: Dict[str, Any]) -> None:
        self.scene, self.size, self.material, self.options = scene, size, material, options
        self.plain: Any = None  # whether the last mesh had the plain material, lit (False) or unlit
        self.is_placed = False  # by a matrix of its own

    def draw(self, mesh: Any, index: int) -> Picture:
        arrays = _arguments(mesh, index)
        try:
            self._take(arrays)
        except UsageError as error:
            raise UsageError(f"mesh {index}: {error}") from None
        return draw_setup(self.scene, choose(self.scene, self.size, self.options), self.options)

    def _take(self, arrays: Dict[str, Any]) -> None:
        """The mesh is that of the scene from now on."""
        matrix, scene = arrays.pop("matrix", None), self.scene
        is_first = not scene.counts["instances"]
        material, plain = (self.material if is_first else None), None
        if self.material is None:
            plain = is_unlit(arrays["vertices"], arrays.get("topology", "triangles"), arrays.get("normals"))
            material = None if plain == self.plain else plain_material(plain)
        if is_first:
            scene.add_mesh(**arrays, material=material, matrix=matrix)
        else:
            scene.set_mesh(0, **arrays, material=material)
            if matrix is not None or self.is_placed:
                scene.set_instance(0, np.eye(4) if matrix is None else matrix)
        self.plain, self.is_placed = plain, matrix is not None


#: Arguments of Scene.add_mesh() that a mesh of render_meshes() has.
_OF_A_MESH = ("vertices", "faces", "normals", "uv", "uv1", "colors", "colors_space", "tangents", "topology", "name", "matrix")


def _arguments(mesh: Any, index: int) -> Dict[str, Any]:
    """The arguments of Scene.add_mesh() that an entry of render_meshes(meshes) is."""
    if isinstance(mesh, Splats):
        return {"vertices": mesh}
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return dict(zip(_OF_A_MESH, mesh))
    if not isinstance(mesh, dict):
        raise UsageError(f"mesh {index}: expected (vertices, faces), Splats or a dict of arguments of add_mesh(), found {shown(mesh)}")
    for name in mesh:
        if name not in _OF_A_MESH:
            raise TypeError(f"mesh {index}: has no {name!r} of its own")
    if mesh.get("vertices") is None:
        raise UsageError(f"mesh {index}: expected vertices")
    return dict(mesh)


def draw_meshes(
    make_scene: Callable[[], Any], meshes: Iterable[Any], size: Any, material: Any, options: Dict[str, Any]
) -> Iterator[Picture]:
    """The pictures of halflit.render_meshes(), in order. Each thread has a scene of its own."""
    check_names(options, [name for name in KNOWN if name not in ("camera", "setup", "out")], "render_meshes")
    threads = whole(options.get("threads") or 0, "threads", 0, 4096)
    if threads == 0:
        threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return _drawn_meshes(make_scene, meshes, checked_size(size), threads, material, {**options, "threads": 1})


def _drawn_meshes(
    make_scene: Callable[[], Any], meshes: Iterable[Any], size: Any, threads: int, material: Any, options: Dict[str, Any]
) -> Iterator[Picture]:
    own, stopped = threading.local(), threading.Event()

    def draw(mesh: Any, index: int) -> Picture:
        if stopped.is_set():
            raise CancelledError("a picture before was stopped")
        if not hasattr(own, "drawer"):
            own.drawer = _MeshDrawer(make_scene(), size, material, options)
        try:
            picture: Picture = own.drawer.draw(mesh, index)
        except CancelledError:  # by Ctrl-C, whose exception the main thread may not have seen yet
            stopped.set()
            raise
        return picture

    pool = ThreadPoolExecutor(threads, "halflit", begins_helper())
    waiting: Deque[Future[Picture]] = deque()
    try:
        for index, mesh in enumerate(meshes):
            waiting.append(pool.submit(draw, mesh, index))
            if len(waiting) > 4 * threads:  # enough for all threads, and no more memory than that
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
        pool.shutdown(wait=True)
