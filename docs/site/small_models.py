#!/usr/bin/env python3
"""Small models for the pictures of flags, and for the test that runs the commands of the pages.

    small_models.py FOLDER

They need nothing but Python's standard library, and are the same in each run.
"""
import json
import math
import pathlib
import shutil
import struct
import sys
import zipfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLOAT, UINT = 5126, 5125  # glTF's component types
ARRAY, ELEMENTS = 34962, 34963  # glTF's targets of buffer views


# ---- geometry: (positions, normals, uv, indices) ------------------------------------------------------------------------
def box(low, high):
    """A box with flat normals."""
    positions, normals, uv, indices = [], [], [], []
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            first = len(positions)
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                point = [0.0, 0.0, 0.0]
                point[axis], point[u], point[v] = (low, high)[side][axis], (low, high)[a][u], (low, high)[b][v]
                positions.append(tuple(point))
                normals.append(tuple((1.0 if side else -1.0) if i == axis else 0.0 for i in range(3)))
                uv.append((float(a), float(b)))
            order = (0, 1, 2, 0, 2, 3) if side else (0, 2, 1, 0, 3, 2)
            indices += [first + i for i in order]
    return positions, normals, uv, indices


def ball(center, radius, columns, rows):
    """A sphere with smooth normals."""
    normals = []
    for j in range(rows + 1):
        for i in range(columns + 1):
            a, b = 2 * math.pi * (i % columns) / columns, math.pi * j / rows
            across = math.sin(b) if 0 < j < rows else 0.0  # exactly 0 at the poles, so that the ball is closed
            normals.append((across * math.sin(a), math.cos(b), across * math.cos(a)))
    positions = [tuple(center[k] + radius * n[k] for k in range(3)) for n in normals]
    uv = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    indices = []
    for j in range(rows):
        for i in range(columns):
            p, q = j * (columns + 1) + i, (j + 1) * (columns + 1) + i
            indices += ([p, q, p + 1] if j else []) + ([p + 1, q, q + 1] if j < rows - 1 or not j else [])
    return positions, normals, uv, indices


def floor(half, repeats, height=0.0):
    """A square that faces up."""
    positions = [(-half, height, half), (half, height, half), (half, height, -half), (-half, height, -half)]
    return positions, [(0.0, 1.0, 0.0)] * 4, [(0, repeats), (repeats, repeats), (repeats, 0), (0, 0)], [0, 1, 2, 0, 2, 3]


def bracket(thickness):
    """Triangles of an angle bracket, z up: an L that is pulled along y."""
    outline = [(0, 0), (60, 0), (60, thickness), (thickness, thickness), (thickness, 45), (0, 45)]
    def at(y):
        return [(float(x), float(y), float(z)) for x, z in outline]
    front, back, triangles = at(0), at(30), []
    for a, b, c in ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)):
        triangles += [(front[a], front[b], front[c]), (back[a], back[c], back[b])]
    for i in range(6):
        k = (i + 1) % 6
        triangles += [(front[i], back[i], back[k]), (front[i], back[k], front[k])]
    return triangles


# ---- files --------------------------------------------------------------------------------------------------------------
def write_stl(path, triangles):
    data = bytearray(80) + struct.pack("<I", len(triangles))
    for corners in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *[x for corner in corners for x in corner], 0)
    path.write_bytes(data)


def png(width, height, pixel):
    """A PNG of RGB codes, pixel(x, y)."""
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b""))


