"""A bar for progress=True."""
from __future__ import annotations

import importlib
import sys
import time
from typing import Any, Callable, Optional

_WIDTH = 30  # characters
_PAUSE = 0.1  # seconds between two bars, so that short frames print none


def bar() -> Callable[[float], None]:
    """A function for `progress`: tqdm's bar where it is installed, which notebooks show as their own, or else a line of standard error."""
    try:
        tqdm = importlib.import_module("tqdm.auto").tqdm
    except ImportError:
        return _Line()
    return _Tqdm(tqdm)


class _Line:
    """One line, which is written over itself."""

    def __init__(self) -> None:
        self._next = time.monotonic() + _PAUSE
        self._is_shown = False

    def __call__(self, share: float) -> None:
        now = time.monotonic()
        if now < self._next and not (share >= 1 and self._is_shown):
            return
        self._next, self._is_shown = now + _PAUSE, True
        full = round(_WIDTH * share)
        end = "\n" if share >= 1 else ""
        print(f"\r[{'#' * full}{' ' * (_WIDTH - full)}] {100 * share:3.0f} %", end=end, file=sys.stderr, flush=True)


class _Tqdm:
    """A bar of tqdm, in per cent."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Optional[Any] = None

    def __call__(self, share: float) -> None:
        if self._bar is None:
            self._bar = self._tqdm(total=100, unit="%", leave=False, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
        shown: Any = self._bar
        shown.update(round(100 * share) - shown.n)
        if share >= 1:
            shown.close()
