"""Processes that are forked from one that draws."""
import multiprocessing
import os
import signal
import threading
import time
import unittest

import halflit


def hash_of(size):
    return halflit.render("demo", size).pixel_hash


def in_child(function, seconds=60):
    """The text that the function returns in a forked process. None: it did not end."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(writer, function().encode())
        finally:
            os._exit(0)
    os.close(writer)
    os.set_blocking(reader, False)
    end = time.monotonic() + seconds
    try:
        while time.monotonic() < end:
            if os.waitpid(child, os.WNOHANG)[0] == child:
                return os.read(reader, 4096).decode()
            time.sleep(0.005)
        os.kill(child, 9)
        os.waitpid(child, 0)
        return None
    finally:
        os.close(reader)


@unittest.skipUnless(hasattr(os, "fork"), "no fork")
class Fork(unittest.TestCase):
    def setUp(self):
        self.ended, self.drawn = threading.Event(), halflit.Scene.demo()
        meet = threading.Event()

        def draw():
            while not self.ended.is_set():
                self.drawn.render((640, 360), samples=16)
                meet.set()

        self.thread = threading.Thread(target=draw)
        self.thread.start()
        meet.wait()

    def tearDown(self):
        self.ended.set()
        self.thread.join()

    def test_a_child_draws_beside_a_drawing_thread(self):
        scene = halflit.Scene.demo()
        first, second = scene.render(100).pixel_hash, hash_of(64)
        for threads in (0, 1, 2, 2):  # a new renderer, and one that had threads in the parent
            self.assertEqual(in_child(lambda: hash_of(64)), second)
            self.assertEqual(in_child(lambda: scene.render(100, threads=threads).pixel_hash), first)
        self.assertEqual(in_child(lambda: in_child(lambda: scene.render(100).pixel_hash)), first)
        self.assertEqual(scene.render(100).pixel_hash, first)

    def test_a_scene_that_was_being_drawn_is_refused_in_the_child(self):
        def attempt():
            try:
                return self.drawn.render(64).pixel_hash
            except halflit.UsageError as error:
                return str(error)

        said = {in_child(attempt) for _ in range(8)}
        refused = "another thread used this scene when the process was forked: make it anew in this process"
        self.assertIn(refused, said)
        self.assertLessEqual(said, {refused, self.drawn.render(64).pixel_hash})  # it may have been between two frames

    def test_ctrl_c_stops_one_frame_of_the_child(self):
        # The parent's main thread draws: the library's handler is in place when another thread forks.
        said, ended = [], threading.Event()

        def stopped_and_drawn():
            scene = halflit.Scene.demo()
            expected = scene.render(64).pixel_hash
            for _ in range(2):
                timer = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
                timer.start()
                try:
                    while True:
                        scene.render((640, 360), samples=16)
                except KeyboardInterrupt:
                    timer.join()
                if scene.render(64).pixel_hash != expected:
                    return "wrong"
            return "right"

        def fork():
            time.sleep(0.2)
            said.append(in_child(stopped_and_drawn))
            ended.set()

        thread = threading.Thread(target=fork)
        thread.start()
        while not ended.is_set():
            halflit.render("demo", (640, 360), samples=16)
        thread.join()
        self.assertEqual(said, ["right"])

    def test_pools_of_processes_draw(self):
        with multiprocessing.get_context("fork").Pool(2) as pool:
            self.assertEqual(pool.map(hash_of, [32, 48, 32]), [hash_of(32), hash_of(48), hash_of(32)])


if __name__ == "__main__":
    unittest.main()
