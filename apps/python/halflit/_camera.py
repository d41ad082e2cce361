"""Cameras."""
from __future__ import annotations

import ctypes
import math

from . import _c
from ._errors import UsageError
from ._records import Record, fill

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np

    from ._records import Point


class Camera(Record):
    """A camera is at the origin of its own space and looks along -z, with +x to the right and +y up.

    Camera(matrix, fov_y_rad=0.8): matrix is world_from_camera, 4 x 4, rigid, its translation in the last column.
    Camera.look_at(eye, target), Camera.from_matrices(view, projection), Scene.frame() and Scene.cameras give others.

    Members:
        name: of a camera of a file
        matrix: world_from_camera, 4 x 4, rigid
        orthographic: else perspective
        fov_y_rad: perspective: full vertical angle, 0 to pi
        aspect: perspective: width / height that the view is made for; 0: that of the picture
        half_height: orthographic: half the view's height, world units
        half_width: orthographic: half its width; 0: from the picture's aspect
        near_z: above 0 for perspective, world units
        far_z: above near_z; 0: no limit (perspective alone)
    """

    _kind, _truths = "camera", frozenset({"orthographic"})
    name: str
    orthographic: bool
    fov_y_rad: float
    aspect: float
    half_height: float
    half_width: float
    near_z: float
    far_z: float

    def __init__(self, matrix=None, **members: Any):
        super().__init__(**members)
        if matrix is not None:
            self.matrix = matrix

    @classmethod
    def _members(cls) -> list:
        return [*super()._members(), "matrix"]

    @property
    def matrix(self) -> np.ndarray:
        """world_from_camera, float32 (4, 4): the translation is matrix[:3, 3]."""
        import numpy as np

        return np.array(self._c.world_from_camera, dtype=np.float32).reshape(4, 4).T.copy()

    @matrix.setter
    def matrix(self, value) -> None:
        from ._arrays import matrix

        self._c.world_from_camera[:] = matrix(value).ravel().tolist()

    def __setattr__(self, name: str, value) -> None:
        if name == "matrix":
            object.__setattr__(self, name, value)
        else:
            super().__setattr__(name, value)

    def to_dict(self) -> dict:
        """All members by their names, and the matrix."""
        values = {name: getattr(self, name) for name in self._members() if name not in ("matrix", "world_from_camera")}
        return {**values, "matrix": self.matrix.tolist()}

    @classmethod
    def look_at(cls, eye: Point, target: Point, up: Point = (0, 1, 0), **members: Any) -> Camera:
        """A camera at `eye` that looks at `target`, with `up` upwards in the picture; points in world units."""
        camera = cls(**members)
        points = [fill(ctypes.c_float * 3, value, name) for value, name in ((eye, "eye"), (target, "target"), (up, "up"))]
        _c.call("camera_look_at", *points, ctypes.byref(camera._c))
        return camera

    @classmethod
    def from_matrices(cls, view, projection) -> Camera:
        """A camera by the two matrices of OpenGL: view is camera_from_world and rigid, projection is clip_from_camera, both 4 x 4.

        The projection may be perspective, with or without a far plane, or orthographic; its axis must go through the middle of the
        picture.
        """
        import numpy as np

        p = np.asarray(projection, dtype=np.float64)
        if p.shape != (4, 4):
            raise UsageError(f"projection: expected an array of shape (4, 4), found {p.shape}")
        camera = cls(np.linalg.inv(np.asarray(view, dtype=np.float64)))
        a, b = p[2, 2], p[2, 3]
        off_centre = abs(p[0, 2]) + abs(p[1, 2]) if p[3, 2] == -1 else abs(p[0, 3]) + abs(p[1, 3])
        if off_centre > 1e-6 or p[0, 0] <= 0 or p[1, 1] <= 0:
            raise UsageError("projection: expected an axis through the middle of the picture")
        if p[3, 2] == -1:
            camera.fov_y_rad = 2 * math.atan(1 / p[1, 1])
            camera.aspect = p[1, 1] / p[0, 0]
            camera.near_z = b / (a - 1)
            camera.far_z = b / (a + 1) if a + 1 < -1e-12 else 0.0
        elif p[3, 2] == 0 and p[3, 3] == 1:
            camera.orthographic = True
            camera.half_height, camera.half_width = 1 / p[1, 1], 1 / p[0, 0]
            camera.near_z, camera.far_z = (b + 1) / a, (b - 1) / a
        else:
            raise UsageError("projection: neither perspective nor orthographic")
        return camera

    def copy(self) -> Camera:
        """Another camera that is equal."""
        camera = Camera._of(_c.STRUCT["halflit_camera"].from_buffer_copy(self._c))
        camera._c.name = self._c.name  # its own: that of the other may go away
        return camera

    def placed(self, origin, scale: float) -> Camera:
        """The camera in a world where a point p is at (p - origin) * scale."""
        camera = self.copy()
        if scale != 1.0 or any(origin):
            place = camera._c.world_from_camera
            for axis in range(3):
                place[12 + axis] = (place[12 + axis] - origin[axis]) * scale
            for name in ("half_height", "half_width", "near_z", "far_z"):
                setattr(camera._c, name, getattr(camera._c, name) * scale)
        return camera

    def _shape(self) -> float:
        """Width / height that the camera is made for; 0 if it is made for any."""
        c = self._c
        if c.orthographic:
            return c.half_width / c.half_height if c.half_width > 0 else 0.0
        return c.aspect
