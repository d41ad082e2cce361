# A normal map
# A texture of normals, computed from a pattern of bumps, gives a flat square relief; the left half shows it without.
import numpy as np

import halflit

y, x = np.mgrid[0:512, 0:512] / 64.0
height = np.maximum(0, 0.45**2 - (x % 1 - 0.5) ** 2 - (y % 1 - 0.5) ** 2) ** 0.5  # half spheres in a grid
down, right = np.gradient(height, 1 / 64)
normal = np.stack([-right, down, np.ones_like(height)], -1)
normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
scene = halflit.Scene()
bumps = scene.add_texture((127.5 * normal + 128).astype(np.uint8), color="normal")
corners = np.array([[-1, 0, -1], [1, 0, -1], [-1, 0, 1], [1, 0, 1]])
uv, tangents = (corners[:, [0, 2]] + 1) / 2, np.tile([1.0, 0, 0, 1], (4, 1))
look = {"base_color": (0.75, 0.3, 0.12), "roughness": 0.35, "normal_texture": bumps}
scene.add_mesh(corners, np.array([[0, 2, 1], [1, 2, 3]]), normals=np.tile([0.0, 1, 0], (4, 1)), uv=uv, tangents=tangents, material=look)
scene.add_light("point", position=(-1.2, 0.9, -0.6), color=(3, 3, 2.8))
camera = halflit.Camera.look_at((0, 1.9, 1.9), (0, 0, 0.08), fov_y_rad=0.75)
pictures = [scene.render((480, 360), camera=camera, studio="under_lights", normal_scale=scale, ev=0.0) for scale in (0, 1)]
np.hstack([pictures[0][:, :240], pictures[1][:, 240:]]).view(halflit.Picture).save("normal_map.png")