class Glb:
    """A glTF file in the making: lists of its elements, and one buffer."""

    def __init__(self, **top):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0"}, "meshes": [], "nodes": [], "materials": [], "accessors": [], "bufferViews": [], **top}

    def view(self, body, **more):
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(body), **more})
        self.data += body
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, kind, component=FLOAT, target=None):
        flat = [x for row in rows for x in row]
        view = self.view(struct.pack(f"<{len(flat)}{'I' if component == UINT else 'f'}", *flat), **({"target": target} if target else {}))
        self.json["accessors"].append({"bufferView": view, "componentType": component, "count": len(rows), "type": kind,
                                       "min": [min(column) for column in zip(*rows)], "max": [max(column) for column in zip(*rows)]})
        return len(self.json["accessors"]) - 1

    def material(self, color, metallic=0.0, roughness=0.6, **more):
        pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness, **more.pop("pbr", {})}
        self.json["materials"].append({"pbrMetallicRoughness": pbr, **more})
        return len(self.json["materials"]) - 1

    def texture(self, picture):
        view = self.view(picture)
        self.json.setdefault("images", []).append({"bufferView": view, "mimeType": "image/png"})
        self.json.setdefault("textures", []).append({"source": len(self.json["images"]) - 1})
        return len(self.json["textures"]) - 1

    def mesh(self, geometry, material, **primitive):
        positions, normals, uv, indices = geometry
        attributes = {"POSITION": self.accessor(positions, "VEC3", target=ARRAY), "NORMAL": self.accessor(normals, "VEC3", target=ARRAY),
                      "TEXCOORD_0": self.accessor([tuple(map(float, at)) for at in uv], "VEC2", target=ARRAY)}
        self.json["meshes"].append({"primitives": [{"attributes": attributes, "material": material, **primitive,
                                                    "indices": self.accessor([(i,) for i in indices], "SCALAR", UINT, ELEMENTS)}]})
        return len(self.json["meshes"]) - 1

    def node(self, **node):
        self.json["nodes"].append(node)
        return len(self.json["nodes"]) - 1

    def write(self, path):
        content = {key: value for key, value in self.json.items() if value != []}
        content["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(content, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + bytes(-len(self.data) % 4)
        path.write_bytes(struct.pack("<3I", 0x46546C67, 2, 28 + len(text) + len(data)) + struct.pack("<2I", len(text), 0x4E4F534A) + text
                         + struct.pack("<2I", len(data), 0x004E4942) + data)


# ---- models -------------------------------------------------------------------------------------------------------------
def truck(path):
    """A body that hides a group of wheels."""
    glb = Glb()
    red, grey = glb.material((0.7, 0.1, 0.08)), glb.material((0.2, 0.2, 0.2))
    body = glb.node(name="Body", mesh=glb.mesh(box((-1.6, 0.1, -0.8), (1.6, 1.0, 0.8)), red))
    cabin = glb.node(name="Cabin", mesh=glb.mesh(box((0.4, 1.0, -0.7), (1.4, 1.7, 0.7)), red))
    wheel = glb.mesh(ball((0, 0, 0), 0.35, 24, 16), grey)
    wheels = [glb.node(name=f"Wheel {x} {z}", mesh=wheel, translation=[x, 0.3, z]) for x in (-1, 1) for z in (-0.6, 0.6)]
    group = glb.node(name="Wheels", children=wheels)
    glb.json.update(scene=0, scenes=[{"nodes": [body, cabin, group]}])
    glb.write(path)


def arm(path):
    """An arm with two animations: it turns in two seconds, or in one."""
    glb = Glb()
    blue, grey = glb.material((0.1, 0.3, 0.7)), glb.material((0.4, 0.4, 0.4))
    base = glb.node(name="Base", mesh=glb.mesh(box((-0.5, -0.2, -0.5), (0.5, 0.0, 0.5)), grey))
    lever = glb.node(name="Arm", mesh=glb.mesh(box((-0.1, 0.0, -0.15), (0.1, 1.4, 0.15)), blue))
    def animation(name, seconds, degrees):
        turns = [0.0, math.radians(degrees), 0.0]
        times = glb.accessor([(seconds * k / 2,) for k in range(3)], "SCALAR")
        rotations = glb.accessor([(0.0, 0.0, math.sin(t / 2), math.cos(t / 2)) for t in turns], "VEC4")
        return {"name": name, "samplers": [{"input": times, "output": rotations}],
                "channels": [{"sampler": 0, "target": {"node": lever, "path": "rotation"}}]}
    glb.json.update(scene=0, scenes=[{"nodes": [base, lever]}], animations=[animation("walk", 2, 70), animation("wave", 1, -110)])
    glb.write(path)


def choices(path):
    """Two scenes, two cameras and a variant of the materials."""
    glb = Glb(extensionsUsed=["KHR_materials_variants"], extensions={"KHR_materials_variants": {"variants": [{"name": "beach"}]}})
    plain, beach, grey = glb.material((0.6, 0.15, 0.1)), glb.material((0.9, 0.75, 0.2)), glb.material((0.5, 0.5, 0.5))
    mapped = {"KHR_materials_variants": {"mappings": [{"material": beach, "variants": [0]}]}}
    ball_node = glb.node(name="Ball", mesh=glb.mesh(ball((0, 0.6, 0), 0.6, 32, 24), plain, extensions=mapped))
    block = glb.node(name="Block", mesh=glb.mesh(box((-0.7, 0, -0.4), (0.7, 0.5, 0.4)), grey))
    glb.json["cameras"] = [{"type": "perspective", "name": name, "perspective": {"yfov": 0.6, "znear": 0.1}} for name in ("Front", "Close")]
    cameras = [glb.node(camera=0, translation=[0, 0.6, 4]), glb.node(camera=1, translation=[0.4, 0.6, 2.2])]
    glb.json.update(scene=0, scenes=[{"name": "one", "nodes": [ball_node, *cameras]}, {"name": "two", "nodes": [block, cameras[0]]}])
    glb.write(path)


def lit(path):
    """A ball above a floor under a sun and a point light; the ball has a lobe of its own."""
    lights = [{"type": "directional", "intensity": 2.0}, {"type": "point", "color": [1, 0.6, 0.3], "intensity": 9.0}]
    glb = Glb(extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {"lights": lights}})
    clay = glb.material((0.75, 0.6, 0.5), extras={"halflit": {"lobe": "valve"}})
    grey = glb.material((0.55, 0.55, 0.55), roughness=0.8)
    nodes = [glb.node(name="Ball", mesh=glb.mesh(ball((0, 0.8, 0), 0.6, 64, 48), clay)),
             glb.node(name="Floor", mesh=glb.mesh(floor(2.5, 1), grey)),
             glb.node(rotation=[-0.5, 0.35, 0.2, 0.765], extensions={"KHR_lights_punctual": {"light": 0}}),
             glb.node(translation=[-1.2, 1.8, 0.8], extensions={"KHR_lights_punctual": {"light": 1}})]
    glb.json.update(scene=0, scenes=[{"nodes": nodes}])
    glb.write(path)


