#!/usr/bin/env python3
"""The models of the pictures at the top of README.md: a camera (GLB), a turtle (PLY), a gear (STL) and the scan of a room (PLY).

    showcase.py MODELS [PROGRAM PICTURES]

writes them into the folder MODELS, and draws each into the folder PICTURES; a warning of the program is an error. Python's standard
library is enough, and each run gives the same files.
"""
import math
import pathlib
import struct
import subprocess
import sys

from shapes import (TURN, Scan, bar, blend, circle, ellipsoid, facing, lathe, limb, loft, mix, plate, rounded, smooth, solid, surface_net,
                    unit, upright, write_ply)
from small_models import Glb, write_stl


def camera(path):
    """A camera for film: chrome, leather, rubber, and a coated lens."""
    glb = Glb(extensionsUsed=["KHR_materials_clearcoat", "KHR_materials_iridescence"])
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.05}}
    film = {"iridescenceFactor": 1.0, "iridescenceIor": 1.7, "iridescenceThicknessMinimum": 380, "iridescenceThicknessMaximum": 380}
    chrome, polished = glb.material((0.80, 0.79, 0.77), 1.0, 0.32), glb.material((0.9, 0.89, 0.87), 1.0, 0.12)
    leather, rubber = glb.material((0.055, 0.035, 0.028), 0.0, 0.62), glb.material((0.02, 0.02, 0.021), 0.0, 0.75)
    black, red = (glb.material(color, 0.0, 0.35, extensions=coat) for color in ((0.025, 0.025, 0.028), (0.75, 0.02, 0.015)))
    white = glb.material((0.85, 0.85, 0.82), 0.0, 0.5)
    glass = glb.material((0.012, 0.008, 0.03), 0.0, 0.03, extensions={"KHR_materials_iridescence": film})
    middle, lens = upright(0, 0, 0), facing(0, 3.75, 1.7)
    roof = [(rounded(4.6 - 2.1 * t, 3.2 - 0.6 * t, 0.35), 7.2 + 1.75 * t) for t in (0, 0.8)] + [(rounded(2.55, 2.4, 0.2), 8.8)]
    parts = {chrome: plate(bar(13.2, 3.5, 1.6), 0, 1.0, 0.15, middle) + plate(bar(13.2, 3.5, 1.6), 5.93, 7.3, 0.18, middle)
             + solid(roof, middle),
             leather: plate(bar(13.1, 3.4, 1.55), 1.03, 5.9, 0.05, middle),
             black: plate(bar(1.9, 1.6, 0.1), 8.75, 8.9, 0.03, middle), white: [], red: [],
             polished: plate(bar(0.5, 1.7, 0.2), 0, 0.25, 0.08, facing(4.4, 4.3, 1.75))  # the self-timer
             + lathe([(0.4, 0), (0.4, 0.3), (0.33, 0.36), (0, 0.38)], facing(4.4, 5.0, 1.75))
             + lathe([(0.5, 7.3), (0.5, 7.5), (0.4, 7.55), (0.3, 7.75), (0.2, 7.8), (0, 7.82)], upright(2.0, 0, 0.9))}
    for x in (-0.72, 0.72):  # the shoe of a flash
        parts[polished] += plate(bar(0.22, 1.7, 0.05), 8.85, 9.05, 0.02, upright(x, 0, 0))
    for x, radius, high, ribs in ((3.5, 0.95, 0.75, 36), (-4.7, 1.0, 0.6, 40), (5.5, 0.62, 0.45, 28)):  # dials
        knob = [(circle(radius + 0.08, 4 * ribs), 7.25), (circle(radius + 0.08, 4 * ribs), 7.4), (circle(radius, 4 * ribs, 0.05), 7.42),
                (circle(radius, 4 * ribs, 0.05), 7.24 + high), (circle(radius - 0.1, 4 * ribs), 7.3 + high)]
        parts[polished] += solid(knob, upright(x, 0, 0))
        parts[black] += solid([(circle(radius * 0.7), 7.3 + high), (circle(radius * 0.7), 7.32 + high)], upright(x, 0, 0))
    parts[polished] += (lathe([(0, 0), (3.1, 0), (3.15, 0.05), (3.15, 0.45), (3.0, 0.5), (2.8, 0.5), (2.8, 0.7)], lens)
                        + lathe([(2.7, 1.45), (2.82, 1.5), (2.82, 1.62), (2.7, 1.65)], lens))
    for k in range(48):  # the scale of the aperture
        def on_ring(u, v, h, sin=math.sin(TURN * k / 48), cos=math.cos(TURN * k / 48)):
            return lens((2.88 + h) * cos - u * sin, (2.88 + h) * sin + u * cos, 1.1 + v)
        mark = rounded(0.07, 0.2 if k % 4 else 0.42, 0.02, 1)
        parts[red if k == 12 else white] += solid([(mark, 0), (mark, 0.035)], on_ring)
    parts[rubber] = loft([(circle(2.7, 240), 1.6), (circle(2.95, 240), 1.66), (circle(3.05, 240, 0.13), 1.72),
                          (circle(3.05, 240, 0.13), 2.85), (circle(2.9, 240), 2.92), (circle(2.7, 240), 2.92)], lens)
    parts[black] += lathe([(2.75, 0.5), (2.9, 0.72), (2.9, 1.45), (2.8, 1.5)], lens) + lathe(
        [(2.7, 2.85), (2.75, 2.95), (2.75, 3.55), (2.68, 3.65), (2.5, 3.68), (2.42, 3.6), (2.3, 3.3), (2.1, 3.1), (1.95, 2.8)], lens)
    parts[glass] = lathe([(2.05 * math.cos(a), 2.85 + 0.55 * math.sin(a)) for a in (TURN * k / 56 for k in range(14))] + [(0, 3.4)], lens)
    nodes = [glb.node(mesh=glb.mesh(smooth(triangles), material)) for material, triangles in parts.items()]
    glb.json.update(scene=0, scenes=[{"nodes": nodes}])
    glb.write(path)


