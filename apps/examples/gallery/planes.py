# Depth, normal and id planes
# One call gives the picture and what each pixel shows: distance, normal and the number of the object.
import numpy as np

import halflit

scene = halflit.Scene.demo()
picture = scene.render((480, 270), samples=1, aovs=["depth", "normal", "id"])
depth, normal, number = (picture.aovs[name] for name in ("depth", "normal", "id"))


def shown(plane):
    """A plane of numbers from 0 to 1 as a picture."""
    pixels = np.zeros((270, 480, 4), np.uint8)
    pixels[..., :3], pixels[..., 3] = (255 * np.clip(plane, 0, 1) + 0.5), 255
    return pixels


seen = np.isfinite(depth)
near, far = depth[seen].min(), 15
colors = np.array([[(40 + 97 * k) % 256, (90 + 57 * k) % 256, (200 + 151 * k) % 256] for k in range(len(scene.nodes) + 64)]) / 255
top = np.hstack([picture, shown(1 - (np.where(seen, depth, far)[..., None] - near) / (far - near))])
bottom = np.hstack([shown(0.5 + 0.5 * normal), shown(colors[number])])
np.vstack([top, bottom])[::2, ::2].view(halflit.Picture).save("planes.png")
