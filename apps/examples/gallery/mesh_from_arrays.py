# A mesh from arrays, with vertex colours
# A (2, 3) torus knot is computed by numpy; each vertex has a colour of its own.
import numpy as np

import halflit

u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 400), np.linspace(0, 2 * np.pi, 40))


def middle(t):
    return np.stack([(2 + np.cos(3 * t)) * np.cos(2 * t), np.sin(3 * t), (2 + np.cos(3 * t)) * np.sin(2 * t)], -1)


along = middle(u + 1e-4) - middle(u - 1e-4)
side, up = np.cross(along, middle(u)), np.cross(np.cross(along, middle(u)), along)
side, up = (array / np.linalg.norm(array, axis=-1, keepdims=True) for array in (side, up))
normals = np.cos(v)[..., None] * side + np.sin(v)[..., None] * up
colors = 0.5 + 0.45 * np.cos(u[..., None] + [0, 2, 4])
vertices, normals, colors = (array.reshape(-1, 3) for array in (middle(u) + 0.45 * normals, normals, colors))
i = (np.arange(39)[:, None] * 400 + np.arange(399))[..., None]
faces = (i + [0, 1, 400, 1, 401, 400]).reshape(-1, 3)
scene = halflit.Scene()
scene.add_mesh(vertices, faces, normals=normals, colors=colors, material={"roughness": 0.35})
scene.add_ground()
scene.render((480, 360), elevation=35).save("knot.png")