def tiles(path):
    """A large floor of checks."""
    glb = Glb()
    texture = glb.texture(png(64, 64, lambda x, y: (225, 220, 210) if (x // 32 + y // 32) % 2 else (40, 60, 90)))
    material = glb.material((1, 1, 1), roughness=1.0, pbr={"baseColorTexture": {"index": texture}})
    glb.json.update(scene=0, scenes=[{"nodes": [glb.node(name="Floor", mesh=glb.mesh(floor(20, 20), material))]}])
    glb.write(path)


def bumps(path):
    """A ball with a normal map of waves."""
    glb = Glb()
    def wave(x, y):
        slopes = 0.6 * math.cos(2 * math.pi * x / 16), 0.6 * math.cos(2 * math.pi * y / 16)
        length = math.sqrt(slopes[0] ** 2 + slopes[1] ** 2 + 1)
        return [round(127.5 + 127.5 * v / length) for v in (-slopes[0], -slopes[1], 1)]
    texture = glb.texture(png(256, 128, wave))
    material = glb.material((0.6, 0.5, 0.3), roughness=0.4, normalTexture={"index": texture})
    glb.json.update(scene=0, scenes=[{"nodes": [glb.node(name="Ball", mesh=glb.mesh(ball((0, 0, 0), 1, 64, 48), material))]}])
    glb.write(path)


def coarse_text(points_and_lines=False):
    """OBJ: a ball of few triangles without normals; or the lines of its grid, and its points."""
    positions, _, _, indices = ball((0, 0, 0), 1, 12, 8)
    unique = {}
    keys = [tuple(round(x, 6) + 0.0 for x in p) for p in positions]
    for key in keys:
        unique.setdefault(key, len(unique) + 1)
    lines = ["v {} {} {}".format(*key) for key in unique]
    for k in range(0, len(indices), 3):
        corners = [unique[keys[i]] for i in indices[k : k + 3]]
        lines.append("{} {}".format("l" if points_and_lines else "f", " ".join(map(str, corners))))
    return "\n".join(lines) + "\n"


def cloud_text():
    """PLY: points on a ball, coloured by their place."""
    points = []
    for k in range(2000):  # a spiral from pole to pole
        y, a = 1 - (2 * k + 1) / 2000, k * 2.399963
        r = math.sqrt(1 - y * y)
        x, z = r * math.cos(a), r * math.sin(a)
        points.append(f"{x:.6f} {y:.6f} {z:.6f} {int(127 + 120 * x)} {int(127 + 120 * y)} {int(127 + 120 * z)}")
    names = [f"property float {axis}" for axis in "xyz"] + [f"property uchar {name}" for name in ("red", "green", "blue")]
    return "\n".join(["ply", "format ascii 1.0", f"element vertex {len(points)}", *names, "end_header", *points]) + "\n"


def plates(path):
    """A slicer's project with two plates: a cube on the first, a tall box on the second."""
    def item(number, size, height):
        positions, _, _, indices = box((0, 0, 0), (size, size, height))
        corners = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in positions)
        faces = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*indices[k : k + 3]) for k in range(0, len(indices), 3))
        return f'<object id="{number}" type="model"><mesh><vertices>{corners}</vertices><triangles>{faces}</triangles></mesh></object>'
    model = ('<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
             + item(1, 10, 10) + item(2, 10, 40) + '</resources><build><item objectid="1"/>'
             '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 300 0 0"/></build></model>')
    plate = ('<plate><metadata key="plater_id" value="{0}"/><model_instance><metadata key="object_id" value="{0}"/>'
             '<metadata key="instance_id" value="0"/></model_instance></plate>')
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("[Content_Types].xml", "<Types/>")
        file.writestr("3D/3dmodel.model", model)
        file.writestr("Metadata/model_settings.config", f"<config>{plate.format(1)}{plate.format(2)}</config>")


