"""Several pictures on one. This module imports numpy."""
from __future__ import annotations

import math
import os
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from ._color import BRIGHTEST, color, srgb_from_linear
from ._errors import UsageError
from ._picture import Picture, codes_of
from ._types import Array, Color
from ._values import listed, whole

_LABEL_SHARE = 14  # a line of letters is at least this share of a picture's width
_LEAST_LETTERS = 11  # pixels


def contact_sheet(
    pictures: Iterable[Any],
    labels: Optional[Iterable[Any]] = None,
    columns: Optional[int] = None,
    *,
    gap: int = 8,
    background: Color = "#f4f4f2",
    label_color: Color = "#303030",
) -> Picture:
    """One picture with all of them in rows, uint8 (height, width, 4).

    pictures: each uint8 or float32 of shape (height, width, 3 or 4), of any sizes; or a dict of pictures by their labels, as
    Scene.render_views() returns. labels: a text for each, written below it in the program's font by Pillow, which is needed for this alone.
    columns: the square root of their number, rounded up, if it is left out. gap: pixels between pictures, and around them. background: of
    the sheet, which lies behind transparent pictures too.
    """
    if isinstance(pictures, dict):
        labels = list(pictures) if labels is None else labels
        pictures = pictures.values()
    codes = [_straight(picture, i) for i, picture in enumerate(listed(pictures, "pictures", "a list of pictures"))]
    if not codes:
        raise UsageError("pictures: expected one or more")
    texts = None if labels is None else [str(label) for label in listed(labels, "labels", "a list of texts")]
    if texts is not None and len(texts) != len(codes):
        raise UsageError(f"labels: {len(texts)}, expected one for each of {len(codes)} pictures")
    columns = math.ceil(math.sqrt(len(codes))) if columns is None else whole(columns, "columns", 1, 2**16)
    columns, gap = min(columns, len(codes)), whole(gap, "gap", 0, 2**12)
    width, height = max(one.shape[1] for one in codes), max(one.shape[0] for one in codes)
    letters = 0 if texts is None else max(_LEAST_LETTERS, width // _LABEL_SHARE)
    below = letters + letters // 2
    rows = -(-len(codes) // columns)
    sheet = np.empty((rows * (height + below + gap) + gap, columns * (width + gap) + gap, 4), np.uint8)
    sheet[:] = _code(background, "background")
    for i, one in enumerate(codes):
        x, y = gap + i % columns * (width + gap), gap + i // columns * (height + below + gap)
        left, top = x + (width - one.shape[1]) // 2, y + (height - one.shape[0]) // 2
        _lay(one, sheet[top : top + one.shape[0], left : left + one.shape[1]])
        if texts is not None:
            mask = _written(texts[i], letters, width, below)
            part = sheet[y + height : y + height + below, x : x + width, :3]
            ink = np.asarray(_code(label_color, "label_color")[:3], np.float64)
            part[:] = (part + (ink - part) * (mask[:, :, None] / 255.0) + 0.5).astype(np.uint8)
    return sheet.view(Picture)


def _straight(picture: Any, index: int) -> Array:
    """uint8 codes with 3 or 4 channels, colours not multiplied by alpha."""
    array = picture if isinstance(picture, Picture) else np.asarray(picture).view(Picture)
    return codes_of(array._straight(f"picture {index}"))


def _code(value: Color, name: str) -> Sequence[int]:
    """The sRGB codes of a colour, and alpha."""
    share = np.asarray(color(value, name, 4, BRIGHTEST))
    share[:3] = srgb_from_linear(np.minimum(share[:3], 1))
    return [int(x) for x in share * 255 + 0.5]


def _lay(picture: Array, at: Array) -> None:
    """Lays a picture over the sheet, by its alpha, in codes."""
    if picture.shape[2] == 3:
        at[:, :, :3], at[:, :, 3] = picture, 255
        return
    alpha = picture[:, :, 3:] / 255.0
    under = at[:, :, 3:] / 255.0 * (1 - alpha)
    total = alpha + under
    mixed = (picture[:, :, :3] * alpha + at[:, :, :3] * under) / np.where(total > 0, total, 1)
    at[:, :, :3], at[:, :, 3:] = (mixed + 0.5).astype(np.uint8), (total * 255 + 0.5).astype(np.uint8)


def font_path() -> str:
    """The program's font: beside this file, or in the tree of the sources."""
    here = os.path.dirname(os.path.abspath(__file__))
    own = os.path.join(here, "dejavu_sans.ttf")
    return own if os.path.exists(own) else os.path.join(here, "..", "..", "engine", "fonts", "dejavu_sans.ttf")


def _written(text: str, letters: int, width: int, height: int) -> Union[Array, Any]:
    """The text's coverage, 0 to 255: in the middle, or shortened if it is too long."""
    try:
        from PIL import Image, ImageDraw, ImageFont
    except ImportError:
        raise ImportError("halflit.contact_sheet(labels=...) needs Pillow: pip install pillow") from None
    font = ImageFont.truetype(font_path(), letters)
    measure = ImageDraw.Draw(Image.new("L", (1, 1)))
    line = " ".join(text.split())
    cut = line
    while cut and measure.textlength(cut + ("" if cut == line else ".."), font) > width:
        cut = cut[:-1]
    line = cut if cut == line else cut + ".."
    left, top, right, bottom = measure.textbbox((0, 0), line, font) if line else (0, 0, 1, 1)
    size = max(1, int(right - left)), max(1, int(bottom - top))
    image = Image.new("L", size, 0)
    ImageDraw.Draw(image).text((-left, -top), line, 255, font)
    found = np.zeros((height, width), np.uint8)
    mask = np.asarray(image)[:height, :width]
    y, x = (height - mask.shape[0]) // 2, (width - mask.shape[1]) // 2
    found[y : y + mask.shape[0], x : x + mask.shape[1]] = mask
    return found
