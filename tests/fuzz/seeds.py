#!/usr/bin/env python3
"""Writes seeds, small sound inputs of each fuzz target:  seeds.py FOLDER  makes FOLDER/TARGET/NAME."""
import base64
import io
import json
import pathlib
import random
import struct
import sys
import zipfile
import zlib

FLAG_BYTES = 128  # of scene.cpp


# ---- pictures ------------------------------------------------------------------------------------------------------------

def png(width, height, bits, color, interlaced=False, extra=(), level=0):
    """Samples count upwards. Blocks are stored by default, so that mutations reach the filters behind them."""
    def chunk(kind, body):
        return struct.pack('>I', len(body)) + kind + body + struct.pack('>I', zlib.crc32(kind + body))
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    passes = [(0, 0, 1, 1)]
    if interlaced:
        passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    raw, sample = bytearray(), 0
    for x0, y0, dx, dy in passes:
        columns = len(range(x0, width, dx))
        for row in range(len(range(y0, height, dy)) if columns else 0):
            raw.append(row % 5)  # all filters
            for _ in range((columns * channels * bits + 7) // 8):
                raw.append(sample * 37 % 256 if color != 3 else 0)
                sample += 1
    file = b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, bits, color, 0, 0, interlaced))
    for kind, body in extra:
        file += chunk(kind, body)
    return file + chunk(b'IDAT', zlib.compress(bytes(raw), level)) + chunk(b'IEND', b'')


class Bits:
    """Huffman-coded data of a JPEG: ones fill the last byte, and a zero follows each 255."""
    def __init__(self):
        self.text = ''

    def put(self, value, count):
        self.text += format(value, f'0{count}b') if count else ''

    def bytes(self):
        text = self.text + '1' * (-len(self.text) % 8)
        return bytes(int(text[i:i + 8], 2) for i in range(0, len(text), 8)).replace(b'\xff', b'\xff\x00')


