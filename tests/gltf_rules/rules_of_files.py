"""Rules of JSON, of the asset, of GLB containers, URIs and extensions."""
import base64
import struct

from scene import BIN_CHUNK, JSON_CHUNK, LIGHTS, PBR, chunk
from table import missing, pair, put, values


def edited(before, after):
    """A change of the JSON text itself."""
    def apply(s):
        text = s.text()
        assert before in text, before
        return s.glb(text.replace(before, after, 1))
    return apply


# ---- 2.7 and 3.2: JSON and asset -------------------------------------------------------------------------------------------------------
pair("2.7", "JSON is UTF-8", put(("meshes[0].name", "\u00e4\u20ac\U0001F600")), edited(b'"textured"', b'"\xff"'), "UTF-8")
pair("2.7", "JSON is UTF-8 without surrogates", put(("meshes[0].name", "\U0010FFFF")), edited(b'"textured"', b'"\xed\xa0\x80"'), "UTF-8")
pair("2.7", "JSON is UTF-8 without overlong forms", put(("meshes[0].name", "\x7f")), edited(b'"textured"', b'"\xc0\xaf"'), "UTF-8")
pair("2.7", "JSON has no byte order mark", lambda s: s.gltf(), lambda s: b"\xef\xbb\xbf" + s.gltf(), "byte order mark")
pair("2.7", "keys are there once", edited(b'"metallicFactor": 0.5', b'"metallicFactor": 0.5, "extras": {"a": {"b": 1}, "b": 1}'),
     edited(b'"metallicFactor": 0.5', b'"metallicFactor": 0.5, "metallicFactor": 1'), PBR + ".metallicFactor")
pair("2.7", "keys that are escaped count as the same", edited(b'"metallicFactor"', b'"metallic\\u0046actor"'),
     edited(b'"metallicFactor": 0.5', b'"metallicFactor": 0.5, "metallic\\u0046actor": 1'), PBR + ".metallicFactor")
for name, good, bad in [("NaN", b"0.5e-0", b"NaN"), ("infinity", b"5E-1", b"Infinity"), ("a leading zero", b"0.50", b"00.5"),
                        ("a leading point", b"0.5", b".5"), ("a plus sign", b"0.0", b"+0.5"), ("beyond double", b"1e-400", b"1e400"),
                        ("a comment", b" \t\r\n0.5", b"/* */ 0.5"), ("hexadecimal", b"1", b"0x1")]:
    pair("2.7", "a number is not " + name, edited(b'"roughnessFactor": 0.5', b'"roughnessFactor": ' + good),
         edited(b'"roughnessFactor": 0.5', b'"roughnessFactor": ' + bad), PBR + ".roughnessFactor")
pair("2.7", "no comma ends a list", edited(b'"wrapT": 33071}', b'"wrapT": 33071 }'), edited(b'"wrapT": 33071}', b'"wrapT": 33071,}'),
     "samplers[0]")
pair("2.7", "the text ends with the object", lambda s: s.gltf() + b"\n ", lambda s: s.gltf() + b"{}", "end of the JSON text")
missing("5.17", "asset", "asset")
missing("5.9", "asset.version", "asset")
values("5.9", "asset.version", ["2.0"], ["2", "two", "2.", 2.0, "3.0", "1.0"])
values("5.9", "asset.minVersion", ["2.0"], ["2.1", "x"], with_also=put(("asset.version", "2.1")))
pair("5.9", "minVersion is not above version", put(("asset.minVersion", "2.0")), put(("asset.minVersion", "2.1")), "asset.minVersion")
values("5.9", "asset.generator", [""], [5, None], see=None)
values("5.9", "asset.copyright", ["\u00a9"], [5], see=None)

# ---- 4.4: GLB --------------------------------------------------------------------------------------------------------------------------
pair("4.4.2", "the version is 2", lambda s: s.glb(), lambda s: s.glb(version=1), "GLB")
pair("4.4.2", "the length is the file's", lambda s: s.glb(), lambda s: s.glb(length=len(s.glb()) + 4), "GLB")
pair("4.4.2", "the length has no bytes after it", lambda s: s.glb(), lambda s: s.glb() + b"more", "GLB")
pair("4.4.2", "the length ends at a chunk", lambda s: s.glb(), lambda s: s.glb(length=len(s.glb()) - 4), "GLB")
pair("4.4.2", "the magic is glTF", lambda s: s.glb(), lambda s: b"GLTF" + s.glb()[4:], "")
pair("4.4.3", "chunks are aligned to 4", lambda s: s.glb(s.text() + b" " * (-len(s.text()) % 4)),
     lambda s: b"glTF" + struct.pack("<IIII", 2, 20 + len(s.text()) + 1 + -len(s.text()) % 4, len(s.text()) + 1 + -len(s.text()) % 4,
                                     JSON_CHUNK) + s.text() + b" " * (1 + -len(s.text()) % 4), "GLB")
pair("4.4.3", "the first chunk is JSON", lambda s: s.glb(),
     lambda s: b"glTF" + struct.pack("<II", 2, 12 + 8 + len(s.bin)) + chunk(BIN_CHUNK, bytes(s.bin), b"\0"), "GLB")
pair("4.4.3", "BIN is the second chunk", lambda s: s.glb(extra=chunk(0x41414141, b"else", b"\0")), lambda s: between(s), "GLB",
     ["unknown type"])
