"""The file's own world, in which callers give and are given everything, and the world that is drawn."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Sequence, Tuple, TypeVar

from ._lazy import np
from ._types import Array

if TYPE_CHECKING:
    from ._camera import Camera
    from ._light import Light

R = TypeVar("R", "Camera", "Light")


class World:
    """A point p of the file is drawn at (p - origin) * scale. Scenes that are made of arrays have origin 0 and scale 1."""

    def __init__(self, origin: Sequence[float] = (0.0, 0.0, 0.0), scale: float = 1.0) -> None:
        self.origin: Tuple[float, ...] = tuple(origin)
        self.scale = scale
        self.is_drawn = scale == 1.0 and not any(origin)  # both worlds are the same

    def __eq__(self, other: object) -> bool:
        return isinstance(other, World) and (self.origin, self.scale) == (other.origin, other.scale)

    __hash__ = None  # type: ignore[assignment]

    def point_in(self, point: Any) -> List[Any]:
        """Where a point of the file is drawn."""
        return [(x - start) * self.scale for x, start in zip(point, self.origin)]

    def point_out(self, point: Any) -> List[Any]:
        """The point of the file that is drawn here."""
        return [x / self.scale + start for x, start in zip(point, self.origin)]

    def into(self, record: R) -> R:
        """A camera or a light, which is given in the file's world, in the world that is drawn."""
        if self.is_drawn:
            return record._copied()
        if record._drawn is not None and record._drawn[0] == self:
            drawn: R = record._drawn[1]._copied()
            return drawn
        return record._moved(self.point_in, self.scale)

    def out(self, record: R) -> R:
        """A camera or a light of the world that is drawn, in the file's world. Unless it is changed, into() gives the same bits again."""
        if self.is_drawn:
            return record._copied()
        given = record._moved(self.point_out, 1 / self.scale)
        object.__setattr__(given, "_drawn", (self, record))
        return given

    def matrix_in(self, matrix: Array) -> Array:
        """world_from_object, float64 (4, 4) or (n, 4, 4), for the world that is drawn."""
        placed = matrix.copy()
        placed[..., :3, :3] *= self.scale
        placed[..., :3, 3] = (matrix[..., :3, 3] - self.origin) * self.scale
        return placed

    def matrix_out(self, matrix: Array) -> Array:
        """The reverse of matrix_in()."""
        placed = matrix.copy()
        placed[:3, :3] /= self.scale
        placed[:3, 3] = self.point_out(matrix[:3, 3])
        return placed

    def planes_out(self, planes: Dict[Any, Any]) -> None:
        """Depths and positions of a frame, in place."""
        if self.is_drawn:
            return
        if "depth" in planes:
            planes["depth"] *= np.float32(1 / self.scale)  # infinity stays
        if "position" in planes:
            position = planes["position"]
            drawn = planes["depth"] < 3e38 if "depth" in planes else position.any(axis=2)
            position[drawn] = (position[drawn].astype(np.float64) / self.scale + self.origin).astype(np.float32)