def gear(path):
    """A helical gear with a web, holes, and a bore with a keyway; closed."""
    teeth, module, half_width, sectors = 24, 3.0, 10.0, 6
    pitch, root, tip = teeth * module / 2, (teeth / 2 - 1.25) * module, (teeth / 2 + 1) * module
    base = pitch * math.cos(TURN / 18)  # the flanks are involutes of this circle
    unrolled = [math.sqrt((r / base) ** 2 - 1) for r in (pitch, *(base + (tip - base) * k / 5 for k in range(6)))]
    angles = [t - math.atan(t) for t in unrolled]
    flank = [(TURN / 4 / teeth + angles[0] - a, base * math.hypot(1, t)) for a, t in zip(angles[1:], unrolled[1:])]
    flank = [(flank[0][0] + 0.022, root), (flank[0][0] + 0.003, root + 0.5), *flank]
    tooth = [(-TURN / 2 / teeth, root), *((-a, r) for a, r in flank), (0.0, tip), *flank[::-1]]
    rim = [(TURN * t / teeth + a, r) for t in range(teeth) for a, r in tooth]
    count, share, steps = len(rim), len(rim) // sectors, 12

    def polar(points):
        return [(r * math.cos(a), r * math.sin(a)) for a, r in points]

    def teeth_at(height, limit=tip):
        return polar((a + 0.008 * height, min(r, limit)) for a, r in rim), height

    def bore(radius, key):
        return polar((a, key / math.sin(a) if math.sin(a) > 0 and abs(math.cos(a)) * radius < 2.4 else radius)
                     for a in (TURN * i / count for i in range(count)))

    def place(u, v, h):
        return (u, -h, v + tip)

    def side(sign):
        """Loops of one side, from the rim to the web and from the web to the bore."""
        outer = [(circle(r, count), sign * h) for r, h in ((28.5, half_width), (27.7, half_width - 0.8), (27.0, 4.5), (26.0, 3.5))]
        inner = [(circle(r, count), sign * h) for r, h in ((14.0, 3.5), (13.0, 4.5), (12.4, half_width + 3), (11.4, half_width + 4))]
        return ([teeth_at(sign * half_width, tip - 1.2), *outer],
                [*inner, (bore(8.0, 10.6), sign * (half_width + 4)), (bore(7.2, 10.0), sign * (half_width + 3.2))])

    (front_outer, front_inner), (back_outer, back_inner) = side(1), side(-1)
    layers = [teeth_at((half_width - 1.2) * k / 4) for k in range(-4, 5)]
    triangles = loft(back_outer[::-1] + layers + front_outer, place) + loft(front_inner + back_inner[::-1], place)
    (outer, depth), inner = front_outer[-1], front_inner[0][0]
    for first in range(0, count, share):  # the web: sectors with a hole in each
        center = polar([(TURN * (first + share / 2) / count, 20.0)])[0]
        arc = [i % count for i in range(first, first + share + 1)]
        sides = [[tuple(p + (q - p) * n / steps for p, q in zip(outer[i], inner[i])) for n in range(1, steps)] for i in (arc[-1], arc[0])]
        edge = [outer[i] for i in arc] + sides[0] + [inner[i] for i in arc[::-1]] + sides[1][::-1]
        toward = [unit((x - center[0], y - center[1])) for x, y in edge]
        hole = [([(center[0] + r * x, center[1] + r * y) for x, y in toward], h) for r, h in ((4.6, depth), (4, depth - 0.6))]
        triangles += loft([(edge, depth), *hole, *((outline, -h) for outline, h in hole[::-1]), (edge, -depth)], place)
    write_stl(path, triangles)


