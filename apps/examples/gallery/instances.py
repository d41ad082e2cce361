# Ten thousand instances
# One cube is placed by an array of 10,000 matrices; each instance has the height and the colour of a wave.
import numpy as np

import halflit

corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (0, 1) for z in (-0.5, 0.5)])
faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
scene = halflit.Scene()
cube = scene.add_mesh(corners, np.array(faces), place=False)
x, z = (axis.ravel() for axis in np.meshgrid(np.arange(100) - 49.5, np.arange(100) - 49.5))
wave = np.sin(np.hypot(x, z) / 5) * np.exp(-np.hypot(x, z) / 40)
matrices = np.zeros((10000, 4, 4))
matrices[:, [0, 1, 2, 3], [0, 1, 2, 3]] = np.stack([np.full(10000, 0.9), 10 + 7 * wave, np.full(10000, 0.9), np.ones(10000)], 1)
matrices[:, 0, 3], matrices[:, 2, 3] = x, z
for index in scene.add_instances(cube, matrices):
    share = 0.5 + 0.5 * wave[index]
    scene.set_instance(index, color=(share, 0.25 + 0.3 * share, 1 - 0.9 * share))
scene.render((480, 360), azimuth=30, elevation=38, zoom=1.05, sky_shadows=64).save("instances.png")
