"""Threads draw side by side, and Python's functions are called while a frame is drawn."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import halflit
from support import CORNERS, FACES, box


def wavy(side=2200):
    """Vertices and faces of a surface of 9.7 million triangles."""
    x, y = np.meshgrid(np.linspace(-1, 1, side, dtype=np.float32), np.linspace(-1, 1, side, dtype=np.float32))
    vertices = np.stack([x, 0.1 * np.sin(9 * x) * np.cos(7 * y), -y], axis=-1).reshape(-1, 3)
    i = (np.arange(side - 1, dtype=np.uint32)[:, None] * side + np.arange(side - 1, dtype=np.uint32))
    return vertices, np.stack([i, i + 1, i + side, i + 1, i + side + 1, i + side], axis=-1).reshape(-1, 3)


def stl(vertices, faces):
    """A binary STL."""
    rows = np.zeros(len(faces), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]))
    rows["corners"] = vertices[faces]
    return b" " * 80 + len(faces).to_bytes(4, "little") + rows.tobytes()


def heavy(threads=1):
    """A frame of some tenths of a second."""
    return halflit.render("demo", (1600, 900), samples=16, threads=threads)


def interrupted(work, after_s):
    """Repeats work until Ctrl-C, which comes after so many seconds; the seconds from then to its end."""
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after_s, interrupt)
    timer.start()
    try:
        while True:
            work()
    except KeyboardInterrupt:
        took = time.perf_counter() - sent[0]
    timer.join()
    return took


class Threads(unittest.TestCase):
    def test_two_threads_draw_at_once(self):
        # While two threads draw, a third one runs Python code: the interpreter's lock is free. Times are shown, and depend on the cores.
        alone = time.perf_counter()
        expected = heavy().pixel_hash
        alone = time.perf_counter() - alone
        hashes, counted = [], 0
        threads = [threading.Thread(target=lambda: hashes.append(heavy().pixel_hash)) for _ in range(2)]
        start = time.perf_counter()
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            counted += 1
            time.sleep(0.001)
        together = time.perf_counter() - start
        print(f"one picture {alone:.2f} s, two at once {together:.2f} s")
        self.assertEqual(hashes, [expected] * 2)
        self.assertGreater(counted, 20 * alone)  # wakes of a millisecond each: with the lock held there would be a few

    def test_frames_overlap(self):
        # Both frames are in their functions at the same time, which is impossible one after the other.
        inside, most, lock = set(), [0], threading.Lock()
        meet = threading.Barrier(2, timeout=60)

        def draw(number):
            first = [True]

            def progress(share):
                if first[0]:
                    first[0] = False
                    meet.wait()  # until the other frame is here too
                with lock:
                    inside.add(number)
                    most[0] = max(most[0], len(inside))

            halflit.render("demo", (320, 200), threads=1, progress=progress)

        threads = [threading.Thread(target=draw, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(most[0], 2)

    def test_many_threads_and_one_scene(self):
        scene = halflit.Scene()
        scene.add_mesh(CORNERS, FACES)
        expected = {size: scene.render(size).pixel_hash for size in range(16, 48, 4)}
        wrong = []

        def draw(sizes):
            for _ in range(10):
                for size in sizes:
                    if scene.render(size).pixel_hash != expected[size]:
                        wrong.append(size)

        threads = [threading.Thread(target=draw, args=(list(expected)[i::2],)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_a_scene_may_be_closed_while_it_is_drawn(self):
        scene = halflit.Scene.load(box())
        meet, drawn = threading.Event(), []
        thread = threading.Thread(target=lambda: drawn.append(scene.render(400, threads=1, progress=lambda share: meet.set())))
        thread.start()
        self.assertTrue(meet.wait(60))
        scene.close()
        thread.join()
        self.assertEqual(drawn[0].pixel_hash, halflit.render(box(), 400).pixel_hash)


class Callbacks(unittest.TestCase):
    def test_progress_ends_at_1(self):
        shares = []
        halflit.render("demo", (320, 200), progress=shares.append)
        self.assertEqual(shares[-1], 1)
        self.assertEqual(shares, sorted(shares))

    def test_a_frame_is_cancelled(self):
        with self.assertRaises(halflit.CancelledError):
            halflit.render("demo", (320, 200), cancelled=lambda: True)
        halflit.render("demo", (32, 20), cancelled=lambda: False)

    def test_an_exception_stops_the_frame_and_is_raised(self):
        scene = halflit.Scene.demo()
        expected = scene.render((320, 200)).pixel_hash

        def fail(*_):
            raise KeyboardInterrupt("stop")

        for name in ("progress", "cancelled"):
            with self.assertRaisesRegex(KeyboardInterrupt, "stop"):
                scene.render((320, 200), **{name: fail})
        self.assertEqual(scene.render((320, 200)).pixel_hash, expected)

    def test_what_progress_returns_does_not_matter(self):
        for returned in (np.zeros(3), object()):
            picture = halflit.render("demo", (32, 20), progress=lambda share: returned)
            self.assertEqual(picture.pixel_hash, halflit.render("demo", (32, 20)).pixel_hash)
        lost = []
        before, sys.unraisablehook = sys.unraisablehook, lost.append
        try:
            halflit.render("demo", (32, 20), progress=lambda share: np.zeros(3))
        finally:
            sys.unraisablehook = before
        self.assertEqual(lost, [])

    def test_a_callback_cannot_use_the_scene_that_is_drawn(self):
        scene = halflit.Scene()
        scene.add_mesh(np.random.default_rng(1).random((3000, 3), np.float32))
        for name in ("progress", "cancelled"):
            with self.assertRaisesRegex(halflit.UsageError, "scene that is drawn"):  # it waited for itself
                scene.render(200, threads=4, **{name: lambda *_: scene.counts})
        with self.assertRaises(ValueError):
            scene.render(8, cancelled=lambda: np.zeros(3))
        self.assertEqual(scene.render(8).shape, (8, 8, 4))

    def test_ctrl_c_ends_a_frame_with_functions(self):
        for _ in range(3):
            timer = threading.Timer(0.1, lambda: signal.raise_signal(signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                end = time.monotonic() + 20
                while time.monotonic() < end:
                    halflit.render("demo", (640, 360), samples=16, progress=lambda share: None)
            timer.join()

    def test_ctrl_c_ends_a_frame_without_functions(self):
        scene = halflit.Scene.demo()
        expected = scene.render(64).pixel_hash
        setup = scene.setup((1600, 900))
        scene.render(setup=setup, samples=16, threads=1)
        alone = time.perf_counter()
        scene.render(setup=setup, samples=16, threads=1)
        alone = time.perf_counter() - alone
        before = signal.getsignal(signal.SIGINT)
        for share in (0.1, 0.5):
            for _ in range(3):  # other programs may hold the processor once
                took = interrupted(lambda: scene.render(setup=setup, samples=16, threads=1), share * alone)
                if took < 0.3 * alone:
                    break
            print(f"Ctrl-C took effect after {1000 * took:.1f} ms, a frame takes {1000 * alone:.0f} ms")
            self.assertLess(took, 0.3 * alone)  # after the frame it would be half of it or more
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertEqual(scene.render(64).pixel_hash, expected)

    def test_ctrl_c_ends_what_takes_long_before_a_frame(self):
        vertices, faces = wavy()
        file = stl(vertices, faces[: 2**21])
        scenes = {normals: halflit.Scene() for normals in ("flat", "smooth")}
        scenes["flat"].add_mesh(vertices, faces)
        scenes["smooth"].add_mesh(vertices, faces, normals="smooth")

        def add(normals):
            halflit.Scene().add_mesh(vertices, faces, normals=normals)

        def first_frame(scene=scenes["smooth"]):
            scene.set_vertices(0, vertices)  # prepares it anew
            scene.render(16, samples=1, shadows="off", camera=np.eye(4))

        def setup():
            scenes["flat"].add_light("point", position=(0, 3, 0))  # is chosen anew
            scenes["flat"].setup(256)

        before = signal.getsignal(signal.SIGINT)
        for name, work in (
            ("load", lambda: halflit.Scene.load(file)),
            ("add_mesh, flat", lambda: add(None)),
            ("add_mesh, smooth", lambda: add("smooth")),
            ("setup", setup),
            ("first frame", first_frame),
        ):  # fmt: skip
            alone = time.perf_counter()
            work()
            alone = time.perf_counter() - alone
            most = max(0.3, 0.3 * alone)  # alone: machines may be busy; without a stop it is 0.4 of it or more
            for share in (0.3, 0.6):
                for _ in range(3):  # other programs may hold the processor once
                    took = interrupted(work, share * alone)
                    if took < most:
                        break
                print(f"{name} of {alone:.2f} s, Ctrl-C after {share * alone:.2f} s: ended {1000 * took:.0f} ms later")
                with self.subTest(name):
                    self.assertLess(took, most)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertEqual(scenes["flat"].counts["triangles"], len(faces))

    def test_a_handler_of_the_caller_does_not_stop_the_frame(self):
        expected, called = heavy().pixel_hash, []
        before = signal.signal(signal.SIGINT, lambda *_: called.append(1))
        try:
            timer = threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT))
            timer.start()
            self.assertEqual(heavy().pixel_hash, expected)
            timer.join()
            self.assertEqual(called, [1])
        finally:
            signal.signal(signal.SIGINT, before)

    def test_the_interpreter_ends_while_a_daemon_draws(self):
        # It ended the thread of a call in the midst of the library, which aborted.
        code = (
            "import threading, time, halflit\n"
            "def draw():\n"
            "    while True: halflit.render('demo', (640, 360), samples=16, progress=lambda share: None)\n"
            "threading.Thread(target=draw, daemon=True).start(); time.sleep(0.3); print('end')"
        )
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)  # fmt: skip
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, b"end\n", b""))

    def test_limits(self):
        with self.assertRaises(halflit.LimitError):
            halflit.render("demo", (1600, 900), samples=16, time_limit=1e-4)
        with self.assertRaises(halflit.LimitError):
            halflit.render("demo", (320, 200), memory_limit=1000)


if __name__ == "__main__":
    unittest.main()
