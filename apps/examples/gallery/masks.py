# Segmentation masks with names
# The plane "id" tells the part of each pixel; a mask and a box of pixels for each name go into a JSON file.
import json

import numpy as np

import halflit

i = np.arange(33)[:, None] * 65 + np.arange(64)
faces = np.stack([i, i + 65, i + 1, i + 1, i + 65, i + 66], -1)[:32].reshape(-1, 3)
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 65), np.linspace(0, np.pi, 33))
ball = np.stack([np.sin(u) * np.sin(v), np.cos(v), np.cos(u) * np.sin(v)], -1).reshape(-1, 3)
scene = halflit.Scene()
mesh = scene.add_mesh(ball, faces, normals=ball, place=False)
bodies = {"body": (0, 0, 0, 1), "head": (0, 1.45, 0, 0.7), "left hand": (-1.2, 0.25, 0.3, 0.35), "right hand": (1.2, 0.25, 0.3, 0.35)}
for name, (x, y, z, size) in bodies.items():
    scene.add_instance(mesh, np.array([[size, 0, 0, x], [0, size, 0, y], [0, 0, size, z], [0, 0, 0, 1]]), name=name)
picture = scene.render((240, 360), azimuth=20, elevation=12, samples=1, aovs=["id"])
masks, overlay = {}, np.array(picture)
for index, tint in zip(range(4), ([230, 80, 60], [70, 160, 240], [250, 190, 40], [90, 200, 110])):
    rows, columns = np.nonzero(picture.aovs["id"] == index + 1)
    masks[scene.name("instance", index)] = [int(value) for value in (columns.min(), rows.min(), columns.max(), rows.max())]
    overlay[rows, columns, :3] = tint
json.dump(masks, open("masks.json", "w"))
np.hstack([picture, overlay]).view(halflit.Picture).save("masks.png")
