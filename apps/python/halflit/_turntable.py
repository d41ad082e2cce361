"""A view of a scene that is turned by dragging, in notebooks and pages.

It shows pictures that were drawn before, so it needs neither a network nor a module of WebAssembly, its size does not depend on the
model's, and its pixels are those of Scene.render_views().
"""
from __future__ import annotations

import os
from typing import Any, Dict, Iterable, List, Optional, Tuple, Union

from . import _c
from ._errors import UsageError
from ._lazy_picture import pictures
from ._values import finite, listed, shown, whole

_KINDS = {"png": "png", "jpg": "jpeg", "webp": "webp"}
_MOST_FRAMES = 2000
_LINE_PX = 24  # of text below the picture

# Frames lie in rows of one elevation, from the lowest up; in a row the azimuth rises. A drag over the whole width turns it by half a circle.
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>%(title)s</title><style>
body { margin: 0; font: 12px sans-serif; color: #666 }
#view { width: %(width)dpx; height: %(height)dpx; cursor: grab; touch-action: none; user-select: none }
#view img { display: block; width: 100%%; height: 100%%; pointer-events: none }
</style></head><body><div id="view" role="img" tabindex="0" aria-label="%(title)s"><img alt="" src="%(first)s"></div>
<div>%(title)s</div><script>
"use strict";
const frames = %(frames)s, columns = %(columns)d, rows = frames.length / columns, width = %(width)d, height = %(height)d;
const images = frames.map((data) => Object.assign(new Image(), { src: "data:image/%(kind)s;base64," + data, alt: "" }));
const view = document.getElementById("view");
let x = 0, y = %(row)d, held = null;
function turn(right, up) {
  x = (((x + right) %% columns) + columns) %% columns;
  y = Math.min(Math.max(y + up, 0), rows - 1);
  const frame = Math.round(y) * columns + (Math.round(x) %% columns);
  view.dataset.frame = frame;
  view.replaceChildren(images[frame]);
}
view.addEventListener("pointerdown", (event) => { held = event; view.setPointerCapture(event.pointerId); });
view.addEventListener("pointermove", (event) => {
  if (!held || event.pointerId !== held.pointerId) return;
  turn(((held.clientX - event.clientX) * columns) / (2 * width), ((event.clientY - held.clientY) * rows) / height);
  held = event;
});
for (const name of ["pointerup", "pointercancel"]) view.addEventListener(name, () => { held = null; });
view.addEventListener("keydown", (event) => {
  const step = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (step) { turn(...step); event.preventDefault(); }
});
turn(0, 0);
</script></body></html>
"""


class Turntable:
    """Views drawn by Scene.turntable(): notebooks show a view that is turned by dragging or by the arrow keys, save() writes it as a page."""

    size: Tuple[int, int]  #: width, height of the pictures
    frames: Dict[Tuple[float, float], bytes]  #: (azimuth, elevation) in degrees -> picture, as the bytes of a file

    def __init__(self, frames: Dict[Tuple[float, float], bytes], size: Tuple[int, int], columns: int, row: int, kind: str) -> None:
        self.frames, self.size = frames, size
        self._columns, self._row, self._kind = columns, row, kind  # frames in a row; the row that is shown first

    @property
    def html(self) -> str:
        """The page as text. It refers to nothing outside of itself."""
        import base64
        import json

        data = [base64.b64encode(frame).decode() for frame in self.frames.values()]
        title = f"{self.size[0]} x {self.size[1]}, {len(data)} views; drag to turn"
        return _PAGE % {
            "title": title,
            "width": self.size[0],
            "height": self.size[1],
            "kind": _KINDS[self._kind],
            "first": f"data:image/{_KINDS[self._kind]};base64,{data[self._row * self._columns]}",
            "frames": json.dumps(data),
            "columns": self._columns,
            "row": self._row,
        }

    def save(self, path: Union[str, os.PathLike[Any]]) -> None:
        """Writes it as a page. The file is old or new, never half written."""
        pictures.replace_file(os.fsdecode(_c.required(path, "path")), self.html.encode())

    def _repr_html_(self) -> str:
        """For Jupyter: the page in a frame of its own, so that neither changes the other."""
        import html

        width, height = self.size
        page = html.escape(self.html)
        return f'<iframe srcdoc="{page}" sandbox="allow-scripts" width="{width}" height="{height + _LINE_PX}" style="border:0"></iframe>'

    def _repr_png_(self) -> Optional[bytes]:
        """For Jupyter where it runs no scripts, as in notebooks that are not trusted: the first view."""
        return list(self.frames.values())[self._row * self._columns] if self._kind == "png" else None

    def __repr__(self) -> str:
        return f"<halflit.Turntable of {len(self.frames)} views, {sum(map(len, self.frames.values())) / 1024:.0f} KiB>"


def turntable(
    scene: Any, size: Any, azimuths: Any, elevations: Iterable[Any], light: str, format: str, options: Dict[str, Any]
) -> Turntable:
    """Draws the frames of Scene.turntable()."""
    from ._frame import view_frames

    if not isinstance(format, str) or format not in _KINDS:
        raise UsageError(f"format: expected 'png', 'jpg' or 'webp', found {shown(format)}")
    columns, first = whole(azimuths, "azimuths", 1, _MOST_FRAMES), finite(options.pop("azimuth", 35.0), "azimuth") % 360
    levels = sorted({finite(one, "elevations") for one in listed(elevations, "elevations", "a list of angles in degrees")})
    if not levels or not -90 <= levels[0] <= levels[-1] <= 90:
        raise UsageError(f"elevations: expected angles from -90 to 90 degrees, found {shown(elevations)}")
    if columns * len(levels) > _MOST_FRAMES:
        raise UsageError(f"azimuths: expected at most {_MOST_FRAMES} views, found {columns * len(levels)}")
    views: List[Any] = [(first + 360 * i / columns, level) for level in levels for i in range(columns)]
    frames, found = {}, (0, 0)
    for view, picture in zip(views, view_frames(scene, views, size, light, options)):
        found = picture.shape[1], picture.shape[0]
        frames[view] = picture.encode(format)
    row = min(range(len(levels)), key=lambda i: abs(levels[i] - 20))  # the one nearest to the usual elevation
    return Turntable(frames, found, columns, row, format)
