"""Rules of meshes, attributes, indices, morph targets and skins."""
from scene import BYTE, FLOAT, IDENTITY, SHORT, UBYTE, UINT, USHORT
from table import missing, pair, put, values

P = "meshes[0].primitives[0]"
ATTRIBUTES = P + ".attributes"

# ---- 5.23 and 5.24: meshes -------------------------------------------------------------------------------------------------------------
missing("5.23", "meshes[0].primitives")
missing("5.24", ATTRIBUTES)
values("5.23", "meshes[0].primitives", [[{"attributes": {"POSITION": 0, "JOINTS_0": 7, "WEIGHTS_0": 8}, "mode": 5}]], [{}, 5, None],
       allowed=["weights"])
values("5.23", "meshes[1].name", ["\u00e4"], [5, None], see=None)
values("5.24", ATTRIBUTES + ".POSITION", [0, 0.0], [99, -1, "0", 0.5, None])
values("5.24", P + ".indices", [6], [99, -1, "6"])
values("5.24", P + ".material", [0], [9, -1, "0"])
values("5.24", P + ".mode", [4], [7, -1, "4", 4.5])
pair("5.24", "attributes has a member", lambda s: None, lambda s: s.put("meshes[1].primitives[0].attributes", {}),
     "meshes[1].primitives[0]")
pair("3.7.2.1", "a primitive has POSITION", lambda s: None, lambda s: s.drop("meshes[1].primitives[0].attributes.POSITION"),
     "meshes[1].primitives[0]")
pair("3.7.2.1", "lines have an even number of indices", lambda s: (s.put(P + ".mode", 1), indices(s, USHORT, [0, 1])) and None,
     lambda s: (s.put(P + ".mode", 1), indices(s, USHORT, [0, 1, 2])) and None, P)
pair("3.7.2.1", "a mesh that nothing draws is whole",
     lambda s: s.append("meshes", {"primitives": [{"attributes": {"POSITION": 0}}]}) and None,
     lambda s: s.append("meshes", {"primitives": [{"attributes": {"POSITION": 99}, "material": 77, "indices": 2}]}) and None, None)
pair("5.23", "a mesh that nothing draws has primitives",
     lambda s: s.append("meshes", {"primitives": [{"attributes": {"POSITION": 0}}]}) and None,
     lambda s: s.append("meshes", {"weights": "none"}) and None, None)

# ---- 3.7.2.1: types of attributes ------------------------------------------------------------------------------------------------------
UNIT_RANGE = [(FLOAT, False), (UBYTE, True), (USHORT, True)]
TYPES = [  # attribute, kind, component types that are allowed: (component, normalized), values of an element
    ("POSITION", "VEC3", [(FLOAT, False)], [1, 2, 3]), ("NORMAL", "VEC3", [(FLOAT, False)], [0, 0, 1]),
    ("TANGENT", "VEC4", [(FLOAT, False)], [1, 0, 0, 1]),
    ("TEXCOORD_0", "VEC2", [(FLOAT, False), (UBYTE, True), (USHORT, True)], [1, 0]),
    ("TEXCOORD_1", "VEC2", [(UBYTE, True), (FLOAT, False), (USHORT, True)], [1, 0]),
    ("COLOR_0", "VEC4", [(FLOAT, False), (UBYTE, True), (USHORT, True)], [1, 1, 1, 1]),
    ("COLOR_0", "VEC3", [(USHORT, True), (FLOAT, False)], [1, 1, 1]), ("JOINTS_0", "VEC4", [(UBYTE, False), (USHORT, False)], [0, 1, 0,
    0]),
    ("WEIGHTS_0", "VEC4", [(FLOAT, False), (UBYTE, True), (USHORT, True)], [1, 0, 0, 0])]
ONE = {UBYTE: 255, USHORT: 65535, BYTE: 127, SHORT: 32767, UINT: 2**32 - 1, FLOAT: 1}
SIZES = {UBYTE: 1, BYTE: 1, USHORT: 2, SHORT: 2, UINT: 4, FLOAT: 4}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def attribute(s, name, kind, component, normalized, element, count=4):
    n = COUNTS[kind]
    element = (element * 4)[:n]
    data = [min(v, 1) * ONE[component] if normalized else v for v in element] * count
    size = n * SIZES[component]
    more = {"normalized": True} if normalized else {}
    s.put(ATTRIBUTES + "." + name, s.accessor(kind, component, data, pad_to=0 if size % 4 == 0 else size + -size % 4, **more))


