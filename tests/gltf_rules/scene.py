"""A small glTF scene with all features in use, which the rules change in one place each."""
import base64
import copy
import json
import re
import struct
import zlib

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126


def png(width=2, height=2):
    """A picture of one grey-blue, RGB, 8 bits."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = (b"\0" + bytes([128, 128, 255]) * width) * height
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def steps_of(path):
    """"a[0].b" as ["a", 0, "b"]."""
    return [int(number) if number else key for key, number in re.findall(r"([^.\[\]]+)(?=[.\[]|$)|\[(\d+)\]", path) if key or number]


def chunk(kind, body, pad):
    return struct.pack("<II", len(body) + -len(body) % 4, kind) + body + pad * (-len(body) % 4)


JSON_CHUNK, BIN_CHUNK = 0x4E4F534A, 0x004E4942


class Scene:
    def __init__(self):
        self.json, self.bin, self.files = {}, bytearray(), {}

    def copy(self):
        return copy.deepcopy(self)

    # ---- binary data ---------------------------------------------------------------------------------------------------------------
    def view(self, data, **members):
        """Appends bytes, aligned to 4, and a bufferView of them. Returns its index."""
        self.bin += bytes(-len(self.bin) % 4)
        views = self.json.setdefault("bufferViews", [])
        views.append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data), **members})
        self.bin += data
        self.json["buffers"][0]["byteLength"] = len(self.bin)
        return len(views) - 1

    def accessor(self, kind, component, values, pad_to=0, **members):
        """Appends an accessor of elements. Elements are padded to `pad_to` bytes. Returns its index."""
        n = COMPONENTS[kind]
        data = b""
        for i in range(0, len(values), n):
            element = struct.pack("<%d%s" % (n, FORMATS[component]), *values[i:i + n])
            data += element + bytes(max(0, pad_to - len(element)))
        view = self.view(data, **({"byteStride": pad_to} if pad_to else {}))
        entry = {"bufferView": view, "componentType": component, "count": len(values) // n, "type": kind, **members}
        if members.get("min") is True:
            columns = [values[i::n] for i in range(n)]
            entry["min"], entry["max"] = [min(c) for c in columns], [max(c) for c in columns]
        self.json.setdefault("accessors", []).append(entry)
        return len(self.json["accessors"]) - 1

    def poke(self, accessor, index, component, values):
        """Overwrites stored values of one accessor."""
        entry = self.json["accessors"][accessor]
        view = self.json["bufferViews"][entry["bufferView"]]
        size = struct.calcsize(FORMATS[component])
        at = view["byteOffset"] + index * size
        self.bin[at:at + size * len(values)] = struct.pack("<%d%s" % (len(values), FORMATS[component]), *values)

    # ---- JSON ----------------------------------------------------------------------------------------------------------------------
    def get(self, path):
        here = self.json
        for step in steps_of(path):
            here = here[step]
        return here

    def put(self, path, value):
        """Sets a value. Objects on the way are made, and an array grows by one element."""
        *way, last = steps_of(path)
        here = self.json
        for i, step in enumerate(way):
            following = (way + [last])[i + 1]
            fresh = [] if isinstance(following, int) else {}
            if isinstance(here, list):
                if step == len(here):
                    here.append(fresh)
                here = here[step]
            else:
                here = here.setdefault(step, fresh)
        if isinstance(here, list) and last == len(here):
            here.append(value)
        else:
            here[last] = value
        return self

    def drop(self, path):
        *way, last = steps_of(path)
        here = self.json
        for step in way:
            here = here[step]
        del here[last]
        return self

    def append(self, path, value):
        """Appends to an array, which is made if it is not there. Returns the element's index."""
        *way, last = steps_of(path)
        here = self.json
        for step in way:
            here = here[step]
        if isinstance(here, dict):
            here.setdefault(last, [])
        here[last].append(value)
        return len(here[last]) - 1

    # ---- files ---------------------------------------------------------------------------------------------------------------------
    def text(self):
        return json.dumps(self.json).encode()

    def glb(self, text=None, extra=b"", version=2, length=None):
        body = chunk(JSON_CHUNK, text if text is not None else self.text(), b" ")
        if self.bin:
            body += chunk(BIN_CHUNK, bytes(self.bin), b"\0")
        size = 12 + len(body) + len(extra) if length is None else length
        return b"glTF" + struct.pack("<II", version, size) + body + extra

    def gltf(self, uri=None):
        """The same as text, with its buffer as a data URI or at `uri`."""
        other = self.copy()
        data = "data:application/octet-stream;base64," + base64.b64encode(self.bin).decode()
        other.json["buffers"][0]["uri"] = data if uri is None else uri
        return other.text()


IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
LIGHTS = "extensions.KHR_lights_punctual.lights"
PBR = "materials[0].pbrMetallicRoughness"
PRIMITIVE = "meshes[0].primitives[0]"


def quad(s, material=0, **more):
    """Attributes of a square of four vertices and two triangles."""
    positions = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]
    corners = [0, 0, 1, 0, 1, 1, 0, 1]
    primitive = {"attributes": {"POSITION": s.accessor("VEC3", FLOAT, positions, min=True, max=None),
                                "NORMAL": s.accessor("VEC3", FLOAT, [0, 0, 1] * 4),
                                "TANGENT": s.accessor("VEC4", FLOAT, [1, 0, 0, 1] * 4),
                                "TEXCOORD_0": s.accessor("VEC2", FLOAT, corners),
                                "TEXCOORD_1": s.accessor("VEC2", USHORT, [c * 65535 for c in corners], normalized=True),
                                "COLOR_0": s.accessor("VEC4", UBYTE, [255, 200, 150, 255] * 4, normalized=True)},
                 "indices": s.accessor("SCALAR", USHORT, [0, 1, 2, 0, 2, 3]), "material": material}
    primitive.update(more)
    return primitive


def base():
    """Mesh 0: textured, morphed, skinned. Mesh 1: plain, sparse, placed by a transform. Five cameras and lights by nodes 4 to 8."""
    s = Scene()
    s.json = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 0}], "scene": 0,
              "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform"]}
    textured = quad(s)
    textured["attributes"]["JOINTS_0"] = s.accessor("VEC4", UBYTE, [0, 1, 0, 0] * 4)
    textured["attributes"]["WEIGHTS_0"] = s.accessor("VEC4", FLOAT, [0.5, 0.5, 0, 0] * 4)
    textured["targets"] = [{"POSITION": s.accessor("VEC3", FLOAT, [0, 0, 0.5] * 4, min=True, max=None),
                            "NORMAL": s.accessor("VEC3", FLOAT, [0, 0.1, 0] * 4), "TANGENT": s.accessor("VEC3", FLOAT, [0, 0.1, 0] * 4)}]
    sparse = s.accessor("VEC3", FLOAT, [2, 0, 0, 3, 0, 0, 2, 1, 0], min=[2, 0, 0], max=[3, 2, 0])
    changed, where = s.view(struct.pack("<3f", 2, 2, 0)), s.view(struct.pack("<H", 2))
    s.json["accessors"][sparse]["sparse"] = {"count": 1, "indices": {"bufferView": where, "componentType": USHORT},
                                             "values": {"bufferView": changed}}
    bind = s.accessor("MAT4", FLOAT, IDENTITY * 2)
    s.json["meshes"] = [{"name": "textured", "primitives": [textured], "weights": [0.25]},
                        {"primitives": [{"attributes": {"POSITION": sparse}, "material": 1}]}]
    s.json["images"] = [{"bufferView": s.view(png()), "mimeType": "image/png"}]
    s.json["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 33071}]
    s.json["textures"] = [{"source": 0, "sampler": 0}]
    transform = {"extensions": {"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 3]}}}
    s.json["materials"] = [
        {"name": "all", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": True, "emissiveFactor": [0.1, 0.2, 0.3],
         "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
                                  "baseColorTexture": {"index": 0, **transform}, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}},
         "normalTexture": {"index": 0, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.5}, "emissiveTexture": {"index": 0},
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}},
        {"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1]}}]
    s.json["skins"] = [{"joints": [2, 3], "inverseBindMatrices": bind, "skeleton": 2}]
    s.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 100, "aspectRatio": 1.5}},
                         {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 100}}]
    s.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"type": "directional", "color": [1, 1, 0.5], "intensity": 2}, {"type": "point", "intensity": 5, "range": 10},
        {"type": "spot", "intensity": 5, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}}]}}
    s.json["nodes"] = [{"mesh": 0, "skin": 0, "weights": [0.5]}, {"mesh": 1, "translation": [0, 1, 0], "rotation": [0, 0, 0.6, 0.8],
                                                                  "scale": [1, 2, 1]}, {"children": [3]}, {"translation": [0, 0.5, 0]}]
    s.json["nodes"] += [{"camera": 0, "translation": [0, 0, 5]}, {"camera": 1, "matrix": IDENTITY}]
    s.json["nodes"] += [{"extensions": {"KHR_lights_punctual": {"light": i}}} for i in range(3)]
    s.json["scenes"] = [{"nodes": [0, 1, 2, 4, 5, 6, 7, 8]}]
    return s