pair("4.4.3", "there is one JSON chunk", lambda s: s.glb(), lambda s: s.glb(extra=chunk(JSON_CHUNK, b"{}", b" ")), "GLB")
pair("4.4.3", "there is one BIN chunk", lambda s: s.glb(), lambda s: s.glb(extra=chunk(BIN_CHUNK, b"abcd", b"\0")), "GLB")
pair("4.4.3.2", "JSON is padded with spaces", lambda s: s.glb(s.text() + b"   "),
     lambda s: s.glb(s.text() + b"\0" * (-len(s.text()) % 4)), None)
pair("4.4.3.3", "BIN is at most 3 bytes longer than its buffer", lambda s: grown(s, 3), lambda s: grown(s, 8), None)


def between(s):
    """GLB with a chunk of another type before BIN."""
    body = chunk(JSON_CHUNK, s.text(), b" ") + chunk(0x41414141, b"else", b"\0") + chunk(BIN_CHUNK, bytes(s.bin), b"\0")
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def grown(s, more):
    """GLB whose BIN chunk is 3 or 8 bytes longer than the buffer."""
    s.bin += bytes(-len(s.bin) % 4)
    s.put("buffers[0].byteLength", len(s.bin) + (1 if more == 3 else 0))
    s.bin += bytes(4 if more == 3 else 8)
    return s.glb()


# ---- 2.8: URIs -------------------------------------------------------------------------------------------------------------------------
def beside(uri, name="part.bin"):
    return lambda s: {"": s.gltf(uri), name: bytes(s.bin)}


for uri, name in [("part.bin", "part.bin"), ("a%20b.bin", "a b.bin"), ("a b.bin", "a b.bin"), ("./part.bin", "part.bin"),
                  ("sub/part.bin", "sub/part.bin"), ("sub/../part.bin", "part.bin"), ("%C3%A4.bin", "\u00e4.bin")]:
    for wrong in {"part.bin": ["absent.bin", "/etc/passwd"], "a%20b.bin": ["%zz", "part.bin%"], "a b.bin": ["http://x/part.bin"],
                  "./part.bin": ["file:///etc/passwd"], "sub/part.bin": ["..\\part.bin", "%00"],
                  "sub/../part.bin": ["../../../../../../../../etc/passwd", "..%2f..%2f..%2f..%2fetc%2fpasswd"], "%C3%A4.bin": [""]}[uri]:
        pair("2.8", "buffers[0].uri is %s" % wrong, beside(uri, name), beside(wrong), "buffers[0].uri")
DATA = "data:application/gltf-buffer;base64,"
for wrong in ["data:application/octet-stream;base64,AAA*", "data:application/octet-stream;base64,A", "data:;base64", "data:;base64,AAAA"]:
    pair("2.8", "buffers[0].uri is %s" % wrong, lambda s: s.gltf(DATA + base64.b64encode(s.bin).decode()), lambda s, w=wrong: s.gltf(w),
         "buffers[0]")

# ---- 3.12: extensions ------------------------------------------------------------------------------------------------------------------
pair("3.12", "what is required is used", put(("extensionsRequired", ["KHR_lights_punctual"])),
     put(("extensionsUsed", ["KHR_materials_emissive_strength", "KHR_texture_transform"]),
     ("extensionsRequired", ["KHR_lights_punctual"])),
     "extensionsRequired[0]")
pair("3.12", "what is required is known", put(("extensionsRequired", ["KHR_texture_transform"])),
     put(("extensionsUsed[3]", "VENDOR_x"), ("extensionsRequired", ["VENDOR_x"])), "extensionsRequired")
FIRST_USE = {"KHR_materials_unlit": "materials[0].extensions.KHR_materials_unlit",
"KHR_texture_transform": PBR + ".baseColorTexture.extensions.KHR_texture_transform",
             "KHR_materials_emissive_strength": "materials[0].extensions.KHR_materials_emissive_strength",
             "KHR_lights_punctual": "extensions.KHR_lights_punctual"}
for name, path, content in [
        ("KHR_materials_unlit", "materials[0].extensions.KHR_materials_unlit", {}),
        ("KHR_lights_punctual", "nodes[3].extensions.KHR_lights_punctual", {"light": 1}),
        ("KHR_texture_transform", "materials[0].emissiveTexture.extensions.KHR_texture_transform", {"scale": [2, 2]}),
        ("KHR_materials_emissive_strength", "materials[1].extensions.KHR_materials_emissive_strength", {"emissiveStrength": 1})]:
    def unlisted(s, name=name, path=path, content=content):
        s.put(path, content).put("extensionsUsed", [n for n in s.json["extensionsUsed"] if n != name])
    pair("3.12", name + " is listed where it is used",
         lambda s, name=name, path=path, content=content: s.put(path, content).put(
             "extensionsUsed", sorted(set(s.json["extensionsUsed"]) | {name})), unlisted, FIRST_USE[name])
values("5.17", "extensionsUsed", [["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform"]],
       ["KHR_lights_punctual", {"0": "KHR_lights_punctual"}])
values("5.17", "extensionsUsed[3]", ["KHR_materials_unlit"], [5, None])
pair("5.17", "extensionsUsed names each once", put(("extensionsUsed[3]", "KHR_materials_unlit")),
     put(("extensionsUsed[3]", "KHR_lights_punctual")), None)