for name, kind, allowed, element in TYPES:
    every_component = [(c, n) for c in ONE for n in ([False] if c in (UINT, FLOAT) else [False, True])]
    fine = UNIT_RANGE if name[:5] in ("TEXCO", "COLOR") else allowed
    wrong = [t for t in every_component if t not in fine]
    for i, bad in enumerate(wrong):
        pair("3.7.2.1", "%s %s is not of %d%s" % (name, kind, bad[0], " normalized" if bad[1] else ""),
             lambda s, a=(name, kind, *allowed[i % len(allowed)], element): attribute(s, *a),
             lambda s, a=(name, kind, *bad, element): attribute(s, *a), P)
    for other in [k for k in COUNTS if k != kind and not (name == "COLOR_0" and k in ("VEC3", "VEC4"))]:
        pair("3.7.2.1", "%s is not of %s" % (name, other), lambda s, a=(name, kind, *allowed[0], element): attribute(s, *a),
             lambda s, a=(name, other, *allowed[0], element): attribute(s, *a), P)
    if name != "POSITION":
        pair("3.7.2.1", "%s %s has as many elements as POSITION" % (name, kind),
             lambda s, a=(name, kind, *allowed[-1], element): attribute(s, *a),
             lambda s, a=(name, kind, *allowed[-1], element): attribute(s, *a, count=3), P)
for name in ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"):
    def quantized(s, name=name, listed=True):
        kind = {"TANGENT": "VEC4", "TEXCOORD_0": "VEC2"}.get(name, "VEC3")
        if listed:
            s.json["extensionsUsed"].append("KHR_mesh_quantization")
            s.put("extensionsRequired", ["KHR_mesh_quantization"])
        attribute(s, name, kind, SHORT, True, [1, 0, 0, 1] if name == "TANGENT" else [0, 0, 1])
    pair("KHR_mesh_quantization", name + " of small integers needs the extension", quantized, lambda s, f=quantized: f(s, listed=False), P)

# ---- 3.7.2.1: values of attributes -----------------------------------------------------------------------------------------------------
pair("3.7.2.1", "normals have length 1", lambda s: s.poke(1, 0, FLOAT, [0.6, 0, 0.8]), lambda s: s.poke(1, 0, FLOAT, [0, 0, 2]),
     ATTRIBUTES + ".NORMAL")
pair("3.7.2.1", "normals are not zero", lambda s: s.poke(1, 0, FLOAT, [0, -1, 0]), lambda s: s.poke(1, 0, FLOAT, [0, 0, 0]),
     ATTRIBUTES + ".NORMAL")
pair("3.7.2.1", "tangents have length 1", lambda s: s.poke(2, 0, FLOAT, [0, 1, 0]), lambda s: s.poke(2, 0, FLOAT, [0.1, 0, 0]),
     ATTRIBUTES + ".TANGENT")
pair("3.7.2.1", "tangents have a sign of 1 or -1", lambda s: s.poke(2, 3, FLOAT, [-1]), lambda s: s.poke(2, 3, FLOAT, [0]),
     ATTRIBUTES + ".TANGENT")
for name in ("NORMAL", "TEXCOORD_0", "COLOR_0"):
    pair("3.7.2.1", "%s is finite" % name, lambda s, n=name: None,
         lambda s, n=name: (s.put("meshes[0].primitives[0].attributes.COLOR_0", s.accessor("VEC4", FLOAT, [1] * 16)),
                            s.poke(s.get(ATTRIBUTES + "." + n), 0, FLOAT, [float("nan")])) and None, ATTRIBUTES + "." + name)
pair("3.7.2.1", "attributes of an application begin with a low line", lambda s: s.put(ATTRIBUTES + "._AGE", 3),
     lambda s: s.put(ATTRIBUTES + ".AGE", 3), None)
pair("3.7.2.1", "sets of an attribute are numbered from 0", lambda s: s.put(ATTRIBUTES + ".COLOR_1", 5),
     lambda s: s.put(ATTRIBUTES + ".COLOR_01", 5), None)
