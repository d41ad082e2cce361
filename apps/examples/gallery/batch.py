# Thumbnails on all cores
# Threads draw one thumbnail each, side by side, because the interpreter's lock is free while the library draws.
import concurrent.futures
import os

import numpy as np

import halflit

file = os.environ["HALFLIT_EXAMPLES"] + "/knot.glb"


def draw(azimuth):
    with halflit.Scene.load(file) as scene:
        return scene.render((120, 90), azimuth=azimuth, threads=1)


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    pictures = list(pool.map(draw, np.arange(16) * 22.5))
rows = [np.hstack(pictures[k : k + 4]) for k in range(0, len(pictures), 4)]
np.vstack(rows).view(halflit.Picture).save("thumbnails.png")