SCUTES = [(x, 0.0) for x in (-0.86, -0.45, 0.0, 0.45, 0.86)] + [(x, 0.56) for x in (-0.68, -0.23, 0.23, 0.68)]  # plates of the shell


def scute(p):
    """How much nearer the nearest plate of the shell is than the next one, and the distance from its middle."""
    row = sorted((p[0] - x) * (p[0] - x) + (p[2] - z) * (p[2] - z) for x, z in SCUTES)
    return math.sqrt(row[1]) - math.sqrt(row[0]), math.sqrt(row[0])


def turtle_parts(p):
    """Distances from shell, rim, belly, skin and eyes of a turtle that looks along x; p is in its half z >= 0."""
    shell = ellipsoid(p, (0.0, 0.38, 0.0), (1.0, 0.66, 0.8))
    if abs(shell) < 0.1:
        groove = max(0.0, 1 - scute(p)[0] / 0.09)
        shell += 0.028 * groove * groove * (3 - 2 * groove)
    if p[0] < 0:
        skin = limb(p, (-0.9, 0.32, 0.0), (-1.35, 0.16, 0.0), 0.12, 0.02)
        hip, foot = (-0.6, 0.2, 0.45), (-0.88, 0.13, 0.74)
    else:
        skin = blend(ellipsoid(p, (1.5, 0.72, 0.0), (0.25, 0.21, 0.2)), ellipsoid(p, (1.68, 0.66, 0.0), (0.15, 0.12, 0.15)), 0.1)
        skin = blend(skin, limb(p, (0.75, 0.26, 0.0), (1.4, 0.64, 0.0), 0.2, 0.14), 0.12)
        hip, foot = (0.6, 0.2, 0.5), (0.9, 0.13, 0.82)
    leg = limb(p, hip, foot, 0.21, 0.17)
    for x, z in ((0.16, -0.04), (0.13, 0.08), (0.03, 0.14)) if leg < 0.2 else ():  # toes
        leg = blend(leg, ellipsoid(p, (foot[0] + x, 0.05, foot[2] + z), (0.09, 0.07, 0.08)), 0.06)
    return (max(shell, 0.36 - p[1]), ellipsoid(p, (0.0, 0.36, 0.0), (1.12, 0.1, 0.92)), ellipsoid(p, (0.0, 0.3, 0.0), (0.95, 0.14, 0.72)),
            blend(skin, max(leg, -p[1]), 0.08), ellipsoid(p, (1.6, 0.78, 0.155), (0.06, 0.06, 0.06)))


