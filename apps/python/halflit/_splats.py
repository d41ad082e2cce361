"""3D Gaussians from arrays."""
from __future__ import annotations

import math
from typing import Any, Tuple

from . import _c
from ._color import linear_from_codes
from ._errors import UsageError
from ._lazy import np
from ._record import chosen
from ._types import Array, SplatReference
from ._values import shown, truth

#: The first spherical harmonic: 1 / (2 sqrt(pi)).
_Y0 = 0.28209479177387814


class Splats:
    """3D Gaussians from arrays, in place of vertices: scene.add_mesh(splats), scene.set_mesh(index, splats), halflit.render(splats).

    positions: (n, 3) world units; those that are not finite are left out, with a warning. rotations: (n, 4) quaternions in the order
    x, y, z, w, of any length; 0 0 0 0 turns nothing. scales: (n, 3) standard deviations along the three axes, world units, from 0: of a
    training program np.exp(scales). opacities: (n,) from 0 to 1: of a training program 1 / (1 + np.exp(-opacities)).
    colors: (n, 3) codes of the display from 0 to 1, or uint8 sRGB codes; or spherical harmonics (n, k, 3) with k = 1, 4, 9, 16 or 25 for
    the degrees 0 to 4, by the direction in which the Gaussian is seen: a colour is 0.5 + their sum, not below 0.
    reference: how they become pixels: "inria", "inria_aa", "khr" or "mip" (docs/formats.md). linear_light: colours are linear light.

    Arrays of another shape, and numbers out of range, are a UsageError. Gaussians need no light and cast no shadow.
    """

    def __init__(self, positions: Any, rotations: Any, scales: Any, opacities: Any, colors: Any, *, reference: SplatReference = "inria",
                 linear_light: bool = False) -> None:  # fmt: skip
        from ._arrays import array_of

        self.positions = array_of(positions, "positions")
        if self.positions.ndim != 2 or self.positions.shape[1] != 3:
            raise UsageError(f"positions: expected an array of shape (n, 3), found {self.positions.shape}")
        count = len(self.positions)
        self.linear_light = truth(linear_light, "linear_light")
        self.reference = chosen(reference, "SPLATS", "reference")
        self.rotations = _checked(rotations, (count, 4), "rotations")
        self.scales = _checked(scales, (count, 3), "scales", 0)
        self.opacities = _checked(opacities, (count,), "opacities", 0, 1)
        colors = array_of(colors, "colors")
        if colors.ndim == 2:
            if colors.dtype == np.uint8:
                colors = linear_from_codes(colors) if self.linear_light else colors / 255
            shares = _checked(colors, (count, 3), "colors", 0, 1, np.float64)
            colors = ((shares - 0.5) / _Y0)[:, None, :]
        if colors.ndim != 3 or colors.shape[1] not in (1, 4, 9, 16, 25):
            raise UsageError(f"colors: expected an array of shape (n, 3), or (n, k, 3) with k = 1, 4, 9, 16 or 25, found {colors.shape}")
        self.harmonics = _checked(colors, (count, colors.shape[1], 3), "colors")

    def struct(self) -> Any:
        """The halflit_splats, which points to the arrays of this object."""
        splats = _c.make("splats")
        for member in ("rotations", "scales", "opacities", "harmonics"):
            setattr(splats, member, getattr(self, member).ctypes.data)
        splats.degree = int(self.harmonics.shape[1] ** 0.5) - 1
        splats.reference, splats.linear_light = self.reference, self.linear_light
        return splats

    def __repr__(self) -> str:
        return f"<halflit.Splats of {len(self.positions)} Gaussians>"


def _checked(value: Any, shape: Tuple[int, ...], name: str, low: float = -math.inf, high: float = math.inf,
             kind: Any = None) -> Array:  # fmt: skip
    """An array of this shape whose numbers are finite and in range. kind: of the numbers; None: float32."""
    from ._arrays import numbers

    array = numbers(value, kind or np.float32, name)
    if array.shape != shape:
        raise UsageError(f"{name}: expected an array of shape {shape}, found {array.shape}")
    wrong = ~(np.isfinite(array) & (array >= low) & (array <= high)).all(axis=tuple(range(1, len(shape))))
    if wrong.any():
        expected = "finite numbers" + (f" from {low:g}" if low == 0 else "") + (f" to {high:g}" if high == 1 else "")
        raise UsageError(f"{name}: row {wrong.argmax()} is {shown(array[wrong.argmax()].tolist())}, expected {expected}")
    return array
