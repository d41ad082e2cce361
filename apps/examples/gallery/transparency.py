# Transparent layers in any order
# Three panes go through each other; every sample sorts its layers by depth, so the order of the list does not count.
import numpy as np

import halflit

scene = halflit.Scene()
square = np.array([[-1.0, 0, 0], [1, 0, 0], [-1, 2, 0], [1, 2, 0]])
for k, color in enumerate(((0.95, 0.15, 0.1, 0.75), (0.1, 0.65, 0.2, 0.75), (0.1, 0.3, 0.95, 0.75))):
    angle = np.pi * k / 3
    turn = np.eye(4)
    turn[[0, 0, 2, 2], [0, 2, 0, 2]] = np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)
    look = {"base_color": color, "alpha_mode": "blend", "double_sided": True, "roughness": 0.4}
    scene.add_mesh(square, np.array([[0, 1, 2], [1, 3, 2]]), material=look, matrix=turn)
camera = halflit.Camera.look_at((0.9, 2.4, 3.6), (0, 0.95, 0), fov_y_rad=0.78)
scene.render((480, 360), camera=camera, background="#f2efe8", samples=8).save("layers.png")
