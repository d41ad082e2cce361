"""The hash of a picture's pixels, as the program's reports have it: XXH64 of the RGBA bytes. The standard library alone."""
import struct
import zlib

P1, P2, P3, P4, P5 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
MASK = (1 << 64) - 1


def _turn(value, bits):
    return ((value << bits) | (value >> (64 - bits))) & MASK


def _round(sum_, lane):
    return _turn((sum_ + lane * P2) & MASK, 31) * P1 & MASK


def xxh64(data):
    """XXH64 with seed 0 of bytes whose number is a multiple of 4, as 16 hexadecimal digits."""
    stripes = len(data) // 32
    lanes = struct.unpack(f"<{4 * stripes}Q", data[: 32 * stripes])
    if stripes:
        sums = []
        for k, start in enumerate(((P1 + P2) & MASK, P2, 0, -P1 & MASK)):
            sum_ = start
            for lane in lanes[k::4]:
                sum_ = (sum_ + lane * P2) & MASK
                sum_ = ((sum_ << 31) | (sum_ >> 33)) * P1 & MASK
            sums.append(sum_)
        value = sum(_turn(sum_, bits) for sum_, bits in zip(sums, (1, 7, 12, 18))) & MASK
        for sum_ in sums:
            value = ((value ^ _round(0, sum_)) * P1 + P4) & MASK
    else:
        value = P5
    value = (value + len(data)) & MASK
    rest = data[32 * stripes :]
    for (lane,) in struct.iter_unpack("<Q", rest[: len(rest) // 8 * 8]):
        value = (_turn(value ^ _round(0, lane), 27) * P1 + P4) & MASK
    for (lane,) in struct.iter_unpack("<I", rest[len(rest) // 8 * 8 :]):
        value = (_turn(value ^ (lane * P1 & MASK), 23) * P2 + P3) & MASK
    for shift, factor in ((33, P2), (29, P3)):
        value = (value ^ (value >> shift)) * factor & MASK
    return f"{value ^ (value >> 32):016x}"


def _rows(packed, width, height, channels):
    """The bytes of a picture of 8 bits from the compressed stream of a PNG file, whose rows begin with the number of a filter."""
    data, size, made = zlib.decompress(packed), width * channels, []
    before = bytearray(size)
    for y in range(height):
        start = y * (size + 1)
        kind, row = data[start], bytearray(data[start + 1 : start + 1 + size])
        if kind == 1:
            for i in range(channels, size):
                row[i] = (row[i] + row[i - channels]) & 255
        elif kind == 2:
            row = bytearray((a + b) & 255 for a, b in zip(row, before))
        elif kind == 3:
            for i in range(size):
                left = row[i - channels] if i >= channels else 0
                row[i] = (row[i] + (left + before[i]) // 2) & 255
        elif kind == 4:
            for i in range(size):
                a, b, c = (row[i - channels], before[i], before[i - channels]) if i >= channels else (0, before[i], 0)
                pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
                row[i] = (row[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        made.append(row)
        before = row
    return b"".join(made)


def _rgba(pixels, channels):
    if channels == 4:
        return pixels
    made = bytearray(b"\xff") * (len(pixels) // channels * 4)
    for k in range(3):
        made[k::4] = pixels[(k if channels == 3 else 0) :: channels]
    return bytes(made)


def of_file(path):
    """The hash of a PNG file of 8 bits, or of all frames of an APNG file one after the other; of other files, the hash of their bytes."""
    data = path.read_bytes()
    if not data.startswith(b"\x89PNG"):
        return xxh64(data + bytes(-len(data) % 4))
    frames, width, height, channels, at = [], 0, 0, 0, 8
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            channels = {0: 1, 2: 3, 6: 4}.get(color, 0)
            if depth != 8 or not channels:
                raise ValueError(f"{path}: expected 8 bits of grey, RGB or RGBA")
            frames = [(width, height, [])]
        elif kind == b"fcTL" and frames[-1][2]:  # the first one is that of the IDAT chunks
            frames.append((*struct.unpack(">II", body[4:12]), []))
        elif kind in (b"IDAT", b"fdAT"):
            frames[-1][2].append(body if kind == b"IDAT" else body[4:])
    return xxh64(b"".join(_rgba(_rows(b"".join(parts), w, h, channels), channels) for w, h, parts in frames))
