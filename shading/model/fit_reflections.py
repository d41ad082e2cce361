#!/usr/bin/env python3
"""Fits the numbers of reflection_tables.hpp and of reflection_map.cpp, and prints them as C++. Needs numpy and scipy; takes half a minute."""

import numpy as np
from scipy.optimize import least_squares

NODES, LEVELS, SHARPEST, LEAST_ROUGHNESS, FIRST_RADIUS = 16, 8, 0.008, 0.07, 0.02


def lobe_shape(cosine, a):
    """h of reflection_map.hpp, not normalised."""
    u = (1 + cosine) / 2
    return u**2 / (u * (a * a - 1) + 1) ** 2


def lobe_integral(a):
    s = np.concatenate([[0], np.exp(np.linspace(np.log(1e-10), 0, 6000))])
    u = 1 - (s[1:] + s[:-1]) / 2
    return 4 * np.pi * np.sum(np.diff(s) * u**2 / (u * (a * a - 1) + 1) ** 2)


WIDTHS = [SHARPEST * 2**k for k in range(LEVELS)]
INTEGRALS = [lobe_integral(a) for a in WIDTHS]


def lobe(cosine, level):
    """The map's lobe at a level between two of them."""
    low = min(int(level), LEVELS - 2)
    weight = level - low
    return (1 - weight) * lobe_shape(cosine, WIDTHS[low]) / INTEGRALS[low] + weight * lobe_shape(cosine, WIDTHS[low + 1]) / INTEGRALS[low + 1]


def masking(n_dot_l, n_dot_v, a):
    """Smith's height-correlated G / (4 N.L N.V)."""
    root = lambda x, y: x * np.sqrt(y * y * (1 - a * a) + a * a)
    return 0.5 / (root(n_dot_l, n_dot_v) + root(n_dot_v, n_dot_l))


def uniform_sky(a, n_dot_v):
    """A and B: GGX under a uniform sky, summed over half vectors spread as its distribution."""
    smooth = lambda x: x * x * (3 - 2 * x)
    u = smooth((np.arange(400) + 0.5) / 400)
    share = np.diff(smooth(np.arange(401) / 400))
    around = (np.arange(200) + 0.5) / 200 * np.pi
    n_dot_h = (1 / np.sqrt(1 + a * a * u / (1 - u)))[:, None] + 0 * around
    v_dot_h = np.sqrt(1 - n_dot_h**2) * np.sqrt(1 - n_dot_v * n_dot_v) * np.cos(around) + n_dot_h * n_dot_v
    n_dot_l = 2 * v_dot_h * n_dot_h - n_dot_v
    seen = (v_dot_h > 0) & (n_dot_l > 0)
    held = np.where(seen, n_dot_l, 1)
    weight = np.where(seen, masking(held, n_dot_v, a) * held * 4 * v_dot_h / n_dot_h, 0) * share[:, None] / 200
    fresnel = (1 - np.clip(v_dot_h, 0, 1)) ** 5
    return (weight * (1 - fresnel)).sum(), (weight * fresnel).sum()


def fit(a, n_dot_v, lobes, start):
    """Turn, level and, of two lobes, spread, that come nearest to GGX in the norm over the sphere."""
    sine = np.sqrt(1 - n_dot_v * n_dot_v)
    normal, mirrored, across = np.array([0, 0, 1.0]), np.array([-sine, 0, n_dot_v]), np.array([n_dot_v, 0, sine])
    # Directions about the mirrored one, dense near it.
    k = np.log(1 + np.pi / min(1.0, 1.2 * a) * 6)
    grow = np.exp(k * (np.arange(72) + 0.5) / 72)
    angle, width = np.pi * (grow - 1) / (np.exp(k) - 1), np.pi * k * grow / (np.exp(k) - 1) / 72
    turn = (np.arange(64) + 0.5) / 64 * 2 * np.pi
    t, p = np.meshgrid(angle, turn, indexing="ij")
    side = np.cos(p)[..., None] * across + np.sin(p)[..., None] * np.array([0, 1.0, 0])
    light = (np.cos(t)[..., None] * mirrored + np.sin(t)[..., None] * side).reshape(-1, 3)
    area = (np.sin(t) * width[:, None] * 2 * np.pi / 64).reshape(-1)
    half = light + np.array([sine, 0, n_dot_v])
    half /= np.maximum(np.linalg.norm(half, axis=-1, keepdims=True), 1e-12)
    n_dot_l = np.maximum(light[:, 2], 1e-9)
    ggx = a * a / np.pi / (half[:, 2] ** 2 * (a * a - 1) + 1) ** 2 * masking(n_dot_l, n_dot_v, a) * n_dot_l * (light[:, 2] > 0)
    ggx /= (ggx * area).sum()
    root, norm = np.sqrt(area), np.sqrt((ggx * ggx * area).sum())

    def residual(x):
        total = 0
        for sign in [0] if lobes == 1 else [-1, 1]:
            d = mirrored + (x[0] + sign * (x[2] if lobes == 2 else 0)) * (normal - n_dot_v * mirrored)
            total = total + lobe(np.clip(light @ d / np.linalg.norm(d), -1, 1), x[1]) / lobes
        return np.concatenate([(total - ggx) * root / norm, 1e-2 * (x - start) / np.array([1, 2, 1])[: len(x)]])

    low, high = np.array([0, 0, 0])[: lobes + 1], np.array([2.5, LEVELS - 1, 1.5])[: lobes + 1]
    held = np.clip(start, low + 1e-4, high - 1e-4)
    return least_squares(residual, held, bounds=(low, high), max_nfev=60, x_scale=[0.1, 0.5, 0.1][: lobes + 1]).x


