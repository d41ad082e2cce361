"""Base of all parts of a scene: its handle, its lock, and the calls that change it."""
from __future__ import annotations

import ctypes
from typing import Any, Dict, List, Optional, Set, TypeVar

from . import _c
from ._errors import UsageError
from ._execution import SceneLock
from ._loading import sum_of

Self = TypeVar("Self", bound="SceneBase")

#: Attributes that a copy keeps.
_KEPT = ("_own_lights", "_plain", "_materials", "_smooth", "_own_materials", "_animated")


class SceneBase:
    """A scene of the library, and what Python remembers of it."""

    def _start(self, handle: _c.Handle) -> None:
        self._handle: Any = handle
        self._lock = SceneLock()
        self._mark = object()  # of this scene alone; its setups have it
        self._renderer: Any = None
        self._executed: Any = None  # Execution.key of the renderer
        self._changes = 0  # of anything that setup() looks at
        self._chosen: Any = None  # what was chosen for the last frame, and the key of what it was chosen for
        self._own_lights = False  # add_light() was called
        self._animated: Any = None  # source and keywords of load() with keep_animations, and sum_of() the source
        self._told: Set[Any] = set()  # warnings that were shown
        self._warnings: Optional[List[str]] = None  # of loading
        self._plain: Dict[bool, int] = {}  # materials of meshes that are given none, lit and unlit
        self._materials: Dict[int, int] = {}  # mesh that was added -> its material
        self._smooth: Set[Any] = set()  # meshes with normals="smooth"
        self._own_materials: Dict[int, int] = {}  # mesh -> material that was made for it alone

    @property
    def counts(self) -> Dict[str, int]:
        """Numbers of triangles (over all instances), meshes, instances, materials, textures, cameras, lights, warnings and animations."""
        found = _c.make("counts", False)
        self._call("scene_get_counts", ctypes.byref(found))
        return {name: getattr(found, name) for name, _ in found._fields_ if name not in ("size", "reserved")}

    @property
    def warnings(self) -> List[str]:
        """Parts that the loader could not draw, one line each."""
        if self._warnings is None:
            text, lines = ctypes.c_char_p(), []
            with self._lock:  # the texts are the scene's
                for i in range(self.counts["warnings"]):
                    self._call("scene_get_warning", i, ctypes.byref(text))
                    lines.append(_c.text_of(text.value))
            self._warnings = lines
        return list(self._warnings)

    def _call(self, name: str, *arguments: Any) -> None:
        with self._lock:
            self._check_open()
            _c.call(name, self._handle, *arguments)

    def _change(self, name: str, *arguments: Any) -> None:
        with self._lock:
            self._call(name, *arguments)
            self._changes += 1

    def _check_open(self) -> None:
        if self._handle is None:
            raise UsageError("the scene is closed")

    def close(self) -> None:
        """Frees the scene's memory at once; otherwise it is freed when nothing refers to the scene any more."""
        with self._lock:
            self._handle = self._renderer = None

    def __reduce_ex__(self, protocol: Any) -> Any:
        """A copy, or a pickle, is a scene of its own in the same state. Where it keeps animations, it loads its file again,
        which must not have changed."""
        taken: List[bytes] = []
        write = _c.Write(lambda user, bytes, count: taken.append(ctypes.string_at(bytes, count)))
        with self._lock:
            self._call("scene_save", write, None)
            kept = {name: getattr(self, name) for name in _KEPT}
            return _restored, (type(self), taken[0], self._animated, kept)

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._handle is None:
            return "<halflit.Scene, closed>"
        return f"<halflit.Scene of {', '.join(f'{n} {name}' for name, n in self.counts.items() if n)}>"


def _restored(kind: Any, data: bytes, animated: Any, kept: Dict[str, Any]) -> Any:
    if animated is not None and sum_of(animated[0]) != animated[2]:
        raise UsageError(f"{animated[0]}: changed since the scene with its animations was loaded")
    scene = kind() if animated is None else kind.load(animated[0], **animated[1])
    scene._change("scene_restore", data, len(data))
    for name, value in kept.items():
        setattr(scene, name, value)
    scene._warnings = None
    return scene
