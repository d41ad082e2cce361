# Shadows of wrapped light
# Light of a wrapped lobe reaches behind the terminator: a hard shadow cuts it off, "soft_split" lets it fade. Off, hard, soft_split.
import numpy as np

import halflit

i = np.arange(64)[:, None] * 129 + np.arange(128)
faces = np.stack([i, i + 129, i + 1, i + 1, i + 129, i + 130], -1).reshape(-1, 3)
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 129), np.linspace(0, np.pi, 65))
ball = np.stack([np.sin(u) * np.sin(v), np.cos(v), np.cos(u) * np.sin(v)], -1).reshape(-1, 3)
scene = halflit.Scene()
clay = {"base_color": (0.85, 0.72, 0.6), "lobe": ("sloan", 0.8), "roughness": 1}
mesh = scene.add_mesh(ball, faces, normals=ball, material=clay)
scene.add_instance(mesh, [[0.35, 0, 0, 0.95], [0, 0.35, 0, 0.7], [0, 0, 0.35, 0.7], [0, 0, 0, 1]])
scene.add_light(direction=(-1, -0.55, -0.5), color=(1.2, 1.15, 1.05))
camera = halflit.Camera.look_at((0.25, 0.3, 6.2), (0.25, 0.08, 0), fov_y_rad=0.5)
how = {"size": (200, 240), "camera": camera, "studio": "never", "ambient": (0.02, 0.025, 0.03), "exposure": 1, "background": "#20242a"}
pictures = [scene.render(shadows=kind, **how) for kind in ("off", "hard", "soft_split")]
np.hstack(pictures).view(halflit.Picture).save("shadows.png")
