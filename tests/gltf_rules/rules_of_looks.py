"""Rules of materials, textures, samplers and images, and extensions of materials."""
import base64
import struct

from scene import LIGHTS, PBR, png
from table import missing, pair, put, values

M = "materials[0]"

# ---- 5.19 and 5.22: materials ----------------------------------------------------------------------------------------------------------
for path, n in [(PBR + ".baseColorFactor", 4), (M + ".emissiveFactor", 3)]:
    values("5.22", path, [[0] * n, [1] * n], [[1] * (n - 1), [1] * (n + 1), 1, {}, ["1"] * n], see=path)
    for i in range(n):
        values("5.22", "%s[%d]" % (path, i), [0, 1], [-0.01, 1.01])
for path in [PBR + ".metallicFactor", PBR + ".roughnessFactor", M + ".occlusionTexture.strength"]:
    values("5.22", path, [0, 1, 0.0], [-0.01, 1.01, "1", None, 1e38])
values("5.19", M + ".alphaCutoff", [0, 1, 2], [-0.1, "0", None])
values("5.19", M + ".alphaMode", ["OPAQUE", "MASK", "BLEND"], ["mask", "ADD", "", 5], with_also=lambda s: s.drop(M + ".alphaCutoff"))
values("5.19", M + ".doubleSided", [True, False], ["true", 1, 0, None])
values("5.19", M + ".name", [""], [5], see=None)
values("5.19", PBR, [{}], [5, [], "metal"])
values("5.20", M + ".normalTexture.scale", [-1, 0, 10], ["1", None])
pair("5.19", "alphaCutoff comes with alphaMode", lambda s: None, lambda s: s.drop(M + ".alphaMode"), None)
pair("5.19", "a material that nothing uses is whole", put(("materials[2]", {"emissiveFactor": [1, 1, 1]})),
     put(("materials[2]", {"emissiveFactor": [1, 1]})), None)
pair("5.19", "a material that nothing uses has textures", put(("materials[2]", {"normalTexture": {"index": 0}})),
     put(("materials[2]", {"normalTexture": {"index": 9}})), None)

# ---- 5.30: places of textures ----------------------------------------------------------------------------------------------------------
for path in [PBR + ".baseColorTexture", PBR + ".metallicRoughnessTexture", M + ".normalTexture", M + ".occlusionTexture",
M + ".emissiveTexture"]:
    values("5.30", path, [{"index": 0}], [{}, 5, []])
    values("5.30", path + ".index", [0, 0.0], [99, -1, "0"])
    values("5.30", path + ".texCoord", [0, 1], [-1, "0", 0.5, 2])
pair("3.9.2", "a textured mesh has texture coordinates", lambda s: s.put("meshes[1].primitives[0].attributes.TEXCOORD_0",
     s.accessor("VEC2", 5126, [0] * 6)) and
     s.put("materials[1].emissiveTexture", {"index": 0}), put(("materials[1].emissiveTexture", {"index": 0})),
     "materials[1].emissiveTexture")
pair("3.9.2", "a textured mesh has the second texture coordinates", lambda s: None,
     lambda s: s.drop("meshes[0].primitives[0].attributes.TEXCOORD_1"),
     PBR + ".metallicRoughnessTexture")
pair("3.9.3", "a mesh with a normal texture has texture coordinates",
     lambda s: s.put("meshes[1].primitives[0].attributes.TEXCOORD_0", s.accessor("VEC2", 5126, [0, 0, 1, 0, 0, 1])) and
     s.put("materials[1].normalTexture", {"index": 0}), put(("materials[1].normalTexture", {"index": 0})), "materials[1].normalTexture")

# ---- 5.29, 5.26, 5.18: textures, samplers, images --------------------------------------------------------------------------------------
values("5.29", "textures[0].source", [0], [9, -1, "0"])
values("5.29", "textures[0].sampler", [0], [9, -1, "0"])
pair("5.29", "a texture without a source is left out", lambda s: None, lambda s: s.drop("textures[0].source"), "textures[0]")
values("5.29", "textures[0].name", [""], [5], see=None)
values("5.26", "samplers[0].magFilter", [9728, 9729], [9987, 0, -1, "9729", 9729.5])
values("5.26", "samplers[0].minFilter", [9728, 9729, 9984, 9985, 9986, 9987], [9730, 0, -1, "9987"])
values("5.26", "samplers[0].wrapS", [33071, 33648, 10497], [10496, 0, -1, "10497"])
values("5.26", "samplers[0].wrapT", [33648, 33071.0], [33072, 0, "10497"])
values("5.26", "samplers[0].name", [""], [5], see=None)
values("5.18", "images[0].bufferView", [16], [99, -1, "16"])
values("5.18", "images[0].mimeType", ["image/png"], ["image/gif", "png", 5, "image/jpeg"])
values("5.18", "images[0].name", [""], [5], see=None)
pair("5.18", "an image has a uri or a bufferView", lambda s: None, lambda s: s.drop("images[0].bufferView"), "images[0]")
pair("5.18", "an image has not both", lambda s: None, put(("images[0].uri", "data:image/png;base64,AAAA")), "images[0]")
pair("5.18", "an image in a bufferView has a mimeType", lambda s: None, lambda s: s.drop("images[0].mimeType"), None)
pair("5.29", "an image that nothing uses is whole", put(("images[1]", {"uri": "data:image/png;base64,"})),
     put(("images[1]", {"bufferView": 99})), None)
