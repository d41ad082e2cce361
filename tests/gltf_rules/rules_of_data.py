"""Rules of buffers, bufferViews and accessors."""
import struct

from scene import BYTE, FLOAT, SHORT, UBYTE, UINT, USHORT
from table import missing, pair, put, values

POSITIONS, NORMALS, INDICES, SPARSE = 0, 1, 6, 12  # accessors of the base scene
PRIMITIVE = "meshes[0].primitives[0]"


def view_of(s, accessor):
    return s.get("accessors[%d].bufferView" % accessor)


# ---- 5.10: buffers ---------------------------------------------------------------------------------------------------------------------
missing("5.10", "buffers[0].byteLength")
values("5.10", "buffers[0].byteLength", [4096.0], [-1, 1e9, 10.5, "10", None, 2**53 + 1], with_also=lambda s: s.bin.extend(bytes(4096)),
       see="buffers[0]")
values("5.10", "buffers[1].byteLength", [1], [0], with_also=put(("buffers[1]", {"uri": "data:,abcd", "byteLength": 4})))
pair("5.10", "byteLength may have a fraction of zero",
     lambda s: s.glb(s.text().replace(b'"byteLength": %d}]' % len(s.bin), b'"byteLength": %d.0}]' % len(s.bin))),
     lambda s: s.glb(s.text().replace(b'"byteLength": %d}]' % len(s.bin), b'"byteLength": %d.5}]' % len(s.bin))), "buffers[0].byteLength")
pair("3.6.1.2", "the buffer of the BIN chunk has no uri", lambda s: None, lambda s: s.gltf().replace(b'"uri"', b'"url"'), "buffers[0]")
pair("3.6.1.2", "a later buffer has a uri", put(("buffers[1]", {"uri": "data:,abcd", "byteLength": 4})),
     put(("buffers[1]", {"byteLength": 4})), None)
pair("3.6.1.1", "a buffer that nothing uses is whole", put(("buffers[1]", {"uri": "data:,abcd", "byteLength": 3})),
     put(("buffers[1]", {"uri": "data:,abcd", "byteLength": 5})), None)
pair("3.6.1.1", "a buffer that nothing uses is there", lambda s: {"": s.put("buffers[1]", {"uri": "b.bin", "byteLength": 3}).glb(),
     "b.bin": b"abc"},
     put(("buffers[1]", {"uri": "absent.bin", "byteLength": 3})), None)
pair("3.6.1.1", "a buffer's uri is inside the folder", lambda s: {"": s.put("buffers[1]", {"uri": "b.bin", "byteLength": 3}).glb(),
     "b.bin": b"abc"},
     put(("buffers[1]", {"uri": "http://x/b.bin", "byteLength": 3})), None)
values("5.10", "buffers[0].name", ["b"], [5], see=None)
values("5.10", "buffers", [[{"byteLength": 4, "uri": "data:,abcd"}]], [{}, 5], with_also=lambda s: [s.json.pop(k) for k in (
    "scenes", "scene", "nodes", "meshes", "bufferViews", "accessors", "images", "textures", "materials", "skins")], see="buffers",
       allowed=["nothing to draw"])

# ---- 5.11: bufferViews -----------------------------------------------------------------------------------------------------------------
VIEW = "bufferViews[%d]" % 0
missing("5.11", VIEW + ".buffer")
missing("5.11", VIEW + ".byteLength")
values("5.11", VIEW + ".buffer", [0, 0.0], [1, -1, 0.5, "0", None, 2**31])
values("5.11", VIEW + ".byteOffset", [0], [-4, 2**40, 0.5, "0"], see=VIEW)
values("5.11", VIEW + ".byteLength", [48], [0, 47], see="accessors[0]")
values("5.11", VIEW + ".byteLength", [48], [2**40], see=VIEW)
values("5.11", VIEW + ".byteLength", [48.0], [-1, 48.5, "48", None])
values("5.11", VIEW + ".byteStride", [12, 12.0], [0, 3, 8, 13, 256, -12, "12"], see=VIEW)
values("5.11", VIEW + ".target", [34962], [34964, "x"], see=None)
values("5.11", VIEW + ".name", [""], [0], see=None)
pair("5.11", "indices have no byteStride", lambda s: None, lambda s: stride_of_indices(s), "bufferViews[17].byteStride")
pair("5.11", "inverse bind matrices have no byteStride", lambda s: None, lambda s: s.put("bufferViews[15].byteStride", 64),
     "bufferViews[15].byteStride")
pair("3.6.1.1", "two vertex attributes in a bufferView have a byteStride",
     lambda s: share(s).put("bufferViews[0].byteStride", 12), lambda s: share(s), "bufferViews[0].byteStride")
