"""Objects with what a trimesh.Trimesh, its visuals and a trimesh.Scene offer, for where trimesh is not installed."""
import numpy as np


class Part:
    """Members as attributes."""

    def __init__(self, **members):
        self.__dict__.update(members)


class Visual:
    """ColorVisuals: defined once it has colours, which are kept as bytes."""

    def __init__(self, mesh):
        self.mesh, self.colors, self.kind = mesh, None, None

    @property
    def defined(self):
        return self.kind is not None

    def set(self, kind, colors):
        colors = np.asarray(colors)
        colors = np.round(colors * 255).astype(np.uint8) if colors.dtype.kind == "f" else colors.astype(np.uint8)
        count = len(self.mesh.vertices if kind == "vertex" else self.mesh.faces)
        colors = np.broadcast_to(colors, (count, colors.shape[-1]))
        if colors.shape[1] == 3:
            colors = np.concatenate([colors, np.full((count, 1), 255, np.uint8)], axis=1)
        self.kind, self.colors = kind, colors

    vertex_colors = property(lambda self: self.colors, lambda self, value: self.set("vertex", value))
    face_colors = property(lambda self: self.colors, lambda self, value: self.set("face", value))


class Trimesh:
    """Vertices and faces; normals are made of them."""

    def __init__(self, vertices, faces, vertex_colors=None, process=True):
        self.vertices = np.array(vertices, np.float64)
        self.faces = np.array(faces, np.int64)
        self.visual = Visual(self)
        if vertex_colors is not None:
            self.visual.vertex_colors = vertex_colors

    @property
    def triangles(self):
        return self.vertices[self.faces]

    @property
    def face_normals(self):
        a, b, c = self.triangles.transpose(1, 0, 2)
        made = np.cross(b - a, c - a)
        return made / np.linalg.norm(made, axis=1, keepdims=True)

    @property
    def vertex_normals(self):
        made = np.zeros_like(self.vertices)
        for k in range(3):
            np.add.at(made, self.faces[:, k], self.face_normals)
        return made / np.linalg.norm(made, axis=1, keepdims=True)

    @property
    def bounds(self):
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def apply_transform(self, matrix):
        self.vertices = self.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        return self

    def copy(self):
        return Trimesh(self.vertices, self.faces)


def rotation(angle, axis):
    """As in trimesh.transformations: the matrix (4, 4) of a turn by radians about an axis, after Rodrigues."""
    x, y, z = np.asarray(axis, np.float64) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def box(extents):
    """As in trimesh.creation."""
    corners = np.array([[i >> k & 1 for k in range(3)] for i in range(8)]) - 0.5
    faces = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7]
    return Trimesh(corners * extents, np.reshape(faces, (-1, 3)))


def uv_sphere(radius=1.0, count=10):
    """As in trimesh.creation, without faces that have no area."""
    theta, phi = np.meshgrid(np.linspace(0, np.pi, count + 1)[1:-1], np.arange(2 * count) * np.pi / count, indexing="ij")
    ring = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
    faces, wide = [], 2 * count
    for i in range(count - 2):
        for j in range(wide):
            a, b = i * wide + j, i * wide + (j + 1) % wide
            faces += [(a, a + wide, b), (b, a + wide, b + wide)]
    top, bottom = len(ring), len(ring) + 1
    for j in range(wide):
        last = (count - 2) * wide
        faces += [(top, j, (j + 1) % wide), (bottom, last + (j + 1) % wide, last + j)]
    return Trimesh(radius * np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]]), faces)


def body():
    """A figure of balls, as a body model stands: y points up, 1.8 high, centred, one mesh."""
    parts = [((0, 0.75, 0), (0.12, 0.15, 0.13)), ((0, 0.3, 0), (0.22, 0.32, 0.14)), ((0, -0.05, 0), (0.2, 0.15, 0.14))]
    for side in (-1, 1):
        parts += [((side * 0.12, -0.45, 0), (0.1, 0.42, 0.1)), ((side * 0.36, 0.3, 0.05), (0.22, 0.08, 0.08))]
    vertices, faces = [], []
    for middle, radii in parts:
        ball = uv_sphere(1.0, 7)
        faces.append(ball.faces + sum(map(len, vertices)))
        vertices.append(ball.vertices * radii + middle)
    return Trimesh(np.concatenate(vertices), np.concatenate(faces))


class Graph:
    """The graph of a trimesh.Scene: node -> matrix and name of the geometry."""

    def __init__(self, nodes):
        self.nodes = nodes
        self.nodes_geometry = list(nodes)

    def __getitem__(self, name):
        return self.nodes[name]


def scene(*placed):
    """A trimesh.Scene of meshes, each with a matrix."""
    geometry = {f"geometry_{i}": mesh for i, (mesh, _) in enumerate(placed)}
    return Part(geometry=geometry, graph=Graph({f"node_{i}": (matrix, f"geometry_{i}") for i, (_, matrix) in enumerate(placed)}))
