"""Cameras. They look along -z, with +x to the right and +y up."""
from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np

from ._values import Array, Checked, bounded, positive, text
from .constants import DEFAULT_Z_FAR, DEFAULT_Z_NEAR


def _far(value: Any) -> Optional[float]:
    return None if value is None else positive("zfar")(value)


class Camera(Checked):
    """Base of all cameras. Scripts derive their own from it, with a get_projection_matrix(), which alone decides the picture."""

    _checks = {"name": text, "znear": bounded("znear", 0, math.inf), "zfar": _far}
    name: Optional[str]
    znear: float
    zfar: Optional[float]

    def __init__(self, znear: float = DEFAULT_Z_NEAR, zfar: Optional[float] = DEFAULT_Z_FAR, name: Optional[str] = None) -> None:
        self.name, self.znear, self.zfar = name, znear, zfar

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        far = getattr(self, "zfar", None)
        if name == "zfar" and far is not None and far <= self.znear:
            raise ValueError(f"zfar: expected a number above znear, {self.znear:g}, found {far:g}")

    def get_projection_matrix(self, width: Optional[int] = None, height: Optional[int] = None) -> Array:
        """OpenGL's projection matrix, (4, 4)."""
        raise NotImplementedError(f"{type(self).__name__}.get_projection_matrix")

    def _depth_rows(self, matrix: Array) -> Array:
        """The matrix with the rows of a perspective view's depth."""
        near, far = self.znear, self.zfar
        matrix[3, 2] = -1.0
        matrix[2, 2] = -1.0 if far is None else (far + near) / (near - far)
        matrix[2, 3] = -2.0 * near if far is None else 2.0 * far * near / (near - far)
        return matrix


class PerspectiveCamera(Camera):
    """yfov: full vertical angle, radians. aspectRatio: width / height of the view, stretched to the picture; None: the picture's."""

    _checks = {
        **Camera._checks,
        "yfov": positive("yfov"),
        "aspectRatio": lambda value: None if value is None else positive("aspectRatio")(value),
    }
    yfov: float
    aspectRatio: Optional[float]

    def __init__(
        self,
        yfov: float,
        znear: float = DEFAULT_Z_NEAR,
        zfar: Optional[float] = None,
        aspectRatio: Optional[float] = None,  # noqa: N803
        name: Optional[str] = None,
    ) -> None:
        super().__init__(znear=znear, zfar=zfar, name=name)
        self.yfov, self.aspectRatio = yfov, aspectRatio

    def get_projection_matrix(self, width: Optional[int] = None, height: Optional[int] = None) -> Array:
        """OpenGL's projection matrix, (4, 4)."""
        aspect = self.aspectRatio
        if aspect is None:
            if width is None or height is None:
                raise ValueError("aspectRatio: expected one, as width and height are not given")
            aspect = width / height
        half = math.tan(self.yfov / 2)
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = 1 / (aspect * half), 1 / half
        return self._depth_rows(matrix)


class OrthographicCamera(Camera):
    """xmag, ymag: half the width and half the height of the view, world units. The picture's shape replaces xmag, as in pyrender."""

    _checks = {**Camera._checks, "xmag": positive("xmag"), "ymag": positive("ymag"), "znear": positive("znear")}
    xmag: float
    ymag: float

    def __init__(
        self, xmag: float, ymag: float, znear: float = DEFAULT_Z_NEAR, zfar: float = DEFAULT_Z_FAR, name: Optional[str] = None
    ) -> None:
        super().__init__(znear=znear, zfar=zfar, name=name)
        self.xmag, self.ymag = xmag, ymag

    def get_projection_matrix(self, width: Optional[int] = None, height: Optional[int] = None) -> Array:
        """OpenGL's projection matrix, (4, 4)."""
        near, far = self.znear, DEFAULT_Z_FAR if self.zfar is None else self.zfar
        xmag = self.xmag if width is None or height is None else width / height * self.ymag
        matrix = np.diag([1 / xmag, 1 / self.ymag, 2 / (near - far), 1.0])
        matrix[2, 3] = (far + near) / (near - far)
        return matrix


class IntrinsicsCamera(Camera):
    """fx, fy: focal lengths in pixels. cx, cy: the axis in the picture, pixels from the corner on the top left."""

    _checks = {**Camera._checks, **dict.fromkeys(("fx", "fy", "cx", "cy"), float)}
    fx: float
    fy: float
    cx: float
    cy: float

    def __init__(
        self,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        znear: float = DEFAULT_Z_NEAR,
        zfar: Optional[float] = DEFAULT_Z_FAR,
        name: Optional[str] = None,
    ) -> None:
        super().__init__(znear=znear, zfar=zfar, name=name)
        self.fx, self.fy, self.cx, self.cy = fx, fy, cx, cy

    def get_projection_matrix(self, width: Optional[int] = None, height: Optional[int] = None) -> Array:
        """OpenGL's projection matrix, (4, 4), of a picture of this size."""
        if width is None or height is None:
            raise ValueError("width, height: expected those of the picture")
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[0, 2] = 2 * self.fx / width, 1 - 2 * self.cx / width
        matrix[1, 1], matrix[1, 2] = 2 * self.fy / height, 2 * self.cy / height - 1
        return self._depth_rows(matrix)


__all__ = ["Camera", "PerspectiveCamera", "OrthographicCamera", "IntrinsicsCamera"]
