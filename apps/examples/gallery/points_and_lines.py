# Points and lines
# The path of the Lorenz attractor as a line, and points at equal times, both in plain colours.
import numpy as np

import halflit

path = [(1.0, 1.0, 20.0)]
while len(path) < 6000:
    x, y, z = path[-1]
    path.append((x + 0.005 * 10 * (y - x), y + 0.005 * (x * (28 - z) - y), z + 0.005 * (x * y - 8 / 3 * z)))
path = np.array(path)[200:]
share = np.linspace(0, 1, len(path))[:, None]
colors = share * [1.0, 0.35, 0.05] + (1 - share) * [0.05, 0.35, 1.0]
steps = np.arange(len(path) - 1)
scene = halflit.Scene(up="z")
scene.add_mesh(path, np.stack([steps, steps + 1], 1), topology="lines", colors=colors, material={"unlit": True})
scene.add_mesh(path[::60], topology="points", material={"unlit": True})
scene.render((480, 360), azimuth=25, elevation=8, fit=16, background="#0b0e14", point_size=4, line_width=1.2, samples=8).save("lorenz.png")
