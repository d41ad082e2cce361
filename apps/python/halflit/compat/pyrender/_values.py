"""Values of a caller as pyrender takes them."""
from __future__ import annotations

from typing import Any, Callable, ClassVar, Dict, Optional

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


class Checked:
    """Attributes that are converted and checked when they are set. Each change is counted, so that a renderer sees what to upload again."""

    _checks: ClassVar[Dict[str, Callable[[Any], Any]]] = {}
    _version = 0

    def __setattr__(self, name: str, value: Any) -> None:
        check = self._checks.get(name)
        object.__setattr__(self, name, value if check is None else check(value))
        object.__setattr__(self, "_version", self._version + 1)

    def _set(self, arguments: Dict[str, Any]) -> None:
        """Sets all checked attributes. arguments: of __init__(), by name."""
        for name in self._checks:
            setattr(self, name, arguments[name])


class Boxed:
    """Properties that follow from the box around a thing."""

    @property
    def bounds(self) -> Array:
        """Box, (2, 3)."""
        raise NotImplementedError

    @property
    def centroid(self) -> Array:
        """Middle of the bounds."""
        return np.asarray(self.bounds.mean(axis=0))

    @property
    def extents(self) -> Array:
        """Sides of the bounds."""
        return np.asarray(self.bounds[1] - self.bounds[0])

    @property
    def scale(self) -> float:
        """Diagonal of the bounds."""
        return float(np.linalg.norm(self.extents))


def text(value: Any) -> Optional[str]:
    """A name."""
    return None if value is None else str(value)


def bounded(name: str, low: float, high: float, default: Optional[float] = None) -> Callable[[Any], float]:
    """A check: a number in [low, high]. default: what None stands for."""

    def check(value: Any) -> float:
        number = float(default if value is None and default is not None else value)
        if not low <= number <= high:
            raise ValueError(f"{name}: expected {low:g} to {high:g}, found {number:g}")
        return number

    return check


def positive(name: str) -> Callable[[Any], float]:
    """A check: a number above 0."""

    def check(value: Any) -> float:
        number = float(value)
        if not number > 0:
            raise ValueError(f"{name}: expected a number above 0, found {number:g}")
        return number

    return check


def truth(name: str) -> Callable[[Any], bool]:
    """A check: True or False."""

    def check(value: Any) -> bool:
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{name}: expected True or False, found {value!r}")
        return bool(value)

    return check


def kind(name: str, *kinds: type, optional: bool = True) -> Callable[[Any], Any]:
    """A check: an object of a class."""

    def check(value: Any) -> Any:
        if not (isinstance(value, kinds) or (value is None and optional)):
            raise TypeError(f"{name}: expected {' or '.join(k.__name__ for k in kinds)}, found {type(value).__name__}")
        return value

    return check


def color(length: int, default: Optional[float] = None) -> Callable[[Any], Array]:
    """A check: float32 (length,). Whole numbers are 255ths; one number stands for all channels; missing channels are 1."""

    def check(value: Any) -> Array:
        if value is None and default is not None:
            return np.full(length, default, np.float32)
        array = np.asarray(value)
        if array.dtype.kind not in "fiu":
            raise ValueError(f"expected a colour, found {value!r}")
        array = array / 255.0 if array.dtype.kind in "iu" else array
        array = np.full(length, array) if array.ndim == 0 else array.squeeze()
        if array.ndim != 1:
            raise ValueError(f"expected a colour of {length} numbers, found an array of shape {array.shape}")
        filled = np.ones(length, np.float32)
        filled[: len(array)] = array[:length]
        return filled

    return check


def colors(value: Any, count: int) -> Array:
    """float32 (count, 4), likewise; one colour is repeated."""
    array = np.asarray(value)
    array = (array / 255.0 if array.dtype.kind in "iu" else array).astype(np.float32)
    array = np.tile(array, (count, 1)) if array.ndim == 1 else array[:, :4]
    if array.shape[1] < 4:
        array = np.concatenate([array, np.ones((len(array), 4 - array.shape[1]), np.float32)], axis=1)
    if len(array) != count:
        raise ValueError(f"{len(array)} colours, expected one for each of {count} vertices")
    return np.ascontiguousarray(array)
