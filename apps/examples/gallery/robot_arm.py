# A robot arm, posed by matrices
# Each link's matrix is that of the link before times a joint; a new pose moves the instances and nothing else.
import numpy as np

import halflit

faces = np.reshape([0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3], (12, 3))


def joint(height, angle, a=0, b=1):  # a turn in the plane of two axes, at this height
    matrix = np.eye(4)
    matrix[[a, a, b, b, 1], [a, b, a, b, 3]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle), height
    return matrix


scene = halflit.Scene()
for x, y, color in ((0.6, 0.3, "#404854"), (0.3, 1.4, "#e8702a"), (0.2, 1.6, "#f0f0f0"), (0.14, 1.2, "#e8702a")):
    box = np.array([[i, j, k] for i in (-x, x) for j in (0, y) for k in (-x, x)])
    scene.add_mesh(box, faces, material={"base_color": color, "roughness": 0.4})
pose = joint(0, 0.6, 2, 0)
for link, turn in enumerate((joint(0, 0), joint(0.3, -0.35), joint(1.3, -0.9), joint(1.5, -0.8))):
    pose = pose @ turn
    scene.set_instance(link, pose)
scene.add_ground()
scene.render((480, 360), azimuth=10, elevation=18, samples=8).save("arm.png")
