"""One request, one answer: the program, halflit.render() and halflit.call() draw the same pixels, or refuse with the same words."""
import itertools
import json
import os
import re
import subprocess
import sys
import unittest
import warnings

from support import PROGRAM

import halflit
from halflit._options import SETTINGS

SIZE = (48, 36)
#: Keywords whose flags have other names.
FLAG = {"texture_detail": "texture-filter", "tone_curve": "tonemap", "normalize_specular": "specular-normalize",
        "environment_bands": "sh-order", "shading_rate": "shading", "shadow_terminator_offset": "shadow-terminator",
        "edge_angle_deg": "edge-angle", "shadow_softness_deg": "shadow-softness", "orthographic": "ortho"}  # fmt: skip
#: Settings without a flag, or with another unit.
NO_FLAG = ("environment_tolerance", "emission_scale", "shadow_memory_limit")
#: In range, at the ends, and out of range.
NUMBERS = {
    "max_error": [0, 0.001, 0.5, 255, 256, -1, "x"], "samples": [1, 4, 8, 16, 0, 2, 17, "", "4x"],
    "point_size": [0, "auto", 0.0625, 1, 256, 0.05, 257],
    "line_width": [0.0625, 1, 256, 0.05, 257, "nan", "inf"], "anisotropy": [1, 3, 4, 16, 0, 17], "normal_scale": [0, 1, 16, -1, 17],
    "environment_bands": [0, "auto", 1, 10, 11, -1], "shadow_size": [0, "auto", 64, 256, 1024, 63, 100, 8192, 64.5],
    "soft_shadow_maps": [4, 16, 64, 3, 65], "shadow_fade": [0, 0.5, 1e9, -1, 1e-7], "sky_shadows": [0, 1, "auto", 16, 64, 2, 1025],
    "edge_angle_deg": [0, 30, 180, -1, 181], "edge_width": [0.25, 3, 64, 0.2, 65], "max_layers": [0, "none", 1, 1 << 20, -1, (1 << 20) + 1],
    "contact_shadow": [0, 0.5, 1, -0.1, 1.1], "edl_strength": [0, 0.5, 16, -1, 17],
    "shadow_softness_deg": [0, 3, 10, -1, 11],
}  # fmt: skip
NAMED = {
    "tone_curve": ["none", "reinhard", "aces", "neutral", "filmic", ""], "accuracy": ["reference", "exact", "fast"],
    "texture_detail": ["full", "bilinear", "nearest", "x"], "specular": ["none", "phong", "blinn", "ggx", "x"],
    "shading_rate": ["flat", "gouraud", "pixel", "x"], "shadows": ["off", "hard", "soft_split", "soft-split", "x"],
    "edges": ["none", "feature", "silhouette", "all", "x"], "hidden_edges": ["none", "dashed", "x"], "edl": ["off", "auto", "on", "x"],
    "alpha": ["linear", "display", "x"],
}  # fmt: skip
#: Those that were answered differently, and others of a view.
OTHERS = [
    {"edge_width": 3}, {"orthographic": True, "fov": 30}, {"shadows": "off", "shadow_size": 512}, {"fit": 40, "edges": "feature"},
    {"fit": 10}, {"fit": 16}, {"fit": 17}, {"background": "Red"}, {"background": "teal"}, {"background": "#1234"}, {"background": "#12345"},
    {"background": "transparent"}, {"background": "rot"}, {"background": "#ff8800"}, {"edges": "all", "edge_color": "NAVY"},
    {"view": "front"}, {"view": "iso", "fit": 4}, {"view": "frunt"}, {"azimuth": 20, "elevation": 10}, {"zoom": 2}, {"zoom": 0},
    {"fov": 20}, {"fov": 200}, {"azimuth": 35}, {"elevation": 91}, {"view": "top", "azimuth": 10}, {"ev": "auto+1"}, {"ev": 1.5},
    {"ambient": (0.5, 0.5, 0.5)}, {"region": (4, 4, 20, 10)}, {"region": (40, 0, 20, 10)}, {"camera": "frame"}, {"camera": 0},
    {"camera": 0, "azimuth": 10}, {"orthographic": True}, {"orthographic": True, "zoom": 3}, {"ground": True}, {"scene_lights": False},
]  # fmt: skip


