"""Tests of what shows pictures to people: sheets of several, notebooks, bars."""
import base64
import contextlib
import html.parser
import importlib.util
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy as np

import halflit

HAS_PILLOW = importlib.util.find_spec("PIL") is not None


def plain(height, width, *color):
    picture = np.empty((height, width, len(color)), np.uint8)
    picture[:] = color
    return picture


class Sheets(unittest.TestCase):
    def test_pictures_lie_in_rows(self):
        colors = [(200, 10, 10), (10, 200, 10), (10, 10, 200), (90, 90, 90), (5, 6, 7)]
        sheet = halflit.contact_sheet([plain(20, 30, *color) for color in colors], columns=2, gap=4, background="#010203")
        self.assertIsInstance(sheet, halflit.Picture)
        self.assertEqual((sheet.shape, sheet.dtype), ((3 * 24 + 4, 2 * 34 + 4, 4), np.uint8))
        expected = plain(76, 72, 1, 2, 3, 255)
        for i, color in enumerate(colors):
            expected[4 + 24 * (i // 2) :, 4 + 34 * (i % 2) :][:20, :30, :3] = color
        self.assertEqual(sheet.tolist(), expected.tolist())
        self.assertEqual(halflit.contact_sheet([plain(8, 8, 1, 1, 1)] * 5, gap=0).shape, (16, 24, 4))

    def test_pictures_of_any_size_and_kind_lie_over_the_background(self):
        half = np.zeros((4, 4, 4), np.float32)
        half[:] = (1, 1, 1, 0.5)
        sheet = halflit.contact_sheet([half, plain(8, 8, 255, 0, 0, 0)], gap=0, background="black")
        self.assertEqual(sheet[4, 4].tolist(), [128, 128, 128, 255])
        self.assertEqual(sheet[0, 0].tolist(), [0, 0, 0, 255])  # the smaller picture lies in the middle
        self.assertTrue((sheet[:, 8:] == (0, 0, 0, 255)).all())

    @unittest.skipUnless(HAS_PILLOW, "no Pillow")
    def test_labels_lie_below_their_pictures(self):
        views = halflit.Scene.demo().render_views(["front", "top"], (96, 64))
        with_labels, without = halflit.contact_sheet(views), halflit.contact_sheet(list(views.values()))
        below = (with_labels.shape[0] - without.shape[0])
        self.assertGreater(below, 10)
        self.assertEqual(with_labels[: 8 + 64].tolist(), without[: 8 + 64].tolist())
        strip = with_labels[8 + 64 : 8 + 64 + below].astype(int)
        ink = np.abs(strip - strip[0, 0]).max(axis=2) > 60
        for half in (ink[:, : ink.shape[1] // 2], ink[:, ink.shape[1] // 2 :]):
            self.assertGreater(half.sum(), 15)
        long = halflit.contact_sheet(list(views.values()), labels=["one that is far too long for a narrow picture", "ü ∞"], columns=1)
        self.assertEqual(long.shape[1], 96 + 16)

    def test_what_is_wrong_is_named(self):
        for given, options, said in (
            ([], {}, "pictures: expected one"),
            ([np.zeros((4, 4), np.uint8)], {}, "picture 0: expected uint8 or float32"),
            ([plain(4, 4, 1, 1, 1)], {"labels": []}, "labels: 0, expected one for each of 1"),
            ([plain(4, 4, 1, 1, 1)], {"columns": 0}, "columns: expected"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, said):
                halflit.contact_sheet(given, **options)


class Notebooks(unittest.TestCase):
    def test_a_picture_tells_its_camera(self):
        picture = halflit.Scene.demo().render((32, 20))
        text = picture._repr_html_()
        data = re.search(r'src="data:image/png;base64,(.*?)"', text).group(1)
        self.assertEqual(base64.b64decode(data), picture.to_png())
        eye = ", ".join(f"{x:.4g}" for x in picture.camera.matrix[:3, 3])
        self.assertIn(f"32 x 20, uint8; camera at ({eye}), looking along", text)
        self.assertNotIn("camera at", picture[:8]._repr_html_())
        self.assertIsNone(picture[0]._repr_html_())

    def test_a_scene_shows_its_picture_and_tells_the_camera(self):
        scene = halflit.Scene.demo()
        shown = scene._repr_mimebundle_()
        picture = scene.render((512, 512))
        self.assertEqual(shown, {"text/html": picture._repr_html_(), "image/png": picture.to_png()})
        self.assertEqual((scene._repr_html_(), scene._repr_png_()), (shown["text/html"], shown["image/png"]))
        self.assertIn("camera at", shown["text/html"])

    def test_views_are_shown_side_by_side(self):
        views = halflit.Scene.demo().render_views(["front", (30, 20.5)], 24)
        page = Page(views._repr_html_())
        self.assertEqual(page.open, [])
        self.assertEqual([tag for tag, _ in page.elements if tag in ("figure", "img")], ["figure", "img"] * 2)
        self.assertRegex(views._repr_html_(), "front</figcaption>.*30°, 20.5°</figcaption>")
        self.assertEqual(list(views), ["front", (30, 20.5)])
        self.assertIn("24 x 24 pixels", repr(halflit.Scene.demo().setup(24)))


class Page(html.parser.HTMLParser):
    """The elements of a page, and its script."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.script = [], [], ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] == "script":
            self.script += data


class Turntables(unittest.TestCase):
    def test_its_frames_are_the_pictures_of_its_views(self):
        scene = halflit.Scene.demo()
        table = scene.turntable((48, 32), azimuths=3, elevations=(40, 0), samples=1)
        views = [(35 + 120 * i, elevation) for elevation in (0, 40) for i in range(3)]
        self.assertEqual(list(table.frames), views)
        pictures = scene.render_views(views, (48, 32), samples=1)
        self.assertEqual([table.frames[view] for view in views], [pictures[view].to_png() for view in views])
        self.assertEqual(table._repr_png_(), table.frames[35, 0])  # of the two, 0 comes first: both are 20 degrees off

    def test_the_page_holds_all_frames_and_refers_to_nothing(self):
        table = halflit.Scene.demo().turntable(64, azimuths=4, samples=1)
        page = Page(table.html)
        self.assertEqual(page.open, [])
        frames = json.loads(re.search(r"const frames = (\[.*?\])", page.script).group(1))
        self.assertEqual([base64.b64decode(frame) for frame in frames], list(table.frames.values()))
        for tag, attributes in page.elements:
            for name in {"src", "href", "srcset"} & set(attributes):
                self.assertRegex(attributes[name], "^data:image/png;base64,", tag)
        self.assertNotRegex(page.script, "https?:|fetch|import")
        # Base64 is 4/3 of the frames; the first one is there twice, and the rest is text.
        size = sum(map(len, table.frames.values()))
        self.assertLess(len(table.html), 4 / 3 * (size + max(map(len, table.frames.values()))) + 4096)
        ((tag, attributes),) = Page(table._repr_html_()).elements
        self.assertEqual((tag, attributes["srcdoc"], attributes["sandbox"]), ("iframe", table.html, "allow-scripts"))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "turn.html")
            table.save(path)
            with open(path, encoding="utf-8") as file:
                self.assertEqual(file.read(), table.html)

    @unittest.skipUnless(shutil.which("node"), "no Node.js")
    def test_a_drag_over_the_width_turns_it_by_half_a_circle(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "turn.html")
            halflit.Scene.demo().turntable((160, 120), azimuths=8, samples=1).save(path)
            check = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "web", "turntable_check.mjs")
            done = subprocess.run(["node", check, path, "160", "120"], stdout=subprocess.PIPE, timeout=300, check=False)
        if done.returncode == 77:
            self.skipTest("no Chromium")
        self.assertEqual(done.returncode, 0)
        # Rows of 8 frames, from the lowest up; the middle one is first. A quarter of the width is an eighth of a circle, one frame: what
        # is in front follows the pointer, so the camera goes the other way.
        expected = {"first": 8, "left": 9, "right": 15, "down": 16, "up": 0}
        expected.update({f"finger_{name}": frame for name, frame in expected.items() if name != "first"}, left_and_key=8)
        self.assertEqual(json.loads(done.stdout), expected)

    def test_what_is_wrong_is_named(self):
        scene = halflit.Scene.demo()
        for options, said in (
            ({"azimuths": 0}, "azimuths: expected"),
            ({"azimuths": 1000}, "azimuths: expected at most 2000 views, found 3000"),
            ({"elevations": 20}, "elevations: expected a list"),
            ({"elevations": []}, "elevations: expected angles"),
            ({"elevations": [91]}, "elevations: expected angles"),
            ({"azimuth": float("nan")}, "azimuth: expected a finite number"),
            ({"format": "gif"}, "format: expected 'png', 'jpg' or 'webp', found 'gif'"),
            ({"format": []}, "format: expected"),
            ({"light": "x"}, "light: expected"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, said):
                scene.turntable(16, **options)


class Bars(unittest.TestCase):
    def drawn(self, tqdm):
        error = io.StringIO()
        with unittest.mock.patch.dict(sys.modules, {"tqdm": tqdm, "tqdm.auto": tqdm}), contextlib.redirect_stderr(error):
            picture = halflit.render("demo", (320, 200), progress=True)
        self.assertEqual(picture.pixel_hash, halflit.render("demo", (320, 200), progress=False).pixel_hash)
        return error.getvalue()

    def test_a_line_is_written_over_itself(self):
        with unittest.mock.patch("halflit._progress._PAUSE", 0.0):
            said = self.drawn(None)  # as if it were not installed
        shown = [int(share) for share in re.findall(r"\r\[[# ]{30}\] +(\d+) %", said)]
        self.assertEqual((shown, shown[-1]), (sorted(shown), 100))
        self.assertEqual(said.count("\n"), 1)
        with unittest.mock.patch("halflit._progress._PAUSE", 60.0):
            self.assertEqual(self.drawn(None), "")  # a short frame

    def test_tqdm_shows_it_where_it_is_installed(self):
        bars = []

        class Bar:
            def __init__(self, total, **_):
                self.total, self.n, self.closed = total, 0, 0
                bars.append(self)

            def update(self, count):
                self.n += count

            def close(self):
                self.closed += 1

        module = types.ModuleType("tqdm.auto")
        module.tqdm = Bar
        self.assertEqual(self.drawn(module), "")
        (bar,) = bars
        self.assertEqual((bar.total, bar.n, bar.closed), (100, 100, 1))


if __name__ == "__main__":
    unittest.main()