def turtle_distance(p):
    shell, rim, belly, skin, eye = turtle_parts((p[0], p[1], abs(p[2])))
    return min(blend(blend(shell, rim, 0.08), belly, 0.1), skin, eye)


def turtle_color(p):
    shell, rim, belly, skin, eye = turtle_parts((p[0], p[1], abs(p[2])))
    border, middle = scute((p[0], p[1], abs(p[2])))
    color = (196, 168, 96)
    if shell < min(rim, belly):
        color = mix((84, 57, 30), (196, 140, 62), min(border / 0.3, 1.0) * (0.75 + 0.25 * math.cos(40 * middle)))
    elif rim < belly:
        color = mix((92, 64, 34), (184, 140, 76), 6 * (math.cos(26 * math.atan2(p[2], p[0])) + 0.8))
    spots = math.sin(31 * p[0]) * math.sin(33 * p[1] + 2) * math.sin(32 * abs(p[2]) + 0.8)
    color = mix(mix((112, 128, 70), (164, 172, 98), 5 * (spots - 0.2)), color, 0.5 + 20 * (skin - min(shell, rim, belly)))
    mouth = 1 - abs(p[1] - 0.63) / 0.03 if p[0] > 1.56 else 0
    return map(round, mix((12, 10, 8), mix(color, (40, 44, 24), mouth), 40 * (eye - 0.004)))


def turtle(path):
    """A turtle: a smooth union of ellipsoids and cones, with a colour at each vertex."""
    points, quads = surface_net(turtle_distance, (0.1, 0.5, 0.0), 0.0285, 128)
    body, d = bytearray(), 0.006
    for x, y, z in points:
        value = turtle_distance((x, y, z))
        slope = [turtle_distance(p) - value for p in ((x + d, y, z), (x, y + d, z), (x, y, z + d))]
        body += struct.pack("<6f3B", x, y, z, *unit(slope), *turtle_color((x, y, z)))
    for quad in quads:
        body += struct.pack("<B4i", 4, *quad)
    write_ply(path, ("x", "y", "z", "nx", "ny", "nz"), body, len(points), len(quads))


