"""Shared by the tests: the program, and models made by code."""
import json
import os
import struct
import subprocess

import numpy as np

PROGRAM = os.environ.get("HALFLIT_PROGRAM", "halflit")
ASSETS = os.environ.get("HALFLIT_ASSETS")

CORNERS = np.array([[2 * (i >> k & 1) - 1 for k in range(3)] for i in range(8)], np.float32)
FACES = np.array([0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7],
                 np.uint32).reshape(-1, 3)  # fmt: skip


def moved(*offset):
    """The matrix of a translation; coordinates that are left out are 0."""
    matrix = np.eye(4)
    matrix[: len(offset), 3] = offset
    return matrix


def program_hash(*arguments, data=None):
    """pixel_hash of `halflit render ARGUMENTS`."""
    command = [PROGRAM, "render", *(str(a) for a in arguments), "-o", "-", "--report", "/dev/stderr", "--quiet"]
    done = subprocess.run(command, input=data, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode:
        raise AssertionError(f"{' '.join(command)}: {done.stderr.decode()}")
    return json.loads(done.stderr.decode())["pixel_hash"]


def program_json(*arguments):
    """The program's output as JSON."""
    return json.loads(subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, check=True).stdout)


def stl(corners):
    """A binary STL of triangles: corners (8, 3) of a box with FACES, or (3 n, 3)."""
    corners = np.asarray(corners, np.float32)
    triangles = (corners[FACES] if len(corners) == 8 else corners).reshape(-1, 9)
    rows = np.zeros((len(triangles), 50), np.uint8)
    rows[:, 12:48] = triangles.astype("<f4").view(np.uint8)
    return bytes(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def glb(document, *arrays):
    """A GLB of the document, whose bufferViews and accessors for the arrays are made: number i is array i."""
    kinds = {np.dtype("f4"): 5126, np.dtype("u4"): 5125}
    shapes = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
    body, views, accessors = b"", [], []
    for i, array in enumerate(arrays):
        columns = array.shape[1] if array.ndim == 2 else 1
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": array.nbytes})
        rows = array.reshape(-1, columns)
        accessors.append({"bufferView": i, "componentType": kinds[array.dtype], "count": len(rows), "type": shapes[columns],
                          "min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()})  # fmt: skip
        body += array.tobytes()
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(document["nodes"])))}],
                "buffers": [{"byteLength": len(body)}], "bufferViews": views, "accessors": accessors, **document}  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def box(**node):
    """A GLB with a red cube; node: members of its node, "more": members of the document."""
    more = node.pop("more", {})
    red = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.2, 0.1, 1], "metallicFactor": 0.2, "roughnessFactor": 0.4}}
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}
    document = {"nodes": [{"mesh": 0, **node}], "meshes": [mesh], "materials": [red], **more}
    extra = [np.array([0, 2], "f4"), np.array([[0, 0, 0, 1], [0, 0.7071068, 0, 0.7071068]], "f4")]
    return glb(document, CORNERS, FACES.ravel(), *extra)


#: Turns the box by a quarter in two seconds.
TURN = {"animations": [{"name": "turn", "samplers": [{"input": 2, "output": 3}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]}  # fmt: skip
#: A camera of the file, in a picture of 3 : 2.
CAMERA = {"cameras": [{"type": "perspective", "name": "front", "perspective": {"yfov": 0.9, "aspectRatio": 1.5, "znear": 0.1}}]}
LAMPS = {
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 800, "color": [1, 0.9, 0.8]}]}},
}
