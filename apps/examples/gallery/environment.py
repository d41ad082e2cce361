# Light from an environment, by spherical harmonics
# An image of the sky becomes 1, 4 and 9 numbers for each colour; of the light on a diffuse ball, nine leave little out.
import numpy as np

import halflit

rise, turn = np.meshgrid(np.linspace(np.pi / 2, -np.pi / 2, 64), np.linspace(-np.pi, np.pi, 128), indexing="ij")
sky = np.where(rise[..., None] > 0, [0.25, 0.5, 1.1], [0.25, 0.16, 0.08]) * np.ones((64, 128, 1))
glow = np.exp(-8 * ((rise - 0.3) ** 2 + (turn + 1.2) ** 2))[..., None] * [14.0, 7, 2.5]  # a low, wide, orange light on the left
i = np.arange(64)[:, None] * 129 + np.arange(128)
faces = np.stack([i, i + 129, i + 1, i + 1, i + 129, i + 130], -1).reshape(-1, 3)
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 129), np.linspace(0, np.pi, 65))
ball = np.stack([np.sin(u) * np.sin(v), np.cos(v), np.cos(u) * np.sin(v)], -1).reshape(-1, 3)
scene = halflit.Scene()
scene.add_mesh(ball, faces, normals=ball, material={"base_color": (0.8, 0.8, 0.8), "roughness": 0.5})
scene.set_environment((sky + glow).astype(np.float32), extract_suns=False)
how = {"size": (200, 200), "azimuth": 0, "elevation": 0, "fit": 8, "ev": 0.0, "background": "#15181c"}
pictures = [scene.render(environment_bands=bands, **how) for bands in (1, 2, 3)]
np.hstack(pictures).view(halflit.Picture).save("bands.png")