def sky(path):
    """A Radiance picture, 64 x 32: a bright sky with a sun, above a dark ground."""
    rows = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n")
    for y in range(32):
        for x in range(64):
            color = (60.0, 55.0, 45.0) if (x - 20) ** 2 + (y - 8) ** 2 < 2 else (0.3, 0.5, 0.9) if y < 16 else (0.12, 0.1, 0.08)
            exponent = math.frexp(max(color))[1]
            rows += bytes([*(min(255, int(c * 256 / 2.0**exponent)) for c in color), exponent + 128])
    path.write_bytes(rows)


def cameras(path):
    """NeRF's transforms.json: two cameras that look at the origin."""
    frames = []
    for name, turn in (("left", -0.6), ("right", 0.6)):
        s, c = math.sin(turn), math.cos(turn)
        frames.append({"file_path": name + ".png", "transform_matrix": [[c, 0, s, 5 * s], [0, 1, 0, 0], [-s, 0, c, 5 * c], [0, 0, 0, 1]]})
    path.write_text(json.dumps({"camera_angle_x": 0.7, "w": 320, "h": 240, "frames": frames}))


def write_all(folder):
    folder = pathlib.Path(folder)
    (folder / "models").mkdir(parents=True, exist_ok=True)
    for name in ("knot.glb", "duck.glb", "model.glb", "models/knot.glb"):
        shutil.copyfile(ROOT / "apps/examples/knot.glb", folder / name)
    for name, thickness in (("part.stl", 8), ("lever.stl", 8), ("old.stl", 8), ("new.stl", 11), ("models/part.stl", 8)):
        write_stl(folder / name, bracket(thickness))
    truck(folder / "truck.glb")
    truck(folder / "models/truck.glb")
    arm(folder / "walk.glb")
    choices(folder / "choices.glb")
    lit(folder / "lit.glb")
    tiles(folder / "tiles.glb")
    bumps(folder / "bumps.glb")
    (folder / "coarse.obj").write_text(coarse_text())
    (folder / "lines.obj").write_text(coarse_text(points_and_lines=True))
    (folder / "cloud.ply").write_text(cloud_text())
    plates(folder / "plates.3mf")
    sky(folder / "sky.hdr")
    cameras(folder / "transforms.json")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write_all(sys.argv[1])