def room(path):
    """The scan of a corner of a room: boards, a rug, a table and a chair, a bowl of fruit, a plant, a picture and a window."""
    scan = Scan(3900)
    white, wood, oak = (244, 243, 238), (150, 98, 58), (196, 152, 104)

    def boards(a, b):
        row = int(b * 14)
        tone = (0.84 + 0.032 * ((row * 7 + int(a * 2.5 + row * 0.37 % 1) * 5) % 6)) * (0.7 if b * 14 % 1 < 0.08 else 1)
        return mix((0, 0, 0), (186, 146, 104), tone)

    def window(a, b):
        x, y = abs(a - 0.62) / 0.2, (b - 0.62) / 0.26
        if x < 1 and abs(y) < 1:
            return white if x > 0.9 or abs(y) > 0.92 or x < 0.06 else mix((120, 168, 96), (168, 208, 244), 3 * y + 1)
        return white if b < 0.05 else (150, 178, 178)

    def painting(a, b):
        if min(a, 1 - a, b, 1 - b) < 0.06:
            return (46, 36, 30)
        if (a - 0.66) ** 2 + (b - 0.66) ** 2 < 0.012:
            return (250, 226, 150)
        if b < 0.36 + 0.14 * math.sin(7 * a):
            return (36, 74, 92) if b < 0.24 + 0.1 * math.sin(5 * a + 2) else (66, 122, 124)
        return mix((244, 170, 110), (222, 96, 84), 1.6 * b - 0.5)

    scan.patch((0, 0, 0), (2.7, 0, 0), (0, 0, 2.7), boards)
    scan.patch((0, 0, 0), (2.7, 0, 0), (0, 2.1, 0), window)
    scan.patch((0, 0, 0), (0, 0, 2.7), (0, 2.1, 0), lambda a, b: white if b < 0.05 else (226, 214, 190), 0.92)
    scan.patch((0.55, 0.02, 0.75), (1.8, 0, 0), (0, 0, 1.5),
               lambda a, b: (214, 200, 172) if 0.06 < min(a, 1 - a, b, 1 - b) < 0.1 else (150, 52, 48))
    scan.patch((0.02, 1.0, 1.0), (0, 0, 1.05), (0, 0.75, 0), painting)
    scan.density = 7000
    scan.box((0.8, 0.68, 0.75), (1.95, 0.75, 1.5), oak)  # table and chair
    scan.box((1.2, 0.41, 1.5), (1.62, 0.47, 1.92), wood)
    for k in range(4):
        x, z = k % 2, k // 2
        scan.box((0.84 + x, 0, 0.79 + 0.61 * z), (0.91 + x, 0.7, 0.86 + 0.61 * z), oak)
        scan.box((1.2 + 0.37 * x, 0, 1.5 + 0.37 * z), (1.25 + 0.37 * x, 0.43 + 0.52 * z, 1.55 + 0.37 * z), wood)
    for y in (0.62, 0.8):
        scan.box((1.25, y, 1.885), (1.57, y + 0.12, 1.905), wood)
    scan.round((0.42, 0, 0.42), [(0.16, 0), (0.23, 0.36), (0.25, 0.36), (0.25, 0.42), (0.21, 0.42), (0.2, 0.36), (0, 0.36)], (186, 92, 58))
    for k in range(22):  # leaves
        a, length, rise = 2.4 * k, 0.42 + 0.05 * (k * 7 % 5), 0.45 + 0.045 * k
        for _ in range(600):
            t, w = scan.random(), 2 * scan.random() - 1
            across = w * max(0.006, 0.075 * math.sin(math.pi * max(0.0, 1.08 * t - 0.08)))
            out, up = length * t, 0.38 + rise * (1 - (1 - t) ** 2) - 0.5 * length * t**3 - 0.3 * abs(across)
            green = mix((60, 128, 52), (150, 190, 96), 0.9 - 6 * abs(w)) if t > 0.3 else (84, 140, 60)
            place = (0.42 + out * math.cos(a) - across * math.sin(a), up, 0.42 + out * math.sin(a) + across * math.cos(a))
            scan.point(place, green, 0.75 + 0.35 * t)
    scan.density = 14000
    scan.round((1.1, 0.75, 1.1), [(0.06, 0.0), (0.1, 0.04), (0.16, 0.1), (0.15, 0.1), (0.0, 0.05)], (70, 110, 170))
    scan.round((1.6, 0.75, 1.0), [(0.045, 0.0), (0.05, 0.11), (0.044, 0.11), (0.04, 0.02), (0.0, 0.02)], (238, 232, 220))
    for x, y, z, color in ((1.05, 0.86, 1.12, (232, 130, 30)), (1.15, 0.86, 1.07, (190, 40, 36)), (1.11, 0.88, 1.17, (150, 176, 50))):
        scan.round((x, y, z), [(0.06 * math.sin(a), -0.06 * math.cos(a)) for a in (math.pi * k / 8 for k in range(9))], color)
    write_ply(path, "xyz", scan.body, scan.count)


def main():
    if len(sys.argv) not in (2, 4):
        sys.exit(__doc__)
    folders = [pathlib.Path(name) for name in sys.argv[1::2]]
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    for name, write in (("camera.glb", camera), ("turtle.ply", turtle), ("gear.stl", gear), ("room.ply", room)):
        model = folders[0] / name
        write(model)
        if len(folders) == 2:
            command = [sys.argv[2], model, (folders[1] / name).with_suffix(".png"), "--size", "320x240"]
            done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
            if done.returncode or "warning:" in done.stderr:
                sys.exit(f"{name}: exit code {done.returncode}\n{done.stderr}")


if __name__ == "__main__":
    main()
