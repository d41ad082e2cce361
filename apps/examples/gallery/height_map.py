# A height map as terrain
# A grid of heights becomes triangles whose colours follow height and slope; a low sun casts the shadows.
import numpy as np

import halflit

x, z = np.meshgrid(np.linspace(-3, 3, 241), np.linspace(-3, 3, 241))
waves = (0.9, 0.4, 1, 1.6), (-0.7, 1.3, 2, 2.2), (2.3, 1.9, 0, 6), (3.1, -4.2, 1, 14)
height = sum(np.sin(a * x + b * z + c) / d for a, b, c, d in waves)
height = np.maximum(height, -0.35) + np.where(height > -0.35, np.sin(9 * x + 7 * z) * np.sin(8 * x - 9 * z) / 60, 0)
slope = np.hypot(*np.gradient(height, 0.025))[..., None]
grass, rock, snow, water = np.array([[0.12, 0.22, 0.05], [0.25, 0.2, 0.16], [0.9, 0.92, 0.95], [0.03, 0.12, 0.2]])
colors = np.where(slope > 0.75, rock, np.where(height[..., None] > 0.75, snow, grass))
colors = np.where(height[..., None] <= -0.35, water, colors)
i = np.arange(240)[:, None] * 241 + np.arange(240)
faces = np.stack([i, i + 241, i + 1, i + 1, i + 241, i + 242], -1).reshape(-1, 3)
scene = halflit.Scene()
points = np.stack([x, height, z], -1).reshape(-1, 3)
scene.add_mesh(points, faces, normals="smooth", colors=colors.reshape(-1, 3), material={"lobe": ("sloan", 0.4), "roughness": 0.8})
scene.add_light(direction=(-1, -0.5, -0.4), color=(2.2, 1.8, 1.3))
scene.set_ambient((0.2, 0.28, 0.42), (0.06, 0.06, 0.05))
camera = halflit.Camera.look_at((2.6, 3.4, 5.6), (0.1, -0.2, -0.1), fov_y_rad=0.7)
scene.render((480, 360), camera=camera, background=(0.35, 0.5, 0.75), samples=8).save("terrain.png")
