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

# ---- 5.5 to 5.8: animations, which are left out ----------------------------------------------------------------------------------------
def animated(target=None, channel=None, sampler=None, **members):
    def apply(s):
        times, moves = s.accessor("SCALAR", FLOAT, [0, 1], min=[0], max=[1]), s.accessor("VEC3", FLOAT, [0, 0, 0, 1, 1, 1])
        s.put("animations", [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation", **(target or {})},
        **(channel or {})}],
                              "samplers": [{"input": times, "output": moves, **(sampler or {})}], **members}])
    return apply


for bad in [dict(target={"node": 99}), dict(target={"path": "colour"}), dict(target={"path": 5}), dict(channel={"sampler": 9}),
                 dict(channel={"target": 5}),
            dict(sampler={"input": 99}), dict(sampler={"output": -1}), dict(sampler={"interpolation": "WAVY"}), dict(channels=[]),
            dict(samplers={}),
            dict(name=5), dict(channels=None)]:
    pair("5.5", "animations[0] with %s" % bad, animated(), animated(**bad), None, ["animations"])
pair("5.5", "animations that are left out are said", lambda s: None, animated(), "animations")