for wrong in [{"buffer": 7, "byteLength": 4}, {"buffer": 0, "byteLength": 2**40}, {"buffer": 0},
{"buffer": 0, "byteLength": 4, "byteStride": 3}, 5]:
    pair("5.11", "a bufferView that nothing uses is %s" % wrong,
         lambda s: s.append("bufferViews", {"buffer": 0, "byteLength": 4}) and None,
         lambda s, w=wrong: s.append("bufferViews", w) and None, None)


def stride_of_indices(s):
    """Indices four bytes apart."""
    s.put("accessors[6].bufferView", s.view(struct.pack("<12H", 0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0), byteStride=4))


def share(s):
    """Positions and normals in one bufferView, one after the other."""
    s.get("bufferViews[0]")["byteLength"] = 96
    s.put("accessors[1].bufferView", 0).put("accessors[1].byteOffset", 48)
    return s


# ---- 5.1: accessors --------------------------------------------------------------------------------------------------------------------
A = "accessors[0]"
for key in ["componentType", "count", "type"]:
    missing("5.1", A + "." + key)
values("5.1", A + ".bufferView", [0], [99, -1, 1.5, "0"], see=A)
values("5.1", A + ".byteOffset", [0], [-4, 4, 2**40, 0.5, "0"], see=A)
values("5.1", A + ".componentType", [FLOAT], [5124, 5130, 0, -1, "5126", USHORT, UINT], see=A)
values("5.1", A + ".count", [4, 4.0], [5, -4, 2**53, 4.5, "4"], see=A)
values("5.1", "accessors[1].count", [4], [3, 0], see="accessors[1]")
values("5.1", A + ".type", ["VEC3"], ["vec3", "VEC9", "", 3, "VEC2", "VEC4", "SCALAR"], see=A)
values("5.1", A + ".normalized", [False], [True, "no", 0], see="")
values("5.1", A + ".name", [""], [0], see=None)
for key, good, bad in [("min", [-1, -1, 0], [-1, -1]), ("max", [1, 1, 0], [1, 1, 0, 1]), ("max", [1, 1, 0], [9, 9, 9]),
                        ("min", [-1, -1, 0], [])]:
    values("3.6.2.5", A + "." + key, [good], [bad], see=None)
pair("3.7.2.1", "POSITION has min and max", lambda s: None, lambda s: s.drop(A + ".min"), None)
pair("3.6.2.4", "an accessor's offset is a multiple of its component", lambda s: moved(s, 4), lambda s: moved(s, 2), A + ".byteOffset")
pair("3.6.2.4", "a bufferView's offset is a multiple of its component", lambda s: shifted(s, 0, 4), lambda s: shifted(s, 0, 2),
     "bufferViews")
pair("3.6.2.4", "a vertex attribute begins at a multiple of 4", lambda s: moved(s, 4, 5), lambda s: moved(s, 2, 5),
     "accessors[5].byteOffset")
pair("3.6.2.4", "vertices are a multiple of 4 bytes apart", lambda s: rgb(s, 4), lambda s: rgb(s, 0), "accessors")
pair("3.6.2.4", "indices begin at a multiple of their size", lambda s: shifted(s, INDICES, 2), lambda s: shifted(s, INDICES, 1),
     "bufferViews")
pair("3.6.2.1", "floats are finite", lambda s: s.poke(0, 2, FLOAT, [1e-42]), lambda s: s.poke(0, 2, FLOAT, [float("nan")]),
     PRIMITIVE + ".attributes.POSITION")
pair("3.6.2.1", "floats are not infinite", lambda s: s.poke(0, 2, FLOAT, [1e-38]), lambda s: s.poke(0, 2, FLOAT, [float("inf")]),
     PRIMITIVE + ".attributes.POSITION")
pair("3.6.2.1", "texture coordinates are finite", lambda s: s.poke(3, 2, FLOAT, [-3.5]), lambda s: s.poke(3, 2, FLOAT, [float("inf")]),
     PRIMITIVE + ".attributes.TEXCOORD_0")
pair("3.6.2.1", "floats are not normalized", lambda s: None, lambda s: s.put("accessors[3].normalized", True), "accessors[3].normalized")
for wrong in [{"bufferView": 99, "componentType": FLOAT, "count": 1, "type": "VEC3"},
{"bufferView": 0, "componentType": FLOAT, "count": 9, "type": "VEC3"},
              {"bufferView": 0, "componentType": 1, "count": 1, "type": "VEC3"}, {"componentType": FLOAT, "count": 1}, 7,
              {"componentType": FLOAT, "count": 0, "type": "VEC7"}, {"componentType": FLOAT, "count": 1, "type": "VEC3", "sparse": {}}]:
    pair("5.1", "an accessor that nothing uses is %s" % wrong,
         lambda s: s.append("accessors", {"bufferView": 0, "componentType": FLOAT, "count": 4, "type": "VEC3"}) and None,
         lambda s, w=wrong: s.append("accessors", w) and None, None)


