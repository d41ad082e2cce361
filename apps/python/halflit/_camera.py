"""Cameras."""
from __future__ import annotations

import ctypes
import math
from typing import Any, Dict, List, Optional, Tuple, Union

from . import _c
from ._errors import UsageError
from ._lazy import np
from ._members import CameraMembers
from ._record import Record
from ._types import Array, Point, Unpack, Up, ViewOf
from ._values import checked_size, finite, real, reals, shown, up_axis


class Camera(Record):
    """A camera is at the origin of its own space and looks along -z, with +x to the right and +y up.

    Camera(matrix, fov_y_rad=0.8): matrix is world_from_camera, 4 x 4, rigid, its translation in the last column.
    Camera.look_at(eye, target), Camera.orbit(theta, phi, radius), Camera.view(scene, "iso"), Camera.from_intrinsics(K, size, R, t),
    Camera.from_matrices(view, projection), Scene.frame() and Scene.cameras give others.

    Members:
        name: of a camera of a file ("")
        matrix: world_from_camera, 4 x 4, rigid (the identity)
        sides: left, right, bottom, top of the picture: tangents of the angles from the axis, or (orthographic) distances from it, in
            place of fov_y_rad, aspect, half_height and half_width, whatever the picture's aspect; None: none (None)
        far_z: what is farther is not drawn; 0: no limit (0)
        orthographic: parallel rays; otherwise perspective (False)
        fov_y_rad: perspective: full vertical angle, in (0, pi) (pi / 4)
        aspect: perspective: width / height that the view is made for; 0: that of the picture (0)
        half_height: orthographic: half the height of the view, world units (1)
        half_width: orthographic: half its width; 0: from the picture's aspect (0)
        near_z: distance along -z, world units, from which on things are drawn; perspective: 0: chosen by the scene (0)
    """

    _kind, _truths = "camera", frozenset({"orthographic"})
    # Made by apps/c/tables.py of raster/camera_members.def.
    _ranges = {
        "fov_y_rad": (1e-6, math.pi - 1e-6),
        "aspect": (0.0, math.inf),
        "half_height": (1e-30, math.inf),
        "half_width": (0.0, math.inf),
    }
    orthographic: bool
    fov_y_rad: float
    aspect: float
    half_height: float
    half_width: float
    near_z: float
    far_z: float
    # Other members.
    name: str

    def __init__(self, matrix: Any = None, **members: Unpack[CameraMembers]) -> None:
        super().__init__(**members)
        if matrix is not None:
            self.matrix = matrix

    @classmethod
    def _members(cls) -> List[Any]:
        return [name for name in super()._members() if name != "world_from_camera"] + ["matrix"]

    @property
    def sides(self) -> Optional[Tuple[float, float, float, float]]:
        """left, right, bottom, top of the picture in place of the angles and sizes above, or None."""
        sides = tuple(self._c.sides)
        return (sides[0], sides[1], sides[2], sides[3]) if any(sides) else None

    @sides.setter
    def sides(self, value: Any) -> None:
        sides = (0.0, 0.0, 0.0, 0.0) if value is None else tuple(reals(value, 4, "sides"))
        if value is not None and not (sides[0] < sides[1] and sides[2] < sides[3]):
            raise UsageError(f"sides: expected left below right and bottom below top, found {shown(value)}")
        self._c.sides[:] = sides

    @property
    def matrix(self) -> Array:
        """world_from_camera, float64 (4, 4): the translation is matrix[:3, 3]."""
        matrix = np.array(self._c.world_from_camera, dtype=np.float64).reshape(4, 4).T.copy()
        matrix[:3, 3] += self._c.place_rest
        return matrix

    @matrix.setter
    def matrix(self, value: Any) -> None:
        from ._arrays import matrix

        array = matrix(value)
        turn = array[:3, :3]
        if not np.abs(turn.T @ turn - np.eye(3)).max() < 1e-3:
            raise UsageError("matrix: expected a rigid one, a rotation and a translation alone")
        if np.linalg.det(turn) < 0:
            raise UsageError(
                "matrix: expected a rotation, found one that mirrors: it would show things inside out (cameras of computer vision look "
                "along +z with y down: Camera.from_intrinsics takes them)"
            )
        self._place(array)

    def _place(self, matrix: Array) -> None:
        self._c.world_from_camera[:] = matrix.T.ravel().tolist()
        self._c.place_rest[:] = [x - y for x, y in zip(matrix[:3, 3].tolist(), self._c.world_from_camera[12:15])]

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("matrix", "sides"):
            object.__setattr__(self, name, value)
        else:
            super().__setattr__(name, value)

    def to_dict(self) -> Dict[Any, Any]:
        """All members by their names, and the matrix."""
        return {**super().to_dict(), "matrix": self.matrix.tolist()}

    @classmethod
    def look_at(cls, eye: Point, target: Point, up: Union[Point, Up] = "y", **members: Unpack[CameraMembers]) -> Camera:
        """A camera at `eye` that looks at `target`, with `up` upwards in the picture: a direction, or "x", "y", "z", "-x", "-y" or "-z".
        Points in world units."""
        camera = cls(**members)
        if isinstance(up, str):
            axis = up_axis(up) - 1
            up = [(1.0 - 2 * (axis // 3)) * (i == axis % 3) for i in range(3)]
        points = [np.array(reals(value, 3, name)) for value, name in ((eye, "eye"), (target, "target"), (up, "up"))]
        ahead = points[1] - points[0]
        if not np.isfinite(points).all() or not ahead.any() or not points[2].any():
            raise UsageError(f"look_at: expected an eye, another point as target, and a direction as up, found {eye}, {target}, {up}")
        # Far from the origin float32 would turn the view: there it is made around the eye.
        start = points[0] if np.abs(points[:2]).max() > 4096 * np.abs(ahead).max() else np.zeros(3)
        given = [(ctypes.c_float * 3)(*point) for point in (points[0] - start, points[1] - start, points[2])]
        _c.call("camera_look_at", *given, ctypes.byref(camera._c))
        matrix = camera.matrix
        matrix[:3, 3] = points[0]
        camera._place(matrix)
        return camera

    @classmethod
    def orbit(
        cls, theta: float, phi: float, radius: float, target: Point = (0, 0, 0), up: Up = "y", **members: Unpack[CameraMembers]
    ) -> Camera:
        """A camera that looks at `target` from a distance, by the angles of <model-viewer>'s camera-orbit.

        theta: degrees about the vertical axis, from +z towards +x. phi: degrees from straight above. radius: world units. up: the world's
        vertical axis, "x", "y", "z", "-x", "-y" or "-z".
        """
        camera, at = cls(**members), np.array([finite(x, "target") for x in reals(target, 3, "target")])
        angles = finite(theta, "theta"), 90 - finite(phi, "phi")
        if not 0 < real(radius, "radius") < math.inf:
            raise UsageError(f"radius: expected a distance above 0, found {shown(radius)}")
        _c.call("camera_orbit", (ctypes.c_double * 3)(), *angles, 1.0, up_axis(up), ctypes.byref(camera._c))
        matrix = camera.matrix
        matrix[:3, 3] = at + matrix[:3, 2] * radius
        camera._place(matrix)
        return camera

    @classmethod
    def view(cls, scene: Any, view: ViewOf = "iso", size: Any = (1280, 720), **options: Any) -> Camera:
        """The camera of scene.render(size, view=view): of the whole scene from a side, at the distance and scale that shows all sides.

        view: "front", "back", "left", "right", "top", "bottom", "iso", or (azimuth, elevation) in degrees. size: (width, height) of the
        picture. options: zoom, fov, orthographic and fit, as in render().
        """
        from ._options import check_names

        if not hasattr(scene, "_views_of"):
            raise UsageError(f"scene: expected a Scene, found {shown(scene)}")
        check_names(options, ("zoom", "fov", "orthographic", "fit"), "Camera.view")
        made: Camera = scene._views_of([view], checked_size(size), options)[0]
        return made

    @classmethod
    def from_intrinsics(cls, K: Any, size: Any, R: Any, t: Any, first_pixel: float = 0, **members: Unpack[CameraMembers]) -> Camera:
        """A camera of computer vision, which looks along +z with y down.

        K: fx, 0, cx; 0, fy, cy; 0, 0, 1 in pixels of a picture of size (width, height). A point X of the world is at R X + t in the
        camera's space. first_pixel: the coordinate of the middle of the first pixel: 0 for OpenCV, 0.5 for COLMAP and wherever pixels
        have their corners at whole numbers. Draw pictures of that size, or of its shape.
        """
        from ._arrays import numbers

        given = []
        for value, shape, name in ((K, (3, 3), "K"), (R, (3, 3), "R"), (t, (3,), "t")):
            array = numbers(value, np.float64, name)
            if array.size != math.prod(shape):
                raise UsageError(f"{name}: expected numbers of shape {shape}, found shape {array.shape}")
            if not np.isfinite(array).all():
                raise UsageError(f"{name}: a number is not finite")
            given.append((ctypes.c_double * array.size)(*array.ravel()))
        width, height = checked_size(size)
        camera = cls(**members)
        k, turn, move = given
        if not (k[0] > 0 and k[4] > 0):
            raise UsageError(f"K: expected fx and fy above 0, found {k[0]:g} and {k[4]:g}")
        try:
            _c.call("camera_from_intrinsics", k, width, height, turn, move, finite(first_pixel, "first_pixel"), ctypes.byref(camera._c))
        except UsageError as error:
            raise UsageError(str(error).replace("rotation: ", "R: ").replace("intrinsics: ", "K: ")) from None
        matrix = np.eye(4)
        matrix[:3, :3] = np.array(turn).reshape(3, 3).T * (1, -1, -1)
        matrix[:3, 3] = -np.array(turn).reshape(3, 3).T @ np.array(move)
        camera._place(matrix)
        return camera

    @classmethod
    def from_matrices(cls, view: Any, projection: Any) -> Camera:
        """A camera by the two matrices of OpenGL: view is camera_from_world and rigid, projection is clip_from_camera, both 4 x 4.

        The projection may be perspective, with or without a far plane, or orthographic; its axis may be anywhere in the picture.
        """
        from ._arrays import matrix, numbers

        p = numbers(projection, np.float64, "projection")
        if p.shape != (4, 4):
            raise UsageError(f"projection: expected an array of shape (4, 4), found {p.shape}")
        try:
            camera = cls(np.linalg.inv(matrix(view, "view")))
        except np.linalg.LinAlgError:
            raise UsageError("view: expected a rigid matrix, found one without an inverse") from None
        a, b = p[2, 2], p[2, 3]
        if not (p[0, 0] > 0 and p[1, 1] > 0):
            raise UsageError("projection: expected x to the right and y up")
        x, y = (-p[0, 2], -p[1, 2]) if p[3, 2] == -1 else (p[0, 3], p[1, 3])  # of the axis, as the picture's are from -1 to 1
        if abs(x) + abs(y) > 1e-6:
            camera.sides = (-1 - x) / p[0, 0], (1 - x) / p[0, 0], (-1 - y) / p[1, 1], (1 - y) / p[1, 1]
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
        return self._copied()

    def _check(self) -> None:
        """Refuses distances that contradict each other; each alone may be set first."""
        near_z, far_z = self.near_z, self.far_z
        if not self.orthographic and near_z < 0:
            raise UsageError(f"near_z: expected a distance from 0 on, found {near_z}")
        if far_z != 0 and far_z <= near_z:
            raise UsageError(f"far_z: expected a distance above near_z, which is {near_z}, found {far_z}")

    def _shape(self) -> float:
        """Width / height that the camera is made for; 0 if it is made for any."""
        c = self._c
        if self.sides:
            return float((c.sides[1] - c.sides[0]) / (c.sides[3] - c.sides[2]))
        if c.orthographic:
            return float(c.half_width / c.half_height) if c.half_width > 0 else 0.0
        return float(c.aspect)
