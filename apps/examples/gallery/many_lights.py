# Eighty point lights
# Lights in all colours hang above a floor of columns; lights out of reach of a tile cost nothing there.
import numpy as np

import halflit

corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (0, 1) for z in (-0.5, 0.5)])
faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
scene = halflit.Scene()
stone = {"base_color": (0.6, 0.6, 0.6), "roughness": 0.4}
floor = [[24, 0, 0, 0], [0, 0.1, 0, -0.1], [0, 0, 24, 0], [0, 0, 0, 1]]
cube = scene.add_mesh(corners, np.array(faces), material=stone, matrix=floor)
for x in range(-8, 9, 4):
    for z in range(-8, 9, 4):
        scene.add_instance(cube, [[0.7, 0, 0, x], [0, 2.2, 0, 0], [0, 0, 0.7, z], [0, 0, 0, 1]])
for k in range(80):
    angle, radius = 2.4 * k, 1.25 * np.sqrt(k)  # a sunflower's angles
    hue = 2 * np.pi * k / 13
    color = 0.8 * (0.5 + 0.5 * np.cos(hue + np.array([0, 2.1, 4.2])))
    scene.add_light("point", position=(radius * np.cos(angle), 0.9, radius * np.sin(angle)), color=color, range=4)
camera = halflit.Camera.look_at((8, 10, 19), (0.5, 0, 0.5), fov_y_rad=0.68)
scene.render((480, 360), camera=camera, studio="never", exposure=1, background=(0, 0, 0), shadows="off").save("lights.png")
