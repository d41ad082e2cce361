"""Lights. They shine along -z of their node."""
from __future__ import annotations

import math
from typing import Any, Optional

from ._values import Array, Checked, bounded, color, text


def _range(value: Any) -> Optional[float]:
    return None if value is None else float(value)


class Light(Checked):
    """color: (3,), linear. intensity: candela for point and spot lights, lux for directional ones. range: kept and not used, as in
    pyrender."""

    _checks = {"name": text, "color": color(3, 1.0), "intensity": bounded("intensity", 0, math.inf, 1.0), "range": _range}
    name: Optional[str]
    color: Array
    intensity: float
    range: Optional[float]

    def __init__(
        self, color: Any = None, intensity: Optional[float] = None, range: Optional[float] = None, name: Optional[str] = None
    ) -> None:
        self.name, self.color, self.range = name, color, range
        self.intensity = intensity  # type: ignore[assignment]


class DirectionalLight(Light):
    """A light that is infinitely far away."""

    def __init__(self, color: Any = None, intensity: Optional[float] = None, name: Optional[str] = None) -> None:
        super().__init__(color=color, intensity=intensity, name=name)


class PointLight(Light):
    """A light that shines from a point to all sides, and falls with the squared distance."""


class SpotLight(Light):
    """A cone of light: full up to innerConeAngle from the axis, none from outerConeAngle on, radians, at most pi / 2."""

    _checks = {
        **Light._checks,
        "innerConeAngle": bounded("innerConeAngle", 0, math.pi / 2 + 1e-9),
        "outerConeAngle": bounded("outerConeAngle", 0, math.pi / 2 + 1e-9),
    }
    innerConeAngle: float
    outerConeAngle: float

    def __init__(
        self,
        color: Any = None,
        intensity: Optional[float] = None,
        range: Optional[float] = None,
        innerConeAngle: float = 0.0,  # noqa: N803
        outerConeAngle: float = math.pi / 4,  # noqa: N803
        name: Optional[str] = None,
    ) -> None:
        super().__init__(color=color, intensity=intensity, range=range, name=name)
        self.outerConeAngle = outerConeAngle
        self.innerConeAngle = innerConeAngle

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "innerConeAngle" and value > self.outerConeAngle:
            raise ValueError(f"innerConeAngle: expected at most outerConeAngle, {self.outerConeAngle:g}, found {value:g}")
        super().__setattr__(name, value)


__all__ = ["Light", "DirectionalLight", "SpotLight", "PointLight"]
