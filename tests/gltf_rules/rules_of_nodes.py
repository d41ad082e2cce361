"""Rules of scenes, nodes, transforms, cameras, lights and animations."""
from scene import FLOAT, IDENTITY, LIGHTS
from table import missing, pair, put, values

# ---- 5.27 and 3.5.1: scenes ------------------------------------------------------------------------------------------------------------
values("5.17", "scene", [0, 0.0], [1, -1, "0", 0.5, None])
values("5.17", "scenes", [[{"nodes": [0, 1, 2]}]], [{}, 5, [5]])
values("5.27", "scenes[0].nodes", [[1]], [5, {}, None])
values("5.27", "scenes[0].nodes[0]", [0, 0.0], [99, -1, "0", 0.5])
values("5.27", "scenes[0].name", [""], [5], see=None)
pair("3.5.1", "a scene lists roots", put(("scenes[0].nodes", [0, 1, 2])), put(("scenes[0].nodes", [0, 1, 3])), "scenes[0].nodes[2]")
pair("5.27", "a scene lists each node once", put(("scenes[0].nodes", [1, 0])), put(("scenes[0].nodes", [1, 1])), "scenes[0].nodes[1]")
pair("5.27", "a scene that is not drawn is whole", put(("scenes[1]", {"nodes": [1]})), put(("scenes[1]", {"nodes": [99]})), None)

# ---- 5.25 and 3.5.2: nodes -------------------------------------------------------------------------------------------------------------
values("5.25", "nodes[1].mesh", [1, 1.0], [99, -1, "1", 0.5, None])
values("5.25", "nodes[0].skin", [0], [99, -1, "0"])
values("5.25", "nodes[4].camera", [0], [99, -1, "0"])
values("5.25", "nodes[2].children", [[3]], [3, {}, None])
values("5.25", "nodes[2].children[0]", [3], [99, -1, "3", 0.5])
values("5.25", "nodes[1].name", ["\u00e4", ""], [5, None, []], see=None)
values("5.17", "nodes", [[{"mesh": 1}] * 9], [{}, 5], allowed=["weights"])
pair("3.5.2", "a node is not its own child", put(("nodes[2].children", [3])), put(("nodes[2].children", [2])), "nodes[2].children")
pair("3.5.2", "a node is not its own ancestor", put(("nodes[3].children", [])), put(("nodes[3].children", [2])), "nodes[")
pair("3.5.2", "a node has one parent", put(("nodes[2].children", [3])), put(("nodes[2].children", [3]), ("nodes[1].children", [3])),
     "nodes[2].children")
pair("5.25", "children has a node once", put(("nodes[2].children", [3])), put(("nodes[2].children", [3, 3])), "nodes[2].children")
pair("5.25", "a node that nothing draws names a mesh", lambda s: s.append("nodes", {"mesh": 0}) and None,
     lambda s: s.append("nodes", {"mesh": 99}) and None, None)
pair("5.25", "a node that nothing draws has a transform", lambda s: s.append("nodes", {"scale": [1, 1, 1]}) and None,
     lambda s: s.append("nodes", {"scale": [1, 1]}) and None, None)

# ---- 3.5.3: transforms -----------------------------------------------------------------------------------------------------------------
N = "nodes[1]"
for key, good in [("translation", [-1e30, 0, 1e-42]), ("rotation", [0, 0, 0, -1]), ("scale", [-1, 1e-3, 2])]:
    values("5.25", N + "." + key, [good], [good[:-1], good + [1], {}, 5, ["x"] * len(good)], see=N + "." + key)
values("5.25", N + ".rotation", [[0.5, 0.5, 0.5, 0.5], [1, 0, 0, 0]], [[0, 0, 0, 2], [0.5, 0.5, 0.5, 0.6], [0, 0, 0, 0]])
values("5.25", N + ".rotation[0]", [0], [1.5], see=N + ".rotation")
ALONE = lambda s: [s.drop(N + "." + key) for key in ("translation", "rotation", "scale")]
values("5.25", N + ".matrix", [[2] + IDENTITY[1:]], [IDENTITY[:15], IDENTITY + [0], [1, 2], {}, "identity"], with_also=ALONE)
values("3.5.3", N + ".matrix", [IDENTITY[:12] + [5, 6, 7, 1]],
       [[1, 0, 0, 0.5] + IDENTITY[4:], IDENTITY[:15] + [2], [1, 0, 0, 0, 1, 1, 0, 0] + IDENTITY[8:]], with_also=ALONE)
for key, value in [("translation", [1, 0, 0]), ("rotation", [0, 0, 0, 1]), ("scale", [1, 1, 1])]:
    pair("5.25", "matrix and %s exclude each other" % key, lambda s, k=key, v=value: ALONE(s) and s.put(N + "." + k, v),
         lambda s, k=key, v=value: ALONE(s) and s.put(N + "." + k, v).put(N + ".matrix", IDENTITY), N + ".matrix")