for name in ("TEXCOORD_2", "COLOR_1", "_AGE"):
    for wrong in (99, -1, "3", None):
        pair("5.24", "%s, which is not drawn, is %s" % (name, wrong), put((ATTRIBUTES + "." + name, 3 if name[0] == "T" else 5)),
             put((ATTRIBUTES + "." + name, wrong)), None)
pair("5.24", "joints of a mesh without a skin are whole",
     lambda s: s.put("meshes[1].primitives[0].attributes", {"POSITION": 12, "JOINTS_0": s.accessor("VEC4", UBYTE, [0] * 12),
                                                            "WEIGHTS_0": s.accessor("VEC4", FLOAT, [1, 0, 0, 0] * 3)}),
     put(("meshes[1].primitives[0].attributes.JOINTS_0", 3)), None)

# ---- 3.7.2.1: indices ------------------------------------------------------------------------------------------------------------------
def indices(s, component, values_, **members):
    s.put(P + ".indices", s.accessor("SCALAR", component, values_, **members))


for component in (UBYTE, USHORT, UINT):
    top = ONE[component]
    good = lambda s, c=component: indices(s, c, [0, 1, 2, 3, 2, 0])
    pair("3.7.2.1", "indices %d are below the number of vertices" % component, good,
         lambda s, c=component: indices(s, c, [0, 1, 2, 0, 1, 4]), P + ".indices")
    pair("3.7.2.1", "indices %d do not restart" % component, good, lambda s, c=component, t=top: indices(s, c, [0, 1, 2, 0, 1, t]),
         P + ".indices")
    pair("3.7.2.1", "indices %d are not normalized" % component, good,
         lambda s, c=component: indices(s, c, [0, 1, 2, 3, 2, 0], normalized=True), P + ".indices")
    pair("3.7.2.1", "indices %d of triangles are a multiple of 3" % component, good, lambda s, c=component: indices(s, c, [0, 1, 2, 0]), P)
for component in (BYTE, SHORT, FLOAT):
    pair("3.7.2.1", "indices are not of %d" % component, lambda s: indices(s, UBYTE, [0, 1, 2]),
         lambda s, c=component: indices(s, c, [0, 1, 2]), P + ".indices")
pair("3.7.2.1", "indices are scalars", lambda s: indices(s, USHORT, [3, 1, 2]),
     lambda s: s.put(P + ".indices", s.accessor("VEC2", USHORT, [0, 1, 2, 3, 1, 2])), P + ".indices")
pair("3.7.2.1", "vertices without indices are a multiple of 3", lambda s: s.drop(P + ".indices").put(P + ".mode", 5),
     lambda s: s.drop(P + ".indices"), P)
for mode in (5, 6):
    pair("3.7.2.1", "mode %d has at least 3 indices" % mode, lambda s, m=mode: (s.put(P + ".mode", m), indices(s, USHORT, [0, 1, 2,
         3]))and None,
         lambda s, m=mode: (s.put(P + ".mode", m), indices(s, USHORT, [0, 1])) and None, P)
pair("5.1", "indices have an element", lambda s: None, lambda s: s.put("accessors[6].count", 0), "accessors[6].count")

# ---- 3.7.2.2: morph targets ------------------------------------------------------------------------------------------------------------
values("3.7.2.2", "meshes[0].weights", [[0]], [[0.5, 0.5], 0.5, ["0.5"], [None]])
values("3.7.2.2", "nodes[0].weights", [[1], [-2]], [[0.5, 0.5], 0.5, ["0.5"]])
values("3.7.2.2", P + ".targets[0].POSITION", [9], [99, -1, "9", 13, 3])
for name, wrong in [("NORMAL", 3), ("TANGENT", 2), ("NORMAL", 5), ("POSITION", 12)]:
    pair("3.7.2.2", "a target's %s is not accessor %d" % (name, wrong), lambda s: None, put((P + ".targets[0]." + name, wrong)),
         P + ".targets[0]")
values("3.7.2.2", P + ".targets", [[{"POSITION": 9}]], [{}, 5, [5]], see=P + ".targets")
pair("3.7.2.2", "primitives of a mesh have the same number of targets", lambda s: twice(s, 1), lambda s: twice(s, 0),
     "meshes[0].primitives[1].targets")
