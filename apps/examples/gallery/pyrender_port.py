# A script for pyrender
# With its import changed, a script that was written for pyrender draws without OpenGL and without a display.
import numpy as np

import halflit
import halflit.compat.pyrender as pyrender  # in place of: import pyrender

u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(0, 2 * np.pi, 49))
positions = np.stack([(1 + 0.4 * np.cos(v)) * np.cos(u), 0.4 * np.sin(v), (1 + 0.4 * np.cos(v)) * np.sin(u)], -1).reshape(-1, 3)
normals = np.stack([np.cos(v) * np.cos(u), np.sin(v), np.cos(v) * np.sin(u)], -1).reshape(-1, 3)
i = np.arange(48)[:, None] * 97 + np.arange(96)
indices = np.stack([i, i + 97, i + 1, i + 1, i + 97, i + 98], -1).reshape(-1, 3)
material = pyrender.MetallicRoughnessMaterial(baseColorFactor=(0.2, 0.5, 0.9, 1), metallicFactor=0.1, roughnessFactor=0.35)
scene = pyrender.Scene(bg_color=(0.93, 0.93, 0.9, 1), ambient_light=(0.15, 0.15, 0.15))
scene.add(pyrender.Mesh([pyrender.Primitive(positions=positions, normals=normals, indices=indices, material=material)]))
pose = halflit.Camera.look_at((0.6, 2.0, 2.8), (0, 0, 0)).matrix
scene.add(pyrender.PerspectiveCamera(yfov=np.pi / 4), pose=pose)
scene.add(pyrender.DirectionalLight(color=np.ones(3), intensity=4), pose=halflit.Camera.look_at((2, 4, 2), (0, 0, 0)).matrix)
renderer = pyrender.OffscreenRenderer(480, 360)
color, depth = renderer.render(scene)
renderer.delete()
color.view(halflit.Picture).save("pyrender.png")
