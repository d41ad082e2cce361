"""numpy, which takes longer to import than all of halflit: it is imported when a name of it is first used."""
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any


__all__ = ["LazyModule", "np"]


class LazyModule:
    """Stands for a module. Annotations may name it too: typing.get_type_hints() then finds its types."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        found = getattr(importlib.import_module(self._name), name)
        setattr(self, name, found)  # found at once from now on
        return found


if TYPE_CHECKING:
    import numpy as np
else:
    np = LazyModule("numpy")
