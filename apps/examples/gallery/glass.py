# Glass
# Transmission lets light through, thickness bends it, and attenuation colours it on its way.
import numpy as np

import halflit

i = np.arange(64)[:, None] * 129 + np.arange(128)
faces = np.stack([i, i + 129, i + 1, i + 1, i + 129, i + 130], -1).reshape(-1, 3)
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 129), np.linspace(0, np.pi, 65))
ball = np.stack([np.sin(u) * np.sin(v), np.cos(v), np.cos(u) * np.sin(v)], -1).reshape(-1, 3)
scene = halflit.Scene()
board = np.where((np.indices((16, 16)).sum(0) % 2)[..., None], 230, 40).astype(np.uint8).repeat(3, -1)
checks = {"base_color_texture": {"texture": scene.add_texture(board), "mag_filter": "nearest"}, "roughness": 0.9}
square = np.array([[-6, 0, -6], [6, 0, -6], [-6, 0, 6], [6, 0, 6.0]])
scene.add_mesh(square, np.array([[0, 2, 1], [1, 2, 3]]), uv=(square[:, [0, 2]] + 6) / 12, material=checks)
for x, color, rough in ((-2.3, (1, 1, 1), 0), (0, (0.25, 0.75, 0.45), 0), (2.3, (0.9, 0.5, 0.15), 0.35)):
    look = {"transmission": 1, "thickness": 1.5, "attenuation_color": color, "attenuation_distance": 1.2, "roughness": rough}
    place = [[1, 0, 0, x], [0, 1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]]
    scene.add_mesh(ball, faces, normals=ball, material=look, matrix=place)
camera = halflit.Camera.look_at((0, 3.4, 8), (0, 0.6, 0), fov_y_rad=0.65)
scene.render((480, 360), camera=camera).save("glass.png")