# ---- 5.12 to 5.14: cameras -------------------------------------------------------------------------------------------------------------
missing("5.12", "cameras[0].type")
values("5.12", "cameras[0].type", ["perspective"], ["fisheye", "Perspective", 5])
values("5.12", "cameras[0].type", ["perspective"], ["orthographic"], see="cameras[0]")
missing("5.12", "cameras[0].perspective", "cameras[0]")
missing("5.12", "cameras[1].orthographic", "cameras[1]")
for path in ["cameras[0].perspective.yfov", "cameras[0].perspective.znear", "cameras[1].orthographic.xmag", "cameras[1].orthographic.ymag",
             "cameras[1].orthographic.znear", "cameras[1].orthographic.zfar"]:
    missing("5.13", path)
values("5.14", "cameras[0].perspective.yfov", [1e-3, 3.14], [0, -1, 3.2, "1", None])
values("5.14", "cameras[0].perspective.aspectRatio", [0.01, 100], [0, -1, "1"])
values("5.14", "cameras[0].perspective.znear", [1e-6], [0, -0.1, "1"])
values("5.14", "cameras[0].perspective.zfar", [0.2, 1e6], [0, -1, 0.1, 0.05, "far"])
values("5.13", "cameras[1].orthographic.xmag", [1e-3], [0, "1"])
values("5.13", "cameras[1].orthographic.ymag", [1e3], [0, "1"])
values("5.13", "cameras[1].orthographic.znear", [0], [-0.1, "1"])
values("5.13", "cameras[1].orthographic.zfar", [0.2], [0, 0.1, 0.05, "far"])
pair("5.12", "a perspective camera has no orthographic part", lambda s: None,
     put(("cameras[0].orthographic", {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 2})), "cameras[0].orthographic")
pair("5.12", "an orthographic camera has no perspective part", lambda s: None, put(("cameras[1].perspective", {"yfov": 1, "znear": 1})),
     "cameras[1].perspective")
pair("5.12", "a camera that nothing uses is whole", put(("cameras[2]", {"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})),
     put(("cameras[2]", {"type": "fisheye"})), None)
values("5.12", "cameras[0].name", [""], [5], see=None)

# ---- KHR_lights_punctual ---------------------------------------------------------------------------------------------------------------
K = "KHR_lights_punctual"
missing(K, "extensions.KHR_lights_punctual.lights")
missing(K, LIGHTS + "[0].type")
missing(K, LIGHTS + "[2].spot")
missing(K, "nodes[6].extensions.KHR_lights_punctual.light")
values(K, LIGHTS, [[{"type": "point"}] * 3], [{}, 5])
values(K, LIGHTS + "[0].type", ["point"], ["area", "Point", 5, "ambient"])
values(K, LIGHTS + "[0].color", [[0, 0, 1]], [[1, 1], [1, 1, 1, 1], 5, ["r", "g", "b"]])
values(K, LIGHTS + "[0].color[0]", [0, 1], [-0.1, 1.1])
values(K, LIGHTS + "[0].intensity", [0, 1e6], [-1, "1", None])
values(K, LIGHTS + "[1].range", [1e-3], [0, -1, "1"])
values(K, LIGHTS + "[2].spot.innerConeAngle", [0, 0.49], [-0.1, 0.5, 0.6, "0"], see=LIGHTS + "[2].spot")
values(K, LIGHTS + "[2].spot.outerConeAngle", [0.21, 1.5707963267948966], [0, -1, 1.6, 0.1, "1"], see=LIGHTS + "[2].spot")
values(K, LIGHTS + "[2].spot", [{}], [5, []])
values(K, LIGHTS + "[0].name", [""], [5], see=None)
values(K, "nodes[6].extensions.KHR_lights_punctual.light", [0, 2], [3, -1, "0", 0.5])
pair(K, "a light that nothing uses is whole", put((LIGHTS + "[3]", {"type": "point"})), put((LIGHTS + "[3]", {"type": "spot"})), None)

# ---- 5.5 to 5.8 and 3.11: animations; the first one is drawn ---------------------------------------------------------------------------
BYTE, UNSIGNED_BYTE, SHORT = 5120, 5121, 5122
POINTER = {"extensions": {"KHR_animation_pointer": {"pointer": "/nodes/1/translation"}}}


def animated(target=None, channel=None, sampler=None, times=(0, 1), moves=(0, 0, 0, 1, 1, 1), of_times=None, of_moves=None, kind="VEC3",
             component=FLOAT, put=None, also=(), **members):
    def apply(s):
        limits = {"min": [min(times)], "max": [max(times)]}
        input_ = s.accessor("SCALAR", FLOAT, list(times), **{**limits, **(of_times or {})})
        output = s.accessor(kind, component, list(moves), **(of_moves or {}))
        sound = {"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation", **(target or {})}, **(channel or {})}],
                 "samplers": [{"input": input_, "output": output, **(sampler or {})}]}
        s.put("animations", [{**sound, **members}, *also])
        if put:
            s.put(*put)
    return apply