def print_shapes():
    for i in range(NODES):
        a = max(i / (NODES - 1), LEAST_ROUGHNESS) ** 2
        level = np.clip(np.log2(a / SHARPEST), 0, LEVELS - 1)
        one, two, row = np.array([0.01, level]), np.array([0.01, level, 0.02]), []
        for j in range(NODES - 1, -1, -1):
            y = j / (NODES - 1)
            n_dot_v = min(max(0.2 * y / (1.2 - y), 0.002), 0.9995)
            seen = min(n_dot_v, 0.9)  # straight on, turn and spread have no effect
            one, two = fit(a, seen, 1, one), fit(a, seen, 2, two)
            row.append([*uniform_sky(a, n_dot_v), *one, *two, 0])
        for shape in reversed(row):
            print("    {" + ", ".join(f"{x:.5f}f" for x in shape) + "},")


def zonal(shape, widest, bands=2000):
    """Coefficients of a function of cosine in Legendre polynomials, the first one 1."""
    edges = np.concatenate([[0], np.exp(np.linspace(np.log(widest * 1e-4), np.log(widest), 60))])
    nodes, weights = np.polynomial.legendre.leggauss(12)
    angles, areas = [], []
    for low, high in zip(edges[:-1], edges[1:]):
        cuts = np.linspace(low, high, max(1, int((high - low) * bands / 10)) + 1)
        for a, b in zip(cuts[:-1], cuts[1:]):
            angles.append((a + b) / 2 + (b - a) / 2 * nodes)
            areas.append(weights * (b - a) / 2)
    angle, cosine = np.concatenate(angles), np.cos(np.concatenate(angles))
    value = shape(cosine) * np.concatenate(areas) * np.sin(angle)
    before, last, out = np.ones_like(cosine), cosine.copy(), [value.sum(), (value * cosine).sum()]
    for band in range(1, bands):
        before, last = last, ((2 * band + 1) * cosine * last - band * before) / (band + 1)
        out.append((value * last).sum())
    return np.array(out) / out[0]


def print_weights():
    radii = [min(FIRST_RADIUS * 2**k, np.pi) for k in range(LEVELS + 1)]
    bumps = [zonal(lambda x, r=r: np.clip(1 - (1 - x) / (1 - np.cos(r)), 0, None) ** 2, r) for r in radii]
    bands = np.arange(len(bumps[0]))
    weight = np.sqrt(2 * bands + 1.0) / (bands + 1)
    blurs = [np.ones(len(bands))]
    for bump in bumps:
        blurs.append(blurs[-1] * bump)
    level = None
    for k in range(LEVELS - 1, -1, -1):
        target = zonal(lambda x: lobe_shape(x, WIDTHS[k] if k > 0 else LEAST_ROUGHNESS**2), np.pi)
        pixel = np.exp(-0.5 * (bands * 0.0025) ** 2) if k == 0 else 1  # of an image of 1024 columns
        parts = blurs[k - 1 : k + 3] if level is None else [*blurs[k : k + 3], level]
        parts = [part * pixel for part in parts]
        matrix = np.array([part - parts[3] for part in parts[:3]]).T * weight[:, None]
        first = np.linalg.lstsq(matrix, (target - parts[3]) * weight, rcond=None)[0]
        found = np.append(first, 1 - first.sum())
        level = np.array(parts).T @ found
        print("    {" + ", ".join(f"{x:.4f}f" for x in found) + f"}},  // level {k}")


if __name__ == "__main__":
    print("kReflectionShapes:")
    print_shapes()
    print("kWeights:")
    print_weights()
