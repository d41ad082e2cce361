"""Four thousand small pictures in one process: memory, files and threads do not grow."""
import ctypes
import os
import time
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, box

PICTURES = 4000
LIBC = ctypes.CDLL(None)


def resident_kb():
    """Without what the allocator keeps for later, which comes and goes by megabytes."""
    if hasattr(LIBC, "malloc_trim"):
        LIBC.malloc_trim(0)
    with open("/proc/self/status", encoding="ascii") as file:
        return int(next(line.split()[1] for line in file if line.startswith("VmRSS")))


class Leak(unittest.TestCase):
    def test_thousands_of_pictures(self):
        model, scene = box(), halflit.Scene()
        texture = np.full((8, 8, 3), 200, np.uint8)
        scene.add_mesh(CORNERS, FACES)
        kinds = (
            lambda i: halflit.render(model, 32),
            lambda i: halflit.render((CORNERS, FACES), 32, aovs=["depth", "id"]),
            lambda i: scene.render(32, azimuth=i % 360),
            lambda i: textured(texture).render(32),
        )

        def draw(first, count):
            for i in range(first, first + count):
                kinds[i % 4](i)
                if i % 50 == 0:  # failures do not leak either
                    for wrong in (b"nothing", b'{"asset":{"version":"1.0"}}'):
                        with self.assertRaises(halflit.Error):
                            halflit.render(wrong, 32)

        draw(0, 1000)  # the pool of threads is there
        before, files, threads = resident_kb(), len(os.listdir("/proc/self/fd")), len(os.listdir("/proc/self/task"))
        start, grown = time.perf_counter(), []
        for i in range(5):
            last = resident_kb()
            draw(i * PICTURES // 5, PICTURES // 5)
            grown.append(resident_kb() - last)
        took = time.perf_counter() - start
        print(f"{PICTURES} pictures in {took:.1f} s: memory of {before} kB grew by {grown} kB, a fifth of them each")
        # The allocator takes 10 to 20 MB more at some point, once. A leak of 1 kB a picture would be 800 kB in each fifth.
        self.assertLess(sorted(grown)[1], 400)
        self.assertEqual(len(os.listdir("/proc/self/fd")), files)
        self.assertLessEqual(len(os.listdir("/proc/self/task")), threads + 1)


def textured(texture):
    scene = halflit.Scene()
    index = scene.add_texture(texture)
    scene.add_mesh(CORNERS, FACES, uv=CORNERS[:, :2], material={"base_color_texture": index, "name": "a"})
    return scene


if __name__ == "__main__":
    unittest.main()
