"""Pictures as files."""
from __future__ import annotations

import os
from typing import Any, Union

import numpy as np

from halflit._picture import Picture


def save_image(path: Union[str, "os.PathLike[Any]"], image: Any, flip_up_down: bool = False) -> None:
    """Writes uint8 (height, width), or (height, width, 3 or 4). flip_up_down: the last row comes first."""
    pixels = np.asarray(image)
    pixels = np.repeat(pixels[:, :, None], 3, axis=2) if pixels.ndim == 2 else pixels
    np.ascontiguousarray(pixels[::-1] if flip_up_down else pixels).view(Picture).save(path)


__all__ = ["save_image"]