A = "animations[0]"
C, S = A + ".channels[0]", A + ".samplers[0]"
for bad, see in [(dict(target={"node": 99}), C + ".target.node"), (dict(target={"node": -1}), C + ".target.node"),
                 (dict(target={"path": "colour"}), C + ".target.path"), (dict(target={"path": 5}), C + ".target.path"),
                 (dict(channel={"sampler": 9}), A), (dict(channel={"sampler": "0"}), C + ".sampler"),
                 (dict(channel={"target": 5}), C + ".target"), (dict(sampler={"input": 99}), S + ".input"),
                 (dict(sampler={"output": -1}), S + ".output"), (dict(sampler={"interpolation": "WAVY"}), S + ".interpolation"),
                 (dict(sampler={"interpolation": 5}), S + ".interpolation"), (dict(channels=[]), A), (dict(samplers={}), A + ".samplers"),
                 (dict(channels=None), A + ".channels"), (dict(samplers=[]), A)]:
    pair("5.5", "animations[0] with %s" % bad, animated(), animated(**bad), see)
pair("5.5", "animations[0].name is 5", animated(name=""), animated(name=5), None)
for other in [5, {}, {"channels": 5, "samplers": []},
              {"channels": [{"sampler": 0, "target": {"node": 99, "path": "scale"}}], "samplers": []}]:
    pair("5.5", "an animation that is not drawn is %s" % str(other)[:40], animated(), animated(also=[other]), None)
for times in [(1, 0), (0, 0), (-1, 1), (0, float("inf"))]:
    limits = {"max": [1], "min": [0]} if times[1] > 1e38 else None
    pair("3.11", "times are %s, %s" % times, animated(), animated(times=times, of_times=limits), S + ".input")
pair("3.11", "times have a max", animated(), animated(of_times={"max": [2]}), "accessors[14].max")
pair("3.11", "times are floats of one component", animated(), animated(sampler={"input": 0}), S + ".input")
pair("3.11", "there is a value for each time", animated(), animated(moves=(0, 0, 0)), S + ".output")
pair("3.11", "translations have three components", animated(), animated(moves=(0, 0, 0, 1), kind="VEC2"), S + ".output")
pair("3.11", "translations are floats", animated(), animated(component=SHORT, of_moves={"normalized": True}), S + ".output")
pair("3.11", "rotations of integers are normalized",
     animated(target={"path": "rotation"}, moves=(0, 0, 0, 127, 0, 0, 127, 0), kind="VEC4", component=BYTE, of_moves={"normalized": True}),
     animated(target={"path": "rotation"}, moves=(0, 0, 0, 127, 0, 0, 127, 0), kind="VEC4", component=BYTE), S + ".output")
pair("3.11", "rotations have length 1", animated(target={"path": "rotation"}, moves=(0, 0, 0, 1, 0.6, 0, 0, 0.8), kind="VEC4"),
     animated(target={"path": "rotation"}, moves=(0, 0, 0, 1, 0.6, 0, 0, 0.6), kind="VEC4"), S + ".output")
CUBIC = {"interpolation": "CUBICSPLINE"}
pair("3.11", "a cubic key has three values", animated(sampler=CUBIC, moves=(0, 0, 0) * 6), animated(sampler=CUBIC), S + ".output")
pair("3.11", "a cubic spline has two keys", animated(sampler=CUBIC, moves=(0, 0, 0) * 6),
     animated(sampler=CUBIC, times=(0,), moves=(0, 0, 0) * 3), S)
TWICE = [{"sampler": 0, "target": {"node": 1, "path": "translation"}}] * 2
pair("5.5", "channels have different targets", animated(), animated(channels=TWICE), A + ".channels[1].target")
pair("5.7", "a node of weights has morph targets", animated(target={}), animated(target={"path": "weights"}, moves=(0, 1), kind="SCALAR"),
     C + ".target.path", ["weights"])
pair("3.11", "an animated node has no matrix", animated(),
     lambda s: (ALONE(s), animated(put=(N + ".matrix", IDENTITY))(s)) and None, C + ".target.path")

# ---- KHR_animation_pointer and KHR_node_visibility -------------------------------------------------------------------------------------
P = "KHR_animation_pointer"
V = "nodes[1].extensions.KHR_node_visibility"


def pointed(pointer, **more):
    return lambda s: (s.put("extensionsUsed[3]", P), animated(
        target={"path": "pointer", "extensions": {P: {"pointer": pointer}}}, **more)(s)) and None


for pointer in ["/nodes/99/translation", "/nodes/1", "nodes/1/translation", "/nodes/-1/translation", "/meshes/0/name", "", 5]:
    pair(P, "a pointer is %s" % pointer, pointed("/nodes/1/translation"), pointed(pointer),
         C + ".target.extensions.KHR_animation_pointer.pointer")
pair(P, "true and false change in steps", pointed("/nodes/1/extensions/KHR_node_visibility/visible", moves=(1, 0), kind="SCALAR",
                                                  component=UNSIGNED_BYTE, sampler={"interpolation": "STEP"}),
     pointed("/nodes/1/extensions/KHR_node_visibility/visible", moves=(1, 0), kind="SCALAR", component=UNSIGNED_BYTE), S + ".interpolation")
values("KHR_node_visibility", V + ".visible", [True, False], ["yes", 1, None],
       with_also=lambda s: s.put("extensionsUsed[3]", "KHR_node_visibility"))
