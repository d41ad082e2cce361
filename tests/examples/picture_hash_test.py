"""The gallery's hash of a file's pixels against the program's reports, and against pictures written here.   HALFLIT_PROGRAM, gallery folder"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, sys.argv.pop())
import picture_hash  # noqa: E402

WIDTH, HEIGHT = 7, 6


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(pixels, channels, kinds):
    """A PNG file whose rows are filtered by these kinds in turn, after the formulas of the PNG specification."""
    size, rows, above = WIDTH * channels, b"", bytes(WIDTH * channels)
    for y in range(HEIGHT):
        row, kind = pixels[y * size : (y + 1) * size], kinds[y % len(kinds)]
        filtered = bytearray([kind])
        for i in range(size):
            a, b, c = (row[i - channels], above[i], above[i - channels]) if i >= channels else (0, above[i], 0)
            p = a + b - c
            nearest = min((a, b, c), key=lambda value: abs(p - value))  # the first one of equal distances
            filtered.append((row[i] - (0, a, b, (a + b) // 2, nearest)[kind]) & 255)
        rows, above = rows + bytes(filtered), row
    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class PictureHash(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name) / "picture.png"

    def drawn(self, *flags):
        command = [os.environ["HALFLIT_PROGRAM"], "render", "demo", "--size", "90x51", "--quiet", *flags]
        return json.loads(subprocess.run([*command, "--report", "-"], check=True, stdout=subprocess.PIPE).stdout)

    def test_of_nothing_it_is_the_published_one(self):
        self.assertEqual(picture_hash.xxh64(b""), "ef46db3751d8e999")

    def test_of_a_picture_it_is_that_of_the_report(self):
        for background in ("#2c3036", "transparent"):
            report = self.drawn("-o", str(self.path), "--background", background)
            self.assertEqual(picture_hash.of_file(self.path), report["pixel_hash"])

    def test_filters_do_not_change_it(self):
        for channels in (3, 4):
            pixels = bytes((i * i * 31 + 7 * i) % 256 for i in range(WIDTH * HEIGHT * channels))
            found = set()
            for kinds in ((0,), (1,), (2,), (3,), (4,), (4, 3, 2, 1, 0)):
                self.path.write_bytes(png(pixels, channels, kinds))
                found.add(picture_hash.of_file(self.path))
            whole = pixels if channels == 4 else b"".join(pixels[i : i + 3] + b"\xff" for i in range(0, len(pixels), 3))
            self.assertEqual(found, {picture_hash.xxh64(whole)})

    def test_of_one_frame_it_is_that_of_the_picture(self):
        film = self.path.with_suffix(".apng")
        self.drawn("--turntable", "4", "--frames", "1-1", "-o", str(film))
        self.drawn("--turntable", "4", "--frames", "1-1", "-o", str(self.path.with_name("{:01}.png")))
        self.assertEqual(picture_hash.of_file(film), picture_hash.of_file(self.path.with_name("1.png")))

    def test_other_depths_are_refused(self):
        data = bytearray(png(bytes(WIDTH * HEIGHT * 3), 3, (0,)))
        data[24] = 16
        self.path.write_bytes(data)
        self.assertRaises(ValueError, picture_hash.of_file, self.path)


unittest.main()