pair("3.7.2.2", "weights on a node need targets", put(("nodes[0].weights", [1])), put(("nodes[1].weights", [1])), "nodes[1].weights")
pair("3.7.2.2", "a target of weight 0 is whole", put(("nodes[0].weights", [0])),
     put(("nodes[0].weights", [0]), (P + ".targets[0].POSITION", 3)), None)


def twice(s, targets):
    """A second primitive, with or without a morph target."""
    second = {"attributes": {"POSITION": 0, "JOINTS_0": 7, "WEIGHTS_0": 8}, "indices": 6}
    if targets:
        second["targets"] = [{"POSITION": 9}]
    s.append("meshes[0].primitives", second)


# ---- 3.7.3: skins ----------------------------------------------------------------------------------------------------------------------
missing("5.28", "skins[0].joints")
values("5.28", "skins[0].joints", [[2, 3]], [5, {}])
values("5.28", "skins[0].joints[1]", [3], [99, -1, "3"])
values("5.28", "skins[0].inverseBindMatrices", [13], [99, -1, "x", 8, 0], see="skins[0]")
values("5.28", "skins[0].skeleton", [2], [99, -1, "x"], see=None)
values("5.28", "skins[0].name", [""], [5], see=None)
pair("5.28", "joints has no node twice", put(("skins[0].joints", [3, 2])), put(("skins[0].joints", [2, 2])), None)
pair("3.7.3.1", "there is a matrix for each joint", lambda s: matrices(s, IDENTITY * 3), lambda s: matrices(s, IDENTITY), "skins[0]")
pair("3.7.3.1", "the last row of a bind matrix is 0 0 0 1", lambda s: matrices(s, [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 1, 0, 1] * 2),
     lambda s: matrices(s, (IDENTITY[:3] + [0.5] + IDENTITY[4:]) * 2), "skins[0].inverseBindMatrices")
pair("3.7.3.1", "bind matrices are finite", lambda s: matrices(s, IDENTITY * 2),
     lambda s: matrices(s, [float("nan")] + IDENTITY[1:] + IDENTITY),
     "skins[0].inverseBindMatrices")
pair("3.7.3.3", "JOINTS_0 comes with WEIGHTS_0", lambda s: None, lambda s: s.drop(ATTRIBUTES + ".WEIGHTS_0"), P)
pair("3.7.3.3", "WEIGHTS_0 comes with JOINTS_0", lambda s: None, lambda s: s.drop(ATTRIBUTES + ".JOINTS_0"), P)
pair("3.7.3.3", "a second set has joints and weights", lambda s: second_set(s, True), lambda s: second_set(s, False), P)
pair("3.7.3.3", "joints are below their number", lambda s: s.poke(7, 0, UBYTE, [1]), lambda s: s.poke(7, 0, UBYTE, [2]), P)
pair("3.7.3.3", "weights are not negative", lambda s: s.poke(8, 0, FLOAT, [0, 1]), lambda s: s.poke(8, 0, FLOAT, [-0.5, 1.5]),
     ATTRIBUTES + ".WEIGHTS_0")
pair("3.7.3.3", "weights have the sum 1", lambda s: s.poke(8, 0, FLOAT, [0.25, 0.75]), lambda s: s.poke(8, 0, FLOAT, [0.25, 0.25]),
     ATTRIBUTES + ".WEIGHTS_0")
pair("3.7.3.3", "weights are not all 0", lambda s: s.poke(8, 0, FLOAT, [1, 0]), lambda s: s.poke(8, 0, FLOAT, [0, 0]),
     ATTRIBUTES + ".WEIGHTS_0")
pair("3.7.3.3", "a skin is for meshes with joints", lambda s: None, put(("nodes[1].skin", 0)), "meshes[1].primitives[0]")
pair("5.25", "a skin comes with a mesh", lambda s: None, put(("nodes[3].skin", 0)), None)
pair("5.28", "a skin that nothing uses is whole", lambda s: s.append("skins", {"joints": [2]}) and None,
     lambda s: s.append("skins", {"joints": [77]}) and None, None)


def matrices(s, values_):
    s.put("skins[0].inverseBindMatrices", s.accessor("MAT4", FLOAT, values_))


def second_set(s, whole):
    s.put(ATTRIBUTES + ".JOINTS_1", 7)
    if whole:
        s.put(ATTRIBUTES + ".WEIGHTS_1", s.accessor("VEC4", FLOAT, [0] * 16))
