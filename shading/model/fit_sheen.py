#!/usr/bin/env python3
"""Fits the numbers of sheen_table.hpp and prints them as C++. Needs numpy and scipy; takes half a minute."""

import numpy as np
from scipy.optimize import least_squares

from fit_reflections import LEAST_ROUGHNESS, LEVELS, NODES, lobe


def directions():
    """A grid over the sphere that is dense near the horizon, and its solid angles."""
    x, w = np.polynomial.legendre.leggauss(64)
    t, share = (x + 1) / 2, w / 2
    z = np.concatenate([-t[::-1] ** 2, t**2])
    height = np.concatenate([(2 * t * share)[::-1], 2 * t * share])
    around = (np.arange(96) + 0.5) / 96 * 2 * np.pi
    zz, turn = np.meshgrid(z, around, indexing="ij")
    sine = np.sqrt(1 - zz * zz)
    light = np.stack([sine * np.cos(turn), sine * np.sin(turn), zz], -1).reshape(-1, 3)
    return light, (height[:, None] * np.ones(96) * 2 * np.pi / 96).reshape(-1)


LIGHT, AREA = directions()
SOFT = 0.01  # kSheenSoftSide


def charlie(light, roughness, n_dot_v):
    """Light of a direction that sheen reflects, D V N.L, for the normal z and a view in the plane y = 0."""
    a = max(roughness, LEAST_ROUGHNESS) ** 2
    view = np.array([np.sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v])
    n_dot_l = np.maximum(light[:, 2], 1e-12)
    squared = np.clip(1 - (n_dot_l + n_dot_v) ** 2 / np.maximum(2 + 2 * light @ view, 1e-30), 0, 1)
    d = (2 + 1 / a) * squared ** (0.5 / a) / (2 * np.pi)
    return d / (4 * (n_dot_l + n_dot_v - n_dot_l * n_dot_v)) * n_dot_l * (light[:, 2] > 0)


def albedo(roughness, n_dot_v):
    """Share of a uniform sky that white sheen reflects. The grid is dense near the horizon, and near the direction opposite the view."""
    x, w = np.polynomial.legendre.leggauss(400)
    t = (x + 1) / 2
    s = (np.arange(400) + 0.5) / 400
    z, turn = np.meshgrid(t**3, np.pi * (1 - s**3), indexing="ij")
    sine = np.sqrt(1 - z * z)
    light = np.stack([sine * np.cos(turn), sine * np.sin(turn), z], -1).reshape(-1, 3)
    area = ((w / 2 * 3 * t * t)[:, None] * (np.pi * 3 * s * s / 400)).reshape(-1)
    return 2 * (charlie(light, roughness, n_dot_v) * area).sum()


def three_lobes(p, n_dot_v):
    """Mean of three lobes of the level p[1] at the height p[0]: one on the viewer's side, two that are turned from it to either side. Where
    the view is nearly straight on, so that the viewer has no side, all three are near the normal."""
    height, level, cosine = p
    squared = 1 - n_dot_v * n_dot_v
    flat, side = np.sqrt((1 - height * height) * squared / (squared + SOFT)), np.sqrt(1 - cosine * cosine)
    towards = np.array([(flat, 0, height), (flat * cosine, flat * side, height), (flat * cosine, -flat * side, height)])
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    return sum(lobe(np.clip(LIGHT @ d, -1, 1), level) for d in towards) / 3


def fit(roughness, n_dot_v, start):
    """Height, level and cosine that come nearest to sheen's share of each direction in the norm over the sphere."""
    target = charlie(LIGHT, roughness, n_dot_v)
    target /= (target * AREA).sum()
    root, norm = np.sqrt(AREA), np.sqrt((target * target * AREA).sum())

    def residual(p):
        return np.concatenate([(three_lobes(p, n_dot_v) - target) * root / norm, 1e-2 * (p - start) / np.array([1, 3, 1])])

    low, high = np.array([0, 0, -0.95]), np.array([1, LEVELS - 1, 0.95])
    return least_squares(residual, np.clip(start, low + 1e-4, high - 1e-4), bounds=(low, high), max_nfev=60).x


def main():
    for i in range(NODES):
        roughness, best, row = max(i / (NODES - 1), LEAST_ROUGHNESS), np.array([0.4, 5.0, 0.0]), []
        for j in range(NODES):
            y = j / (NODES - 1)
            n_dot_v = min(max(0.2 * y / (1.2 - y), 0.002), 0.9995)
            best = fit(roughness, min(n_dot_v, 0.97), best)  # nearer to the normal the lobes merge
            row.append([albedo(roughness, n_dot_v), *best])
        for shape in row:
            print("    {" + ", ".join(f"{x:.5f}f" for x in shape) + "},")


if __name__ == "__main__":
    main()