def moved(s, by, accessor=0):
    """An accessor's data at an offset inside their bufferView."""
    old = s.get("bufferViews[%d]" % view_of(s, accessor))
    view = s.view(bytes(by) + bytes(s.bin[old["byteOffset"]:old["byteOffset"] + old["byteLength"]]))
    s.put("accessors[%d].bufferView" % accessor, view).put("accessors[%d].byteOffset" % accessor, by)


def shifted(s, accessor, by):
    """An accessor's data in a bufferView that begins `by` bytes after a multiple of 4."""
    old = s.get("bufferViews[%d]" % view_of(s, accessor))
    view = s.view(bytes(by) + bytes(s.bin[old["byteOffset"]:old["byteOffset"] + old["byteLength"]]))
    s.get("bufferViews[%d]" % view)["byteOffset"] += by
    s.get("bufferViews[%d]" % view)["byteLength"] -= by
    s.put("accessors[%d].bufferView" % accessor, view)


def rgb(s, pad_to):
    """Colours of three bytes, packed or padded."""
    s.put(PRIMITIVE + ".attributes.COLOR_0", s.accessor("VEC3", UBYTE, [9, 99, 199] * 4, pad_to=pad_to, normalized=True))


# ---- accessors without bufferView are zeros (3.6.2.1) ----------------------------------------------------------------------------------
def zeros(s, kind="VEC3", count=4):
    return s.append("accessors", {"componentType": FLOAT, "count": count, "type": kind})


pair("3.6.2.1", "an accessor without bufferView is zeros", lambda s: s.put(PRIMITIVE + ".targets[0].POSITION", zeros(s)),
     lambda s: s.put(PRIMITIVE + ".targets[0].POSITION", zeros(s, count=3)), PRIMITIVE)
pair("3.6.2.1", "texture coordinates without bufferView are zeros", lambda s: s.put("meshes[1].primitives[0].attributes.TEXCOORD_0",
     zeros(s, "VEC2", 3)),
     lambda s: s.put("meshes[1].primitives[0].attributes.TEXCOORD_0", zeros(s, "VEC3", 3)), "meshes[1].primitives[0]")
pair("5.1", "byteOffset comes with a bufferView", lambda s: s.put(PRIMITIVE + ".targets[0].POSITION", zeros(s)),
     lambda s: s.put(PRIMITIVE + ".targets[0].POSITION", zeros(s)).put("accessors[14].byteOffset", 4), None)

# ---- 3.6.2.3: sparse accessors ---------------------------------------------------------------------------------------------------------
S = "accessors[%d].sparse" % SPARSE
for key in ["count", "indices", "values", "indices.bufferView", "indices.componentType", "values.bufferView"]:
    missing("5.2", S + "." + key)
values("5.2", S + ".count", [1, 1.0], [0, 2, 4, -1, 0.5, "1", 2**31], see=S)
values("5.3", S + ".indices.componentType", [USHORT], [FLOAT, SHORT, BYTE, UINT, 5], see=S)
values("5.3", S + ".indices.bufferView", [14, 14.0], [99, -1, None], see=S,
       with_also=lambda s: s.get(S + ".indices").update(bufferView=14))
values("5.3", S + ".indices.byteOffset", [0], [2, -2, 2**40, 1.5], see=S)
values("5.4", S + ".values.bufferView", [13], [99, -1], see=S)
values("5.4", S + ".values.byteOffset", [0, 0.0], [4, -4, 2**40], see=S)
for name, good, bad in [("indices rise", [0, 2], [2, 0]), ("indices are there once", [1, 2], [1, 1]),
                         ("indices are below count", [0, 2], [0, 3])]:
    def apply(s, indices):
        where, changed = s.view(struct.pack("<2H", *indices)), s.view(struct.pack("<6f", 2, 2, 0, 3, 3, 0))
        s.put(S, {"count": 2, "indices": {"bufferView": where, "componentType": USHORT}, "values": {"bufferView": changed}})
    pair("3.6.2.3", name, lambda s, v=good, f=apply: f(s, v), lambda s, v=bad, f=apply: f(s, v), S)
pair("5.3", "sparse indices have no byteStride", lambda s: None, put(("bufferViews[14].byteStride", 4)), "bufferViews[14].byteStride")
pair("5.4", "sparse values have no byteStride", lambda s: None, put(("bufferViews[13].byteStride", 12)), "bufferViews[13].byteStride")
pair("3.6.2.4", "sparse indices begin at a multiple of their size", lambda s: odd(s, 2), lambda s: odd(s, 1), S + ".indices.byteOffset")


def odd(s, by):
    """A sparse index at an offset inside its bufferView."""
    s.put(S + ".indices", {"bufferView": s.view(bytes(by) + struct.pack("<H", 2)), "byteOffset": by, "componentType": USHORT})
