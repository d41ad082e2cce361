"""Shapes for the models of showcase.py: lofts, the surface where a distance is 0, and scans of coloured points."""
import math
import struct

TURN = 2 * math.pi


# ---- surfaces: triangles between loops ----------------------------------------------------------------------------------
def circle(radius, count=96, depth=0.0):
    """A circle; a depth gives it ribs of four points each."""
    return [(r * math.cos(a), r * math.sin(a)) for i in range(count) for r, a in [(radius - depth * (i // 2 % 2), TURN * i / count)]]


def rounded(width, height, radius, corner=10):
    """A rectangle with round corners."""
    return [(x * (width / 2 - radius) + radius * math.cos(a), y * (height / 2 - radius) + radius * math.sin(a))
            for k, (x, y) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))) for i in range(corner + 1)
            for a in [TURN * (k + i / corner) / 4]]


def loft(loops, place):
    """Triangles between loops (outline, height), each counter-clockwise seen from above; place(u, v, height) is the point in space."""
    rings, triangles = [[place(u, v, height) for u, v in outline] for outline, height in loops], []
    for low, high in zip(rings, rings[1:]):
        for i, a in enumerate(low):
            b, c, d = low[(i + 1) % len(low)], high[(i + 1) % len(low)], high[i]
            triangles += [t for t in ((a, b, c), (a, c, d)) if t[0] != t[1] != t[2] != t[0]]
    return triangles


def solid(loops, place):
    """A loft that is closed at both ends."""
    low, high = [([(0.0, 0.0)] * len(outline), height) for outline, height in (loops[0], loops[-1])]
    return loft([low, *loops, high], place)


def plate(outline, low, high, edge, place):
    """A solid with the outline outline(0), whose edges are round; outline(inset) is a smaller one."""
    steps = [(edge * (1 - math.sin(a)), edge * (1 - math.cos(a))) for a in (TURN * k / 16 for k in range(5))]
    return solid([(outline(inset), low + h) for inset, h in steps] + [(outline(inset), high - h) for inset, h in steps[::-1]], place)


def bar(width, height, radius):
    """An outline for plate."""
    return lambda inset: rounded(width - 2 * inset, height - 2 * inset, radius - inset)


def lathe(profile, place):
    return loft([(circle(radius), height) for radius, height in profile], place)


def upright(x, y, z):
    """Places a loft so that its heights go up."""
    return lambda u, v, h: (x + u, y + h, z - v)


def facing(x, y, z):
    """Places a loft so that its heights go to the front."""
    return lambda u, v, h: (x + u, y + v, z + h)


def unit(v):
    length = math.sqrt(sum(x * x for x in v)) or 1.0
    return tuple(x / length for x in v)


def smooth(triangles, crease=0.8):
    """Geometry with normals: a corner's is the mean of the faces there whose normals have a cosine above crease with its face's."""
    faces, at, vertices, indices = [], {}, {}, []
    for a, b, c in triangles:
        e, f = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        cross = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
        faces.append((unit(cross), cross))
        for corner in (a, b, c):
            at.setdefault(corner, []).append(faces[-1])
    for corners, (n, _) in zip(triangles, faces):
        for corner in corners:
            near = [w for m, w in at[corner] if m[0] * n[0] + m[1] * n[1] + m[2] * n[2] > crease]
            normal = tuple(round(x, 5) for x in unit([sum(x) for x in zip(*near)]))
            indices.append(vertices.setdefault((corner, normal), len(vertices)))
    return [p for p, _ in vertices], [n for _, n in vertices], [(0.0, 0.0)] * len(vertices), indices


# ---- the surface where a distance is 0 ----------------------------------------------------------------------------------
def blend(a, b, width):
    """The smooth minimum of two distances."""
    near = width - abs(a - b)
    return min(a, b) - (near * near / (4 * width) if near > 0 else 0.0)


def ellipsoid(p, center, radii):
    """About the distance from an ellipsoid."""
    a, b, c = radii
    x, y, z = (p[0] - center[0]) / a, (p[1] - center[1]) / b, (p[2] - center[2]) / c
    k = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / a, y / b, z / c
    return k * (k - 1) / (math.sqrt(x * x + y * y + z * z) or 1.0)


def limb(p, a, b, thick, thin):
    """The distance from a round cone from a to b."""
    u, v, w = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    x, y, z = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    t = min(max((x * u + y * v + z * w) / (u * u + v * v + w * w), 0.0), 1.0)
    x, y, z = x - t * u, y - t * v, z - t * w
    return math.sqrt(x * x + y * y + z * z) - thick - t * (thin - thick)


def surface_net(distance, center, step, size):
    """A point in each cell of a grid that the surface distance = 0 crosses, and quads between them."""
    values, cells, quads, axes = {}, {}, [], ((1, 0, 0), (0, 1, 0), (0, 0, 1))

    def point(at):
        return tuple(center[a] + (at[a] - size / 2) * step for a in range(3))

    def visit(corner, edge):
        """Values at the grid's points near the surface: a cube is divided if the surface may cross it."""
        if abs(distance(point([c + edge / 2 for c in corner]))) > 1.3 * edge * step:
            return
        count = 3 if edge == 2 else 2
        for n in range(count**3):
            at = tuple(corner[a] + n // count**a % count * edge // 2 for a in range(3))
            if edge > 2:
                visit(at, edge // 2)
            elif at not in values:
                values[at] = distance(point(at))

    visit((0, 0, 0), size)
    for at, value in values.items():
        for axis in range(3):
            end = tuple(map(sum, zip(at, axes[axis])))
            if end in values and (value < 0) != (values[end] < 0):
                cut = point([a + value / (value - values[end]) * b for a, b in zip(at, axes[axis])])
                u, v = axes[axis - 2], axes[axis - 1]
                ring = [tuple(at[a] - m * u[a] - n * v[a] for a in range(3)) for m, n in ((0, 0), (1, 0), (1, 1), (0, 1))]
                quads.append(ring if value < 0 else ring[::-1])
                for cell in ring:
                    cells.setdefault(cell, []).append(cut)
    number = {cell: k for k, cell in enumerate(cells)}
    return [[sum(x) / len(x) for x in zip(*cuts)] for cuts in cells.values()], [[number[cell] for cell in quad] for quad in quads]


# ---- coloured points ----------------------------------------------------------------------------------------------------
class Scan:
    """Points as a scanner finds them: somewhat beside the surface, and in its colour under soft light."""

    def __init__(self, density):
        self.density, self.state, self.body, self.count = density, 20260101, bytearray(), 0

    def random(self):
        self.state = (self.state * 1103515245 + 12345) % 2**31
        return self.state / 2**31

    def spread(self, area):
        """Pairs of numbers below 1, evenly spread without rows."""
        return ((k * 0.7548776662 % 1, k * 0.5698402910 % 1) for k in range(int(area * self.density)))

    def point(self, p, color, light):
        light *= 0.94 + 0.12 * self.random()
        p = [x + (self.random() + self.random() + self.random() - 1.5) * 0.006 for x in p]
        self.body += struct.pack("<3f3B", *p, *(min(255, int(light * c)) for c in color))
        self.count += 1

    def patch(self, origin, u, v, color, light=1.0):
        """A rectangle; color may be a function of the place in it."""
        for a, b in self.spread(math.hypot(*u) * math.hypot(*v)):
            self.point([o + a * x + b * y for o, x, y in zip(origin, u, v)], color(a, b) if callable(color) else color, light)

    def box(self, low, high, color):
        w, h, d = (b - a for a, b in zip(low, high))
        self.patch((low[0], high[1], low[2]), (w, 0, 0), (0, 0, d), color, 1.05)
        for near, far in ((low, 0.6), (high, 0.85)):
            self.patch((low[0], low[1], near[2]), (w, 0, 0), (0, h, 0), color, far)
            self.patch((near[0], low[1], low[2]), (0, 0, d), (0, h, 0), color, 0.7)

    def round(self, center, profile, color):
        """A surface of revolution around an upright axis, through (radius, height) in turn."""
        for (r, y), (s, t) in zip(profile, profile[1:]):
            for turn, part in self.spread(math.pi * (r + s) * math.hypot(r - s, y - t)):
                out = math.sqrt(r * r + (s * s - r * r) * part)
                part = (out - r) / (s - r) if r != s else part
                at = (out * math.cos(TURN * turn), y + (t - y) * part, out * math.sin(TURN * turn))
                self.point(map(sum, zip(center, at)), color, 0.85 + 0.2 * math.cos(TURN * turn - 0.8))


def mix(a, b, t):
    t = min(max(t, 0.0), 1.0)
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def write_ply(path, names, body, points, faces=0):
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {points}", *(f"property float {name}" for name in names),
             *(f"property uchar {name}" for name in ("red", "green", "blue")),
             *([f"element face {faces}", "property list uchar int vertex_indices"] if faces else []), "end_header", ""]
    path.write_bytes("\n".join(lines).encode() + body)
