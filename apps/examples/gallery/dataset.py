# A data set by K and [R|t]
# Calibrated cameras look at a scene from a circle; each view has a picture and a depth map in world units.
import os

import numpy as np

import halflit

K, size = np.array([[180, 0, 79.5], [0, 180, 59.5], [0, 0, 1]]), (160, 120)
scene = halflit.Scene.load(os.environ["HALFLIT_EXAMPLES"] + "/knot.glb")
target, radius = scene.bounds.mean(axis=0), 1.15 * np.linalg.norm(np.ptp(scene.bounds, axis=0))
cameras = []
for angle in np.arange(6) * np.pi / 3:
    away = np.array([np.sin(angle), 0.45, np.cos(angle)])
    right = np.array([np.cos(angle), 0, -np.sin(angle)])
    ahead = -away / np.linalg.norm(away)
    R = np.array([right, np.cross(ahead, right), ahead])  # rows: the camera's x, y (down) and z in the world
    cameras.append(halflit.Camera.from_intrinsics(K, size, R, -R @ (target + radius * away)))
data = scene.render_arrays(cameras, size, samples=1, aovs=["depth"])
np.savez_compressed("dataset.npz", K=K, poses=[camera.matrix for camera in cameras], **data)
grey = np.clip(255 * (1.6 - data["depth"] / radius), 0, 255).astype(np.uint8)[..., None]  # near is bright
depth = np.concatenate([grey, grey, grey, np.full_like(grey, 255)], -1)
rows = [np.hstack(images[k : k + 3]) for k in (0, 3) for images in (data["color"], depth)]
np.vstack(rows).view(halflit.Picture).save("dataset.png")
