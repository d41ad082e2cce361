"""Lights."""
from __future__ import annotations

import math
from typing import Any, Dict, Iterable, Optional

from ._errors import UsageError
from ._lazy import np  # noqa: F401  (in annotations)
from ._members import LightKeywords
from ._record import Record
from ._types import Color, LightType, Point, Unpack
from ._values import reals, shown


#: Properties of types of lights -> the types that have them.
_TYPES = {"placed": {"point", "spot"}, "aimed": {"directional", "spot"}, "cone": {"spot"}}


class Light(Record):
    """A light. A directional light of colour 1 makes a white surface that faces it exactly white; other lights do so at distance 1.

    Light("point", position=(0, 2, 0), color=(4, 4, 4)). Defaults in parentheses.

    Members:
        type: "directional", "point" or "spot" (directional)
        color: directional: irradiance / pi; point, spot: the same at distance 1 (1, 1, 1)
        position: point, spot: world space (0, 0, 0)
        direction: directional, spot: the way the light travels, of any length above 0 (0, -1, 0)
        range: point, spot: no light beyond this distance, world units; 0: no limit (0)
        source_radius: point, spot: smaller distances count as this, world units; 0: 1e-4 (0)
        inner_cone_rad: spot: full light up to this angle from the axis (0)
        outer_cone_rad: spot: no light from this angle on (pi / 4)
        cone_power: spot: factor cos(angle from the axis)^cone_power, 0 to 1e5 (0)
        shadow_radius: Size of the source, which makes its shadows soft and changes nothing else. Directional: the angle from its
            middle to its rim, radians, up to 0.7 (the sun's is 0.00465). Point, spot: radius of a ball, world units. 0: a point,
            with sharp shadows. (0)
    """

    _kind, _choices = "light", {"type": "LIGHT"}
    # Made by apps/c/tables.py of shading/light_members.def.
    _having = {
        "position": "placed",
        "direction": "aimed",
        "range": "placed",
        "source_radius": "placed",
        "inner_cone_rad": "cone",
        "outer_cone_rad": "cone",
        "cone_power": "cone",
    }
    _colors: Dict[str, Optional[float]] = {
        "color": None,
    }
    _ranges = {
        "range": (0.0, math.inf),
        "source_radius": (0.0, math.inf),
        "inner_cone_rad": (0.0, math.pi),
        "outer_cone_rad": (0.0, math.pi),
        "cone_power": (0.0, math.inf),
        "shadow_radius": (0.0, math.inf),
    }
    color: Color
    position: Point
    direction: Point
    range: float
    source_radius: float
    inner_cone_rad: float
    outer_cone_rad: float
    cone_power: float
    shadow_radius: float
    # Other members.
    type: LightType

    def __init__(self, type: LightType = "directional", **members: Unpack[LightKeywords]) -> None:
        super().__init__(type=type, **members)
        self._refuse_idle(members)

    def _refuse_idle(self, given: Iterable[str]) -> None:
        """Refuses members that lights of this type do not have, unless they are as in any light."""
        plain: Any = None
        names = set(given) - {"type"}
        for name in () if len(names) + 1 == len(self._members()) else sorted(names):  # all: of to_dict(), as a file has them
            if name in self._having and self.type not in _TYPES[self._having[name]]:
                plain = plain or Light()
                if getattr(self, name) != getattr(plain, name):
                    raise UsageError(f"{name}: has no effect on a light of type {self.type}")

    def _check(self) -> None:
        """Refuses angles that contradict each other; each alone may be set first."""
        if self.type == "spot" and self.inner_cone_rad > self.outer_cone_rad:
            raise UsageError(
                f"inner_cone_rad: expected at most outer_cone_rad, which is {self.outer_cone_rad:g}, found {self.inner_cone_rad:g}"
            )

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "direction" and not any(reals(value, 3, name)):
            raise UsageError(f"direction: expected a length above 0, found {shown(value)}")
        super().__setattr__(name, value)
