"""Answers of the program's commands: look, compare, explain, measure, section, certify, info. The engine reads the arguments."""
from __future__ import annotations

import ctypes
import os
from typing import Any, Dict, List, Optional

from . import _c
from ._lazy import np
from ._lazy_picture import pictures  # noqa: F401  (in annotations)
from ._scene import Scene
from ._values import shown


class Answer:
    """The answer of a call. `answer["measures"]` is `answer.report["measures"]`."""

    report: Dict[str, Any]  #: as docs/report.md has it
    notes: List[str]  #: lines for people: faults first
    good: bool  #: False: a view with a fault, versions that differ, a blank picture
    picture: Optional[pictures.Picture]  #: uint8 (height, width, 4); None where the call draws none

    def __init__(self, handle: _c.Handle) -> None:
        import json  # which takes a tenth of halflit's own import

        self.report = json.loads(_c.function("answer_report")(handle).decode())
        self.notes = _c.text_of(_c.function("answer_notes")(handle)).splitlines()
        self.good = bool(_c.function("answer_is_good")(handle))
        size = (ctypes.c_int32 * 2)()
        width = ctypes.addressof(size)
        pixels = _c.function("answer_picture")(handle, width, width + ctypes.sizeof(ctypes.c_int32))
        self.picture = None
        if pixels:
            from ._picture import Picture

            data = ctypes.string_at(pixels, 4 * size[0] * size[1])
            self.picture = np.frombuffer(data, np.uint8).reshape(size[1], size[0], 4).copy().view(Picture)

    def __getitem__(self, name: str) -> Any:
        return self.report[name]

    def __repr__(self) -> str:
        return f"<halflit.Answer, {'good' if self.good else 'not good'}: {'; '.join(self.notes[:2]) or ', '.join(self.report)}>"

    def _repr_png_(self) -> Optional[bytes]:
        return None if self.picture is None else self.picture._repr_png_()


def _plain(value: Any) -> Any:
    """A value for JSON."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"arguments: expected texts, numbers and lists of them, found {shown(value)}")


def call(name: str, source: Any = None, /, **arguments: Any) -> Answer:
    """Makes one of the engine's calls by its name: look, render, measure, section, compare, explain, certify or info.

    source: what halflit.render() takes: a path, a file's bytes, (vertices, faces), a trimesh, a Scene. arguments: the flags of the program's
    command, with underscores for hyphens, and with the values that the program takes: call("look", "part.stl", view=["front", "iso"],
    size=(640, 480), hidden_edges="dashed").
    """
    if isinstance(source, (str, os.PathLike)):
        arguments["path"] = os.fspath(source)
        return _answer(name, arguments, None)
    if source is None or isinstance(source, Scene):
        return _answer(name, arguments, source)
    from ._render import scene_of

    made = scene_of(source, {"load": None}, arguments.pop("up", None))
    try:
        return _answer(name, arguments, made)
    finally:
        made.close()


def _answer(name: str, arguments: Dict[str, Any], scene: Optional[Scene]) -> Answer:
    import json

    if scene is not None:
        scene._check_open()
    text = json.dumps(arguments, default=_plain).encode()
    return Answer(_c.Handle("call", "answer_destroy", name.encode(), text, None if scene is None else scene._handle))


def look(source: Any, **arguments: Any) -> Answer:
    """Labelled views of a model on one sheet, and what each view shows of each part: `halflit look`."""
    return call("look", source, **arguments)


def section(source: Any, section: Any, **arguments: Any) -> Answer:
    """Cuts a model by planes such as "x=50%": the areas of the cuts, and a sheet of views of what is left."""
    return call("section", source, section=section, **arguments)


def certify(source: Any, **arguments: Any) -> Answer:
    """Which triangles of a model views show, and those that no view shows: `halflit look --certify`."""
    return call("certify", source, **arguments)


def measure(source: Any, **arguments: Any) -> Answer:
    """Box, area, volume, centre and bodies of a model and of each of its parts."""
    return call("measure", source, **arguments)


def info(source: Any, **arguments: Any) -> Answer:
    """Describes a model's file, and what drawing it requires: `halflit info`."""
    return call("info", source, **arguments)


def explain(source: Any, pixel: Any, **arguments: Any) -> Answer:
    """Explains a pixel (x, y), or each of several, of the picture that `halflit render` draws with these arguments: `halflit explain`."""
    return call("explain", source, pixel=pixel, **arguments)


def compare(a: Any, b: Any, **arguments: Any) -> Answer:
    """Compares two versions of a model, two paths: pictures, parts, measures and the distance of the surfaces: `halflit compare`."""
    return call("compare", a=os.fspath(a), b=os.fspath(b), **arguments)
