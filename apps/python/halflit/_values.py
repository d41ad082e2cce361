"""Numbers of a caller. What is none is refused by the argument's name; nothing is cut off or guessed."""
from __future__ import annotations

import math
import operator
from typing import Any, List, Tuple

from ._errors import UsageError
from ._types import Up


def shown(value: Any) -> str:
    """The value in a message: one short line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 80 else text[:77] + "..."


def whole(value: Any, name: str, low: int, high: int) -> int:
    """A whole number in [low, high]. A float is none, even if it is 2.0, and True is none."""
    try:
        number_like: Any = "" if isinstance(value, bool) else value
        number = operator.index(number_like)
    except TypeError:
        raise UsageError(f"{name}: expected a whole number, found {shown(value)}") from None
    if not low <= number <= high:
        raise UsageError(f"{name}: expected a whole number from {low} to {high}, found {number}")
    return number


def real(value: Any, name: str) -> float:
    """A number. A text is none, even if it reads as one."""
    if not isinstance(value, (str, bytes)):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise UsageError(f"{name}: expected a number, found {shown(value)}")


def truth(value: Any, name: str) -> bool:
    """True or False; 0 and 1 will do."""
    if hasattr(value, "item") and not getattr(value, "ndim", 0):  # a scalar of numpy
        value = value.item()
    if isinstance(value, (bool, int)) and value in (0, 1):
        return bool(value)
    raise UsageError(f"{name}: expected True or False, found {shown(value)}")


def reals(value: Any, count: int, name: str) -> List[Any]:
    """As many numbers as `count`."""
    try:
        numbers = [] if isinstance(value, (str, bytes)) else [real(x, name) for x in value]
    except TypeError:
        numbers = []
    if len(numbers) != count:
        raise UsageError(f"{name}: expected {count} numbers, found {shown(value)}")
    return numbers


def sized(value: Any, name: str) -> Tuple[Any, ...]:
    """Whole numbers of an iterable, such as a size or a region."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        return tuple(whole(x, name, -(2**31), 2**31 - 1) for x in value)
    except TypeError:
        raise UsageError(f"{name}: expected whole numbers, found {shown(value)}") from None


def listed(value: Any, name: str, what: str) -> List[Any]:
    """The entries of an iterable. A text is none: it would be taken for its letters."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        return list(value)
    except TypeError:
        raise UsageError(f"{name}: expected {what}, found {shown(value)}") from None


def finite(value: Any, name: str) -> float:
    """A number that is not infinite or NaN."""
    number = real(value, name)
    if not math.isfinite(number):
        raise UsageError(f"{name}: expected a finite number, found {number}")
    return number


#: In the order of HALFLIT_UP, from 1.
UP_AXES: Tuple[Up, ...] = ("x", "y", "z", "-x", "-y", "-z")


def up_axis(name: str) -> int:
    """The HALFLIT_UP of "z", "-z" and so on."""
    if not isinstance(name, str) or name not in UP_AXES:
        raise UsageError(f"up: expected one of {', '.join(UP_AXES)}, found {shown(name)}")
    return 1 + UP_AXES.index(name)


def checked_size(size: Any) -> Tuple[int, int]:
    if hasattr(size, "__index__") and not getattr(size, "ndim", 0):
        size = (size, size)
    found = sized(size, "size")
    if len(found) != 2:
        raise UsageError(f"size: expected (width, height) in pixels, or the side of a square, found {shown(size)}")
    width, height = found
    if min(width, height) < 1 or width * height > 2**28:
        raise UsageError(f"size: expected 1 to 2^28 pixels, found {width} x {height}")
    return width, height