def jpeg(width, height, components=1, progressive=False, restart=0, adobe=None):
    """Blocks of one value, and one wave in the first of them. Both Huffman tables have the codes 00, 01, 10 and 110."""
    def segment(kind, body):
        return b'\xff' + bytes([kind]) + struct.pack('>H', len(body) + 2) + body
    sampling = 0x22 if components == 3 else 0x11
    file = b'\xff\xd8' + segment(0xDB, bytes([0] + [8] * 64))
    if adobe is not None:
        file += segment(0xEE, b'Adobe\0\x64\0\0\0\0' + bytes([adobe]))
    frame = struct.pack('>BHHB', 8, height, width, components)
    for i in range(components):
        frame += bytes([i + 1, sampling if i == 0 else 0x11, 0])
    file += segment(0xC2 if progressive else 0xC0, frame)
    lengths = bytes([0, 3, 1] + [0] * 13)
    file += segment(0xC4, b'\x00' + lengths + bytes([0, 3, 5, 1]))     # differences of 0, 3, 5 and 1 bits
    file += segment(0xC4, b'\x10' + lengths + bytes([0, 1, 0x12, 0xF0]))  # end of block, a value, a zero and a value, sixteen zeros
    if restart:
        file += segment(0xDD, struct.pack('>H', restart))
    mcu = 16 if components == 3 else 8
    count = -(-width // mcu) * -(-height // mcu)
    blocks = 6 if components == 3 else components

    def scan(ids, first, last, writer, units):
        out = segment(0xDA, bytes([len(ids)]) + b''.join(bytes([i, 0]) for i in ids) + bytes([first, last, 0]))
        for i in range(0, units, restart or units):
            data = Bits()
            for k in range(i, min(i + (restart or units), units)):
                writer(data, k)
            out += data.bytes()
            if i + (restart or units) < units:
                out += bytes([0xFF, 0xD0 + i // restart % 8])
        return out

    def dc(data, k):
        data.put(1, 2)
        data.put(k % 4 + 4, 3)  # a difference of 3 bits

    def ac(data, k):
        if k == 0:
            data.put(1, 2)
            data.put(1, 1)
        data.put(0, 2)  # end of block

    def mcu_of(*parts):
        def write(data, k):
            for b in range(blocks):
                for part in parts:
                    part(data, k + b)
        return write
    ids = list(range(1, components + 1))
    if not progressive:
        file += scan(ids, 0, 63, mcu_of(dc, ac), count)
    else:
        file += scan(ids, 0, 0, mcu_of(dc), count)
        for i in ids:
            side = 8 if i == 1 or components != 3 else 16
            file += scan([i], 1, 5, ac, -(-width // side) * -(-height // side))
    return file + b'\xff\xd9'


def lzw(data):
    """Codes of nine bits: each byte by itself, and a clear code before ten bits are needed."""
    text = ''.join((format(256, '09b') if i % 200 == 0 else '') + format(byte, '09b') for i, byte in enumerate(data)) + format(257, '09b')
    text += '0' * (-len(text) % 8)
    return bytes(int(text[i:i + 8], 2) for i in range(0, len(text), 8))


def tiff(width, height, parts, samples=3, bits=8, photometric=2, compression=1, predictor=1, tile=0, palette=()):
    """One directory; the samples count upwards in strips of the whole width, or in tiles."""
    tags = [(256, 3, [width]), (257, 3, [height]), (258, 3, [bits] * samples), (259, 3, [compression]), (262, 3, [photometric]),
            (277, 3, [samples]), (317, 3, [predictor])]
    tags += [(320, 3, list(palette))] if palette else []
    tags += [(322, 3, [tile]), (323, 3, [tile])] if tile else [(278, 3, [-(-height // len(parts))])]
    at = 8 + 2 + 12 * (len(tags) + 2) + 4
    body = b''
    places = []
    for part in parts:
        places.append(at + len(body))
        body += part
    tags += [(324 if tile else 273, 4, places), (325 if tile else 279, 4, [len(part) for part in parts])]
    entries = b''
    for tag, kind, values in sorted(tags):
        packed = struct.pack(f'<{len(values)}{"H" if kind == 3 else "I"}', *values)
        if len(packed) > 4:
            body, packed = body + packed, struct.pack('<I', at + len(body))
        entries += struct.pack('<HHI', tag, kind, len(values)) + packed.ljust(4, b'\0')
    return b'II*\0' + struct.pack('<IH', 8, len(tags)) + entries + bytes(4) + body


# Streams of the encoders of libwebp, Draco and meshoptimizer: a picture of 4 x 3 pixels, and the two triangles of a square.
WEBP = bytes.fromhex(
    '524946463a000000574542505650384c2e0000002f038000105f20164cae19e48f1bc3505c814241da062c96d0ee24e81f080248146289659659669934a2ff81e90e')
WEBP_LOSSY = bytes.fromhex(
    '524946465600000057454250565038580a00000010000000030000020000414c50480d000000000f23374b5f73879bafc3d7eb005650382022000000b001009d012a'
    '0400030002c04c259c0274010efe02ec00e27dfedc17991496e00000')
DRACO = bytes.fromhex(
    '445241434f02020101000000040200020000011fff011101ff00000100090300000201010100030301300110030024824a0400000000ff0000000000000000000000'
    '000000000000803f08')
DRACO_SEQUENTIAL = bytes.fromhex(
    '445241434f02020100000002040100010202010301010009030000020001010003030130011003002882881100000000ff0000000000000000000000000000000000'
    '803f08')
MESHOPT_VERTICES = bytes.fromhex(
    'a00000013f000000ffffff013f0000007e7d7e0000010c000000ff010c0000007e000000000000000000000000000000000000000000000000000000000000000000'
    '000000')
MESHOPT_TRIANGLES = bytes.fromhex('e0f010007687566778a9866589689801690000')
MESHOPT_INDICES = bytes.fromhex('d000040400020800000000')
# Output of Basis Universal's encoder: a book of 20 colours, one of 18 patterns, and the slices of colour and alpha of 20 x 12 pixels.
ETC1S_BOOKS = bytes.fromhex(
    '140012004e00000049000000380000000000000000000000000000000d0000000d0000000c00000020c01c00010088000078e5bf64b318f900de000c003004db317e'
    '04a18d0e204ec000000020e8d5080c0e802900000000802088865998d76f63861537b9f86f32683df9efb3a1aa004052670100005455050040454545055055558554'
    '5353d3d2d2d2d2d0d0d0d8d8d8d8b8b8b8b8a8aeaeaef6acafafb7b4ecef2f2dfdffafaf7f7dfd2f2d2d2d4f4f4f4fcfcfcf5753a3a646b7b2b20200419c80010000'
    '405054a35b424e87023005000000001004c568d803bc951c0020201a2788f5118572fc01ca090026000000000000104000')
ETC1S_SLICES = bytes.fromhex('ae12a57915520f5732884bed0cc9b161bca2bbff9ad0e0e000')


def pictures():
    def palette(bits):
        return [(b'PLTE', bytes(range(3 * min(4, 1 << bits)))), (b'tRNS', bytes([0, 128]))]
    out = {f'png_{color}_{bits}': png(5, 4, bits, color) for color, bits in
           [(0, 1), (0, 2), (0, 4), (0, 8), (0, 16), (2, 8), (2, 16), (4, 8), (4, 16), (6, 8), (6, 16)]}
    out.update({f'png_3_{bits}': png(5, 4, bits, 3, extra=palette(bits)) for bits in (1, 2, 4, 8)})
    out['png_interlaced'] = png(9, 9, 8, 6, interlaced=True)
    out['png_interlaced_16'] = png(5, 6, 16, 2, interlaced=True)
    out['png_interlaced_1'] = png(11, 3, 1, 0, interlaced=True)
    out['png_compressed'] = png(17, 13, 8, 2, level=9)
    out['png_trns_grey'] = png(3, 3, 8, 0, extra=[(b'tRNS', b'\0\x25')])
    out['png_trns_rgb'] = png(3, 3, 16, 2, extra=[(b'tRNS', b'\0\x25\0\0\0\0')])
    out['png_chunks'] = png(2, 2, 8, 2, extra=[
        (b'gAMA', struct.pack('>I', 45455)), (b'cHRM', struct.pack('>8I', *range(8))), (b'sRGB', b'\0'), (b'sBIT', b'\5\6\5'),
        (b'pHYs', struct.pack('>IIB', 1, 1, 1)), (b'bKGD', b'\0\1\0\2\0\3'), (b'tIME', b'\x07\xe9\1\1\1\1\1'), (b'tEXt', b'a\0b'),
        (b'zTXt', b'a\0\0' + zlib.compress(b'text')), (b'iTXt', b'a\0\0\0en\0b\0text'), (b'iCCP', b'p\0\0' + zlib.compress(bytes(40))),
        (b'sPLT', b'p\0\x08' + bytes(12)), (b'eXIf', b'II*\0' + bytes(8))])
    out['jpeg_grey'] = jpeg(11, 9)
    out['jpeg_color'] = jpeg(19, 18, 3)
    out['jpeg_restart'] = jpeg(24, 24, 1, restart=2)
    out['jpeg_progressive'] = jpeg(20, 12, 3, progressive=True)
    out['jpeg_progressive_grey'] = jpeg(16, 8, 1, progressive=True)
    out['jpeg_cmyk'] = jpeg(9, 8, 4)
    out['jpeg_ycck'] = jpeg(9, 8, 4, adobe=2)
    out['jpeg_rgb'] = jpeg(9, 8, 3, adobe=0)
    out.update(webp=WEBP, webp_lossy=WEBP_LOSSY)
    rgb = bytes(i * 37 % 256 for i in range(5 * 4 * 3))
    out['tiff_strips'] = tiff(5, 4, [rgb[:30], rgb[30:]])
    out['tiff_tiles'] = tiff(20, 9, [bytes(i * k % 256 for i in range(16 * 16)) for k in (3, 7)], samples=1, photometric=1, tile=16)
    out['tiff_lzw'] = tiff(5, 4, [lzw(rgb)], compression=5, predictor=2)
    out['tiff_deflate_16'] = tiff(5, 2, [zlib.compress(rgb, 0)], bits=16, compression=8, predictor=2)
    out['tiff_packbits'] = tiff(5, 4, [b'\x3b' + rgb], compression=32773)
    out['tiff_palette'] = tiff(5, 4, [bytes(range(12))], samples=1, bits=4, photometric=3, palette=range(0, 48 * 1000, 1000))
    return out


def ktx2(width, height, level, format=0, model=0, scheme=0, books=b''):
    """One level: its place, a descriptor and a key stand before it."""
    descriptor = struct.pack('<3I4B', 44, 0, 40 << 16 | 2, model, 1, 2, 0).ljust(44, b'\0')
    pairs = struct.pack('<I', 16) + b'KTXswizzle\0rg0r\0'
    at = 104 + len(descriptor) + len(pairs)
    places = struct.pack('<4I5Q', 104, len(descriptor), 104 + len(descriptor), len(pairs), at, len(books), at + len(books), len(level), 304)
    return (b'\xabKTX 20\xbb\r\n\x1a\n' + struct.pack('<9I', format, 1, width, height, 0, 0, 1, 1, scheme) + places + descriptor + pairs +
            books + level)


def ktx2_files():
    codes = (0x01, 0x35, 0x1D, 0x03, 0x13, 0x0B, 0x1B, 0x07, 0x17, 0x0F, 0x02, 0x00, 0x06, 0x1F, 0x0D, 0x05, 0x15, 0x25, 0x09)
    blocks = b''.join(bytes([code]) + bytes((code * i) & 0x7F for i in range(15)) for code in codes)
    # A frame of Zstandard with one block that is not compressed.
    frame = b'\x28\xb5\x2f\xfd\x60' + struct.pack('<H', len(blocks) - 256) + struct.pack('<I', len(blocks) << 3 | 1)[:3] + blocks
    out = {'etc1s': ktx2(20, 12, ETC1S_SLICES, model=163, scheme=1, books=ETC1S_BOOKS), 'uastc': ktx2(76, 4, blocks, model=166),
           'uastc_zstd': ktx2(76, 4, frame, model=166, scheme=2), 'uastc_zlib': ktx2(76, 4, zlib.compress(blocks, 0), model=166, scheme=3)}
    out.update({f'plain_{format}': ktx2(5, 4, blocks, format) for format in (9, 16, 29, 30, 37, 50)})
    return out


def exr():
    """Two rows of two pixels, floats without compression."""
    def attribute(name, kind, value):
        return name + b'\0' + kind + b'\0' + struct.pack('<i', len(value)) + value
    window = struct.pack('<4i', 0, 0, 1, 1)
    channels = b''.join(name + b'\0' + struct.pack('<4i', 2, 0, 1, 1) for name in (b'B', b'G', b'R')) + b'\0'
    head = (b'\x76\x2f\x31\x01' + struct.pack('<i', 2) + attribute(b'channels', b'chlist', channels) +
            attribute(b'compression', b'compression', b'\0') + attribute(b'dataWindow', b'box2i', window) +
            attribute(b'displayWindow', b'box2i', window) + attribute(b'lineOrder', b'lineOrder', b'\0') +
            attribute(b'pixelAspectRatio', b'float', struct.pack('<f', 1)) +
            attribute(b'screenWindowCenter', b'v2f', struct.pack('<2f', 0, 0)) +
            attribute(b'screenWindowWidth', b'float', struct.pack('<f', 1)) + b'\0')
    rows = [struct.pack('<2i6f', y, 24, 1, 2, 3, 4, 5, 6) for y in range(2)]
    first = len(head) + 16
    return head + struct.pack('<2Q', first, first + len(rows[0])) + b''.join(rows)


def environments():
    head = b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n'
    pixel = bytes([128, 64, 32, 128])
    runs = b''.join(bytes([2, 2, 0, 16]) + bytes([144, 90, 144, 60, 144, 30, 144, 129]) for _ in range(8))
    literal = b''.join(bytes([2, 2, 0, 8]) + b''.join(bytes([8]) + bytes(range(120, 128)) for _ in range(4)) for _ in range(4))
    sun = bytearray(pixel * 128)
    sun[4 * 40:4 * 41] = bytes([255, 250, 200, 142])
    return {
        'flat': head + b'\n-Y 4 +X 8\n' + pixel * 32,
        'runs': head + b'\n-Y 8 +X 16\n' + runs,
        'literal': head + b'\n-Y 4 +X 8\n' + literal,
        'old_runs': head + b'\n-Y 4 +X 6\n' + (pixel + bytes([1, 1, 1, 5])) * 4,
        'columns': head + b'\n+X 4 -Y 6\n' + pixel * 24,
        'upwards': head + b'\n+Y 4 -X 6\n' + pixel * 24,
        'sun': head + b'\n-Y 8 +X 16\n' + bytes(sun),
        'exposure': head + b'# comment\nEXPOSURE=2.5\nCOLORCORR= 1 2 0.5\nEXPOSURE=4\n\n-Y 1 +X 2\n' + pixel * 2,
        'black': b'#?RGBE\n\n-Y 1 +X 1\n' + bytes(4),
        'pfm': b'PF\n2 1\n-1.0\n' + struct.pack('<6f', 0.5, 1, 2, 0.25, 0, 1e6),
        'exr': exr(),
    }


# ---- models --------------------------------------------------------------------------------------------------------------

class Model:
    """A glTF file: data by bytes(), accessors by add()."""
    def __init__(self):
        self.bin = bytearray()
        self.json = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
                     'buffers': [], 'bufferViews': [], 'accessors': [], 'meshes': []}

    def view(self, data, **members):
        self.bin += bytes(-len(self.bin) % 4)
        self.json['bufferViews'].append({'buffer': 0, 'byteOffset': len(self.bin), 'byteLength': len(data), **members})
        self.bin += data
        return len(self.json['bufferViews']) - 1

    def add(self, values, code, kind, **members):
        components = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}[kind]
        letter = {5120: 'b', 5121: 'B', 5122: 'h', 5123: 'H', 5125: 'I', 5126: 'f'}[code]
        data = struct.pack(f'<{len(values)}{letter}', *values)
        self.json['accessors'].append({'bufferView': self.view(data), 'componentType': code, 'count': len(values) // components,
                                       'type': kind, **members})
        return len(self.json['accessors']) - 1

    def primitive(self, **members):
        self.json['meshes'].append({'primitives': [members]})

    def glb(self):
        document = {key: value for key, value in self.json.items() if value != []}
        document['buffers'] = [{'byteLength': len(self.bin)}]
        text = json.dumps(document, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = bytes(self.bin) + bytes(-len(self.bin) % 4)
        return (struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)) + struct.pack('<I4s', len(text), b'JSON') + text +
                struct.pack('<I4s', len(data), b'BIN\0') + data)

    def text(self):
        document = {key: value for key, value in self.json.items() if value != []}
        uri = 'data:application/octet-stream;base64,' + base64.b64encode(self.bin).decode()
        document['buffers'] = [{'uri': uri, 'byteLength': len(self.bin)}]
        return json.dumps(document, separators=(',', ':')).encode()


TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0]
QUAD = [-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0.5]


def triangle():
    model = Model()
    model.primitive(attributes={'POSITION': model.add(TRIANGLE, 5126, 'VEC3')})
    return model


def textured(picture=None, lit=True, mode='MASK'):
    model = Model()
    attributes = {'POSITION': model.add(QUAD, 5126, 'VEC3', min=[-1, -1, 0], max=[1, 1, 0.5]),
                  'NORMAL': model.add([0, 0, 1] * 4, 5126, 'VEC3'),
                  'TEXCOORD_0': model.add([0, 65535, 65535, 65535, 0, 0, 65535, 0], 5123, 'VEC2', normalized=True),
                  'TEXCOORD_1': model.add([0, 1, 1, 1, 0, 0, 1, 0], 5126, 'VEC2'),
                  'COLOR_0': model.add([255, 128, 64, 200] * 4, 5121, 'VEC4', normalized=True)}
    model.primitive(attributes=attributes, indices=model.add([0, 1, 2, 3], 5121, 'SCALAR'), mode=5, material=0)
    transform = {'KHR_texture_transform': {'offset': [0.1, 0.2], 'rotation': 0.5, 'scale': [2, 3], 'texCoord': 1}}
    material = {'name': 'm', 'pbrMetallicRoughness': {
        'baseColorTexture': {'index': 0, 'extensions': transform}, 'baseColorFactor': [1, 0.5, 0.25, 0.75], 'metallicFactor': 0.5,
        'roughnessFactor': 0.4, 'metallicRoughnessTexture': {'index': 1}}, 'normalTexture': {'index': 1, 'scale': 0.5},
        'occlusionTexture': {'index': 0, 'strength': 0.5, 'texCoord': 1}, 'emissiveTexture': {'index': 0}, 'emissiveFactor': [0.1, 0, 0],
        'alphaMode': mode, 'alphaCutoff': 0.25, 'doubleSided': True,
        'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 2}},
        'extras': {'halflit': {'lobe': 'mcauley', 'wrap': 0.5, 'power': 2, 'normalize': True}}}
    if mode != 'MASK':
        del material['alphaCutoff']
    if not lit:
        material['extensions']['KHR_materials_unlit'] = {}
    picture = picture or png(4, 3, 8, 6)
    uri = 'data:image/png;base64,' + base64.b64encode(png(2, 2, 16, 2)).decode()
    model.json.update(materials=[material], textures=[{'source': 0, 'sampler': 0}, {'source': 1}],
                      samplers=[{'magFilter': 9728, 'minFilter': 9987, 'wrapS': 33071, 'wrapT': 33648}],
                      images=[{'bufferView': model.view(picture), 'mimeType': 'image/png'}, {'uri': uri}],
                      extensionsUsed=['KHR_texture_transform', 'KHR_materials_emissive_strength', 'KHR_materials_unlit'])
    return model


def skinned():
    model = Model()
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    sparse = {'count': 2, 'indices': {'bufferView': model.view(struct.pack('<2H', 0, 2)), 'componentType': 5123},
              'values': {'bufferView': model.view(struct.pack('<6f', 0, 0, 1, 0, 1, 1))}}
    target = {'POSITION': model.add(TRIANGLE, 5126, 'VEC3', sparse=sparse)}
    model.primitive(attributes={'POSITION': model.add(TRIANGLE, 5126, 'VEC3'), 'JOINTS_0': model.add([0, 1, 0, 0] * 3, 5121, 'VEC4'),
                                'WEIGHTS_0': model.add([0.5, 0.5, 0, 0] * 3, 5126, 'VEC4')}, targets=[target],
                    indices=model.add([0, 1, 2], 5125, 'SCALAR'))
    model.json['meshes'][0]['weights'] = [0.5]
    model.json.update(nodes=[{'mesh': 0, 'skin': 0, 'weights': [0.25]}, {'translation': [0, 1, 0], 'children': [2]},
                             {'rotation': [0, 0, 0.6, 0.8], 'scale': [1, 2, 1]}], scenes=[{'nodes': [0, 1]}],
                      skins=[{'joints': [1, 2], 'inverseBindMatrices': model.add(identity * 2, 5126, 'MAT4'), 'skeleton': 1}],
                      animations=[])
    times = model.add([0, 1, 2], 5126, 'SCALAR', min=[0], max=[2])
    moves = {'translation': model.add([0, 1, 0, 1, 1, 1, 0, 2, 0], 5126, 'VEC3'), 'weights': model.add([0, 127, 0], 5120, 'SCALAR', normalized=True),
             'rotation': model.add([0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0] * 3, 5126, 'VEC4')}
    kinds = {'translation': 'STEP', 'weights': 'LINEAR', 'rotation': 'CUBICSPLINE'}
    nodes = {'translation': 1, 'weights': 0, 'rotation': 2}
    model.json['animations'] = [{'name': 'wave', 'channels': [{'sampler': i, 'target': {'node': nodes[path], 'path': path}}
                                                              for i, path in enumerate(moves)],
                                 'samplers': [{'input': times, 'output': output, 'interpolation': kinds[path]}
                                              for path, output in moves.items()]}]
    shown = model.add([1, 0, 1], 5121, 'SCALAR')
    pointer = {'path': 'pointer', 'extensions': {'KHR_animation_pointer': {'pointer': '/nodes/0/extensions/KHR_node_visibility/visible'}}}
    model.json['animations'].append({'channels': [{'sampler': 0, 'target': pointer}],
                                     'samplers': [{'input': times, 'output': shown, 'interpolation': 'STEP'}]})
    model.json['extensionsUsed'] = ['KHR_animation_pointer', 'KHR_node_visibility']
    return model


def lit():
    model = Model()
    model.primitive(attributes={'POSITION': model.add([0, 0, 0, 100, 0, 0, 0, 100, 0, 100, 100, 3], 5122, 'VEC3'),
                                'NORMAL': model.add([0, 0, 127] * 4, 5120, 'VEC3', normalized=True)},
                    indices=model.add([0, 1, 2, 2, 1, 3], 5123, 'SCALAR'))
    # VEC3 of 1 or 2 bytes is padded to 4.
    model.json['bufferViews'][0].update(byteLength=32, byteStride=8)
    model.json['bufferViews'][1].update(byteLength=16, byteStride=4)
    model.bin = bytearray()
    views = [struct.pack('<16h', 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 100, 100, 3, 0), bytes([0, 0, 127, 0] * 4),
             struct.pack('<6H', 0, 1, 2, 2, 1, 3)]
    for view, data in zip(model.json['bufferViews'], views):
        view.update(byteOffset=len(model.bin), byteLength=len(data))
        model.bin += data
    lights = [{'type': 'spot', 'spot': {'innerConeAngle': 0.2, 'outerConeAngle': 0.6}, 'intensity': 40, 'range': 500},
              {'type': 'point', 'color': [1, 0.5, 0.2], 'intensity': 9}, {'type': 'directional', 'name': 'sun'}]
    model.json.update(extensionsUsed=['KHR_lights_punctual', 'KHR_mesh_quantization'], extensionsRequired=['KHR_mesh_quantization'],
                      extensions={'KHR_lights_punctual': {'lights': lights}},
                      cameras=[{'type': 'perspective', 'perspective': {'yfov': 0.8, 'znear': 0.1, 'zfar': 900, 'aspectRatio': 1.5}, 'name': 'c'},
                               {'type': 'orthographic', 'orthographic': {'xmag': 60, 'ymag': 60, 'znear': 0.1, 'zfar': 500}}],
                      scenes=[{'nodes': [0, 1]}],
                      nodes=[{'mesh': 0, 'children': [2, 3]}, {'camera': 0, 'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 50, 50, 300, 1]},
                             {'extensions': {'KHR_lights_punctual': {'light': 0}}, 'translation': [50, 50, 90], 'children': [4]},
                             {'extensions': {'KHR_lights_punctual': {'light': 1}}, 'translation': [10, 50, 30]},
                             {'extensions': {'KHR_lights_punctual': {'light': 2}}, 'camera': 1, 'translation': [10, 50, 30]}])
    return model


def two_quads():
    """One above the other, turned: shadows, clipping, blending."""
    model = textured(mode='BLEND')
    turned = {'rotation': [0.38, 0, 0, 0.92], 'translation': [0, 0, 0.7], 'scale': [0.5, 0.5, 0.5]}
    model.json['nodes'] = [{'mesh': 0}, {'mesh': 0, **turned}]
    model.json['scenes'] = [{'nodes': [0, 1]}]
    return model


def draco(stream):
    model = Model()
    model.json['accessors'] = [{'componentType': 5125, 'count': 6, 'type': 'SCALAR'}, {'componentType': 5126, 'count': 4, 'type': 'VEC3'}]
    extension = {'bufferView': model.view(stream), 'attributes': {'POSITION': 0}}
    model.primitive(attributes={'POSITION': 1}, indices=0, extensions={'KHR_draco_mesh_compression': extension})
    model.json['extensionsUsed'] = ['KHR_draco_mesh_compression']
    return model


def meshopt(name, indices, mode):
    model = Model()
    for data, stride, count, kind in ((MESHOPT_VERTICES, 12, 4, 'ATTRIBUTES'), (indices, 4, 6, mode)):
        view = model.json['bufferViews'][model.view(data)]
        compressed = {'buffer': 0, 'byteOffset': view['byteOffset'], 'byteLength': len(data), 'byteStride': stride, 'count': count,
                      'mode': kind, 'filter': 'NONE'}
        view.update(byteOffset=0, byteLength=stride * count, extensions={name: compressed})
    model.json['accessors'] = [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3'},
                               {'bufferView': 1, 'componentType': 5125, 'count': 6, 'type': 'SCALAR'}]
    model.primitive(attributes={'POSITION': 0}, indices=1)
    model.json['extensionsUsed'] = [name]
    return model


def models():
    return {'webp': textured(WEBP), 'draco': draco(DRACO), 'draco_sequential': draco(DRACO_SEQUENTIAL),
            'meshopt': meshopt('EXT_meshopt_compression', MESHOPT_TRIANGLES, 'TRIANGLES'),
            'meshopt_khr': meshopt('KHR_meshopt_compression', MESHOPT_INDICES, 'INDICES'),
            'triangle': triangle(), 'textured': textured(), 'unlit': textured(lit=False), 'jpeg': textured(jpeg(16, 16, 3)),
            'skinned': skinned(), 'lit': lit(), 'two_quads': two_quads()}


# ---- other formats of models ----------------------------------------------------------------------------------------------

def other_models():
    """A pyramid in each format."""
    points = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 2)]
    faces = [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    triangles = [(face[0], face[i], face[i + 1]) for face in faces for i in range(1, len(face) - 1)]
    facets = ''.join('facet normal 0 0 0\nouter loop\n' + ''.join('vertex %g %g %g\n' % points[i] for i in t) + 'endloop\nendfacet\n'
                     for t in triangles)
    binary = b''.join(struct.pack('<12fH', 0, 0, 0, *points[t[0]], *points[t[1]], *points[t[2]], 0x8000 + 999 * k)
                      for k, t in enumerate(triangles))
    header = ('ply\nformat {} 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n'
              'property uchar green\nproperty uchar blue\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n')
    ply_text = header.format('ascii') + ''.join('%g %g %g 1 2 3\n' % p for p in points)
    ply_text += ''.join('%d %s\n' % (len(face), ' '.join(map(str, face))) for face in faces)
    plies = {}
    for name, order in (('little', '<'), ('big', '>')):
        plies['ply_' + name] = (header.format(f'binary_{name}_endian').encode() +
                                b''.join(struct.pack(order + '3f3B', *p, 9, 8, 7) for p in points) +
                                b''.join(struct.pack(f'{order}B{len(face)}i', len(face), *face) for face in faces))
    obj = 'mtllib a.mtl\no pyramid\n' + ''.join('v %g %g %g 1 0 0\n' % p for p in points) + 'vt 0 1\nvn 0 0 1\nusemtl a\ns 1\n'
    obj += ''.join('f %s\n' % ' '.join('%d/1/1' % (i + 1) for i in face) for face in faces) + 's off\nf -1 -2 -3\nl 1 2\n'
    core = 'http://schemas.microsoft.com/3dmanufacturing/core/2015/02'
    more = 'http://schemas.microsoft.com/3dmanufacturing/material/2015/02'
    xml = (f'<model unit="inch" xmlns="{core}" xmlns:m="{more}"><resources><basematerials id="5"><base name="a" displaycolor="#FF0000"/>'
           '</basematerials><m:colorgroup id="6"><m:color color="#00FF0080"/></m:colorgroup><object id="1" pid="5" pindex="0"><mesh><vertices>')
    xml += ''.join('<vertex x="%g" y="%g" z="%g"/>' % p for p in points) + '</vertices><triangles>'
    xml += ''.join('<triangle v1="%d" v2="%d" v3="%d" pid="6" p1="0"/>' % t for t in triangles) + '</triangles></mesh></object>'
    xml += ('<object id="2"><components><component objectid="1"/><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components>'
            '</object></resources><build><item objectid="2"/></build></model>')
    beams = '/3dmanufacturing/beamlattice/'
    lattice = xml.replace('<model ', f'<model xmlns:b="http://schemas.microsoft.com{beams}2017/02" ').replace(
        '</mesh>', '<b:beamlattice radius="0.2" minlength="0.1" cap="butt"><b:beams><b:beam v1="0" v2="1" r1="0.1" cap2="sphere" p1="0"/>'
        '</b:beams><b:balls><b:ball vindex="2" r="0.3"/></b:balls></b:beamlattice></mesh>')
    mixed = xml.replace('<object id="1"', '<m:compositematerials id="7" matid="5" matindices="0"><m:composite values="1"/>'
                        '</m:compositematerials><m:multiproperties id="8" pids="5 6"><m:multi pindices="0 0"/></m:multiproperties>'
                        '<object id="1"', 1).replace('pid="6"', 'pid="8"').replace('name="a"', 'name="a & b"')
    package = io.BytesIO()
    with zipfile.ZipFile(package, 'w', zipfile.ZIP_DEFLATED) as parts:
        parts.writestr(zipfile.ZipInfo('3D/a.model'), xml)
        parts.writestr(zipfile.ZipInfo('Metadata/model_settings.config'), '<config><object id="2"/></config>')
    gcode = '; generated by a slicer\n; thumbnail begin 1x1 8\n; iVBORw0K\n; thumbnail end\n'
    off = 'COFF\n%d %d 0\n' % (len(points), len(faces)) + ''.join('%g %g %g 255 0 0 255\n' % p for p in points)
    off += ''.join('%d %s 0.5 0 0\n' % (len(face), ' '.join(map(str, face))) for face in faces)
    return {'off': off.encode(), 'stl_text': ('solid a\n' + facets + 'endsolid a\n').encode(),
            'stl_binary': b'solid COLOR=1234'.ljust(80) + struct.pack('<I', len(triangles)) + binary,
            'ply_text': ply_text.encode(), **plies, 'obj': obj.encode(), 'xml': xml.encode(), 'lattice': lattice.encode(),
            'mixed': mixed.encode(), 'gcode': gcode.encode(), 'zip': package.getvalue()}


# ---- targets -------------------------------------------------------------------------------------------------------------

def main():
    folder = pathlib.Path(sys.argv[1])
    numbers = random.Random(13)
    made = models()
    empty = json.dumps({'asset': {'version': '2.0'}}).encode()
    seeds = {
        'gltf_text': {'empty': empty, 'spaces': json.dumps(json.loads(triangle().text()), indent=1).encode(),
                      **{name: model.text() for name, model in made.items()}},
        'glb': {name: model.glb() for name, model in made.items()},
        'model': other_models(),
        'picture': pictures(),
        'ktx2': ktx2_files(),
        'hdr': environments(),
        'scene': {**{f'{name}_{i}': model.glb() + numbers.randbytes(FLAG_BYTES) for name, model in made.items() for i in range(2)},
                  **{f'code_{i}': numbers.randbytes(700 + FLAG_BYTES) for i in range(8)}},
        'c_api': {f'calls_{i}': numbers.randbytes(400 + 200 * i) for i in range(12)},
    }
    for target, files in seeds.items():
        (folder / target).mkdir(parents=True, exist_ok=True)
        for name, data in files.items():
            (folder / target / name).write_bytes(data)


main()