pair("5.29", "an image that nothing uses is there", put(("images[1]", {"uri": "data:image/png;base64,"})),
     put(("images[1]", {"uri": "absent.png"})), None)
pair("5.29", "a texture that nothing uses has a source", put(("textures[1]", {"source": 0})), put(("textures[1]", {"source": 9})), None)
pair("5.26", "a sampler that nothing uses is whole", put(("samplers[1]", {"wrapS": 33071})), put(("samplers[1]", {"wrapS": "no"})), None)


def picture(data, name=None):
    """Image 0 at a data URI, or at a file."""
    def apply(s):
        s.put("images", [{"uri": "data:image/png;base64," + base64.b64encode(data).decode() if name is None else name}])
        return {"": s.glb(), **({name: data} if name else {})}
    return apply


for name, bad in [("is cut short", png()[:60]), ("is empty", b""), ("is of another kind", b"GIF89a" + bytes(20)),
                   ("has no pixels", png(0, 1)),
                  ("has a wrong checksum", png().replace(struct.pack(">II", 2, 2), struct.pack(">II", 2, 3)))]:
    pair("3.8.3", "a picture %s" % name, picture(png()), picture(bad), "images[0]")
for uri in ["absent.png", "../../../etc/passwd", "/etc/passwd", "http://x/y.png", "", "%zz.png"]:
    pair("2.8", "images[0].uri is %s" % uri, picture(png(), "part.png"), put(("images", [{"uri": uri}])), "images[0].uri")

# ---- extensions of materials -----------------------------------------------------------------------------------------------------------
E = M + ".extensions.KHR_materials_emissive_strength"
values("KHR_materials_emissive_strength", E + ".emissiveStrength", [0, 1, 1e6], [-1, "1", None])
values("KHR_materials_emissive_strength", E, [{}], [5, []])
values("KHR_materials_ior", M + ".extensions.KHR_materials_ior.ior", [0, 1, 1.5, 2.4], [-1, "1", None],
       with_also=lambda s: s.json["extensionsUsed"].append("KHR_materials_ior"))
values("KHR_materials_unlit", M + ".extensions.KHR_materials_unlit", [{}], [5, "yes"],
       with_also=lambda s: s.json["extensionsUsed"].append("KHR_materials_unlit"))
for name, key, good, bad in [("transmission", "transmissionFactor", [0, 0.5, 1], [-1, 2, "1", None]),
                             ("volume", "thicknessFactor", [0, 1e3], [-1, "1"]),
                             ("volume", "attenuationDistance", [1e-3, 1e6], [0, -1, "1"]),
                             ("specular", "specularFactor", [0, 1], [-1, 2, "1"]),
                             ("specular", "specularColorFactor", [[0, 1, 7]], [[0, 1], [-1, 1, 1], 5]),
                             ("clearcoat", "clearcoatFactor", [0, 0.5, 1], [-1, 2, "1", None]),
                             ("clearcoat", "clearcoatRoughnessFactor", [0, 1], [-1, 2, "1"]),
                             ("clearcoat", "clearcoatTexture", [{"index": 0}], [{"index": 99}, {}, 5]),
                             ("clearcoat", "clearcoatNormalTexture", [{"index": 0, "scale": -3}], [{"index": 0, "scale": "1"}, 5]),
                             ("sheen", "sheenColorFactor", [[0, 0.5, 1]], [[0, 1], [0, 1, 2], [-1, 0, 0], 5]),
                             ("sheen", "sheenRoughnessFactor", [0, 1], [-1, 2, "1"]),
                             ("sheen", "sheenColorTexture", [{"index": 0}], [{"index": 99}, {}, 5]),
                             ("pbrSpecularGlossiness", "diffuseFactor", [[0, 0.5, 1, 1]], [[0, 1, 1], [0, 1, 2, 1], 5]),
                             ("pbrSpecularGlossiness", "specularFactor", [[0, 0.5, 1]], [[0, 1], [0, 1, 2], 5]),
                             ("pbrSpecularGlossiness", "glossinessFactor", [0, 1], [-1, 2, "1"]),
                             ("volume", "attenuationColor", [[0, 0.5, 1]], [[0, 1], [0, 1, 2], 5, ["1", 1, 1]])]:
    values("KHR_materials_" + name, M + ".extensions.KHR_materials_" + name + "." + key, good, bad,
           with_also=lambda s, n="KHR_materials_" + name: s.json["extensionsUsed"].append(n), allowed=["blur of its roughness"])
T = PBR + ".baseColorTexture.extensions.KHR_texture_transform"
for key in ("offset", "scale"):
    values("KHR_texture_transform", T + "." + key, [[0, 0], [-1, 2]], [[1], [1, 1, 1], 5, ["1", "1"], {}], see=T + "." + key)
values("KHR_texture_transform", T + ".rotation", [-7, 0], ["1", None, []])
values("KHR_texture_transform", T + ".texCoord", [0, 1], [-1, "0", 0.5, 2], see=PBR + ".baseColorTexture")
values("KHR_texture_transform", T, [{}], [5, []])

# ---- extensions that are not drawn are said, once --------------------------------------------------------------------------------------
for name in ("KHR_materials_unheard_of", "EXT_texture_avif", "MSFT_texture_dds", "KHR_xmp_json_ld", "EXT_lights_image_based", "MSFT_lod",
             "VENDOR_unheard_of"):
    pair("3.12", name + " is said to be left out", lambda s: None, put(("extensionsUsed[3]", name)), name)
