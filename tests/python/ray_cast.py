"""Depths by rays in float64, to compare pictures with."""
import numpy as np


def pinhole(fx, fy, cx, cy, size):
    """left, right, bottom and top of the picture at distance 1 of a camera with these focal lengths and this centre, pixels."""
    return -cx / fx, (size[0] - cx) / fx, (cy - size[1]) / fy, cy / fy


def perspective(yfov, size):
    """The same for a full vertical angle, radians."""
    half = np.tan(yfov / 2)
    return -half * size[0] / size[1], half * size[0] / size[1], -half, half


def depths(triangles, sides, pose, size, near=0.05, far=100.0, cull=True, orthographic=False):
    """Depth along the camera's axis at the middle of each pixel, float64 (height, width), 0 where nothing is.

    triangles: (n, 3, 3) points of the world, counter-clockwise seen from the front. sides: left, right, bottom and top of the picture at
    distance 1, or (orthographic) at any distance. pose: world from camera, which looks along -z. cull: back faces are not seen. Rays and
    triangles meet as Moeller and Trumbore (1997) have it.
    """
    width, height = size
    left, right, bottom, top = sides
    x = left + (right - left) * (np.arange(width) + 0.5) / width
    y = top + (bottom - top) * (np.arange(height) + 0.5) / height
    points = np.stack([*np.meshgrid(x, y), np.full((height, width), -1.0)], axis=-1)
    starts, ways = np.zeros_like(points), points
    if orthographic:
        starts, ways = points * (1, 1, 0), np.broadcast_to([0.0, 0.0, -1.0], points.shape)
    inverse = np.linalg.inv(pose)
    corners = np.asarray(triangles, np.float64) @ inverse[:3, :3].T + inverse[:3, 3]
    nearest = np.full((height, width), np.inf)
    for a, b, c in corners:
        if cull and not orthographic and np.cross(b - a, c - a) @ a >= 0:
            continue
        rows, columns = box(np.array([a, b, c]), sides, size, orthographic)
        start, way = starts[rows, columns], ways[rows, columns]
        along = np.cross(way, c - a)
        area = along @ (b - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = (along * (start - a)).sum(axis=-1) / area
            across = np.cross(start - a, b - a)
            v = (across * way).sum(axis=-1) / area
            distance = across @ (c - a) / area
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance >= near) & (distance <= far) & (area > 0 if cull else area != 0)
        nearest[rows, columns] = np.minimum(nearest[rows, columns], np.where(hit, distance, np.inf))
    return np.where(np.isfinite(nearest), nearest, 0)


def box(corners, sides, size, orthographic):
    """Rows and columns of the pixels that a triangle of the camera's space may cover: all, if it is not wholly in front of the camera."""
    left, right, bottom, top = sides
    if not orthographic and corners[:, 2].max() > -1e-6:
        return slice(0, size[1]), slice(0, size[0])
    points = corners[:, :2] if orthographic else corners[:, :2] / -corners[:, 2:]
    x = (points[:, 0] - left) / (right - left) * size[0]
    y = (top - points[:, 1]) / (top - bottom) * size[1]
    ends = [(int(np.clip(v.min() - 1, 0, count)), int(np.clip(v.max() + 2, 0, count))) for v, count in ((y, size[1]), (x, size[0]))]
    return slice(*ends[0]), slice(*ends[1])


def neighbours(plane):
    """The 9 pixels around each one, (9, height, width); beyond the picture its edge."""
    wide = np.pad(plane, 1, mode="edge")
    height, width = plane.shape
    return np.array([wide[i : i + height, j : j + width] for i in range(3) for j in range(3)])


def inner(depth, jump=0.02):
    """Where no edge is within a pixel: all neighbours are seen, and none is nearer or farther by more than this share."""
    around = neighbours(depth)
    least, most = around.min(axis=0), around.max(axis=0)
    return (least > 0) & (most < least * (1 + jump))


def outer(depth):
    """Where nothing is seen within a pixel."""
    return neighbours(depth).max(axis=0) == 0