def requests():
    for name in SETTINGS:
        if name in NO_FLAG:
            continue
        values = [True, False] if SETTINGS[name][1] == "bool" else NUMBERS.get(name) or NAMED[name]
        yield from ({name: value} for value in values)
    yield from OTHERS
    # Pairs of settings, each with a value that is not its default. A third of them, in which each setting meets seven others.
    pairs = {"samples": 8, "tone_curve": "aces", "accuracy": "reference", "specular": "ggx", "shading_rate": "flat", "shadows": "hard",
             "sky_shadows": 16, "edges": "feature", "hidden_edges": "dashed", "edge_width": 2.5, "contact_shadow": 0.25, "max_error": 1.0,
             "texture_detail": "nearest", "anisotropy": 2, "normal_scale": 0.5, "environment_bands": 3, "shadow_size": 128,
             "shadow_fade": 2, "max_layers": 3, "zoom": 1.5, "fov": 50, "view": "right"}  # fmt: skip
    for (i, (a, x)), (j, (b, y)) in itertools.combinations(enumerate(pairs.items()), 2):
        if (i + j) % 3 == 0 or "HALFLIT_ALL_PAIRS" in os.environ:
            yield {a: x, b: y}


def flags_of(request):
    flags = []
    for name, value in request.items():
        flag = "--" + FLAG.get(name, name).replace("_", "-")
        if name == "scene_lights":
            flags.append("--no-scene-lights")
        elif name in ("ground", "orthographic"):
            flags.append(flag)
        elif name == "ev":
            flags += ["--exposure", str(value)]
        else:
            flags += [flag, text_of(value)]
    return flags


def text_of(value):
    if isinstance(value, bool):
        return "on" if value else "off"
    return ",".join(str(one) for one in value) if isinstance(value, tuple) else str(value)


def words(message):
    """A refusal without what is each front end's own: hyphens of flags, the place to look further, and the name at its begin."""
    message = re.sub(r"; see halflit render --help$", "", message.strip())
    message = re.sub(r"^halflit: error: ", "", message).replace(" (an empty variable?)", "")
    for name, flag in FLAG.items():
        message = message.replace(f"--{flag}", f"--{name}").replace(flag.replace("-", "_") + ":", name + ":")
    return message.replace("--", "").replace("-", "_")


def of_program(request):
    command = [PROGRAM, "render", "demo", "--size", "{}x{}".format(*SIZE), *flags_of(request), "-o", "-", "--report", "/dev/stderr", "-q"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    text = done.stderr.decode()
    if done.returncode == 0:
        return "pixels", json.JSONDecoder().raw_decode(text)[0]["pixel_hash"]
    return "refused", words(text[text.index("halflit: error: ") :])


def of_render(request):
    try:
        return "pixels", halflit.render("demo", SIZE, **request).pixel_hash
    except (halflit.Error, TypeError) as error:
        return "refused", words(str(error))


def of_call(request):
    arguments = {}
    for name, value in request.items():
        if name == "scene_lights":
            arguments["no_scene_lights"] = True
        elif name == "ev":
            arguments["exposure"] = str(value)
        else:
            arguments[FLAG.get(name, name).replace("-", "_")] = value if isinstance(value, bool) else text_of(value)
    try:
        return "pixels", halflit.call("render", "demo", size=SIZE, **arguments)["pixel_hash"]
    except halflit.Error as error:
        return "refused", words(str(error))


class SameRequestTest(unittest.TestCase):
    def test_program_render_and_call_answer_alike(self):
        warnings.simplefilter("ignore")
        asked = list(requests())
        self.assertGreaterEqual(len(asked), 200)
        different = []
        for request in asked:
            answers = {"program": of_program(request), "render": of_render(request), "call": of_call(request)}
            if len(set(answers.values())) > 1:
                different.append(f"{request}: {answers}")
        self.assertEqual([], different, "\n".join(different))


if __name__ == "__main__":
    if sys.argv[1:] == ["--flags"]:  # for the test of the npm package
        print(json.dumps([flags_of(request) for request in requests()]))
    else:
        unittest.main()
