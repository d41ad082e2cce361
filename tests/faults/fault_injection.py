"""Makes each call of `halflit render` fail in turn, by the shim of fault_shim.c, and checks what comes of it.

The calls of a kind (allocations, opened files, ...) are counted in an undisturbed run; then the program runs once for each of them, and
that one fails. Whatever fails: exit code 0 with the right picture, or 3, 4 or 5 with one line of error, the old picture, a report of the
error, and no file left over. Never 6, never a signal.
"""
import argparse
import concurrent.futures
import errno
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import time
import zlib

OLD_PICTURE = b"the old picture"
OLD_REPORT = b'{"status": "of an older run"}'
HALF = 0  # error 0: half of the bytes are read or written

# Kind of call: the errors that it ends with. An interrupted or partial transfer goes on, so these must not be seen from outside.
ERRORS = {
    "alloc": [errno.ENOMEM],
    "thread": [errno.EAGAIN],
    "mmap": [errno.ENOMEM],
    "open": [errno.EACCES, errno.EMFILE],
    "read": [errno.EIO, errno.ESTALE, errno.EINTR, HALF],
    "write": [errno.ENOSPC, errno.EIO, errno.EINTR, HALF],
    "fsync": [errno.EIO],
    "rename": [errno.EIO],
    "close": [errno.EIO],
    "stat": [errno.EACCES],
}
HARMLESS = [HALF, errno.EINTR]
ROUNDS = [(threads, shadows) for threads in (1, 2) for shadows in ("off", "soft-split")]


def picture_file(size):
    """A PNG of size x size opaque pixels."""

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + bytes(v for x in range(size) for v in (16 * x, 16 * y, 128)) for y in range(size))
    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def write_model(folder):
    """A square above a larger one, lit from above: a texture, a buffer and a light, so that there are shadows."""
    positions, normals, uvs, indices = b"", b"", b"", b""
    for first, (half, height) in enumerate([(1.0, 0.0), (0.4, 0.5)]):
        for x, z in [(-1, -1), (-1, 1), (1, 1), (1, -1)]:
            positions += struct.pack("<3f", half * x, height, half * z)
            normals += struct.pack("<3f", 0, 1, 0)
            uvs += struct.pack("<2f", (x + 1) / 2, (z + 1) / 2)
        indices += struct.pack("<6H", *(4 * first + i for i in (0, 1, 2, 0, 2, 3)))
    parts = [positions, normals, uvs, indices]
    views = [{"buffer": 0, "byteOffset": sum(map(len, parts[:i])), "byteLength": len(part)} for i, part in enumerate(parts)]
    lights = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}
    model = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": lights,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"rotation": [-0.6, 0.2, 0, 0.775], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}],
        "textures": [{"source": 0}],
        "images": [{"uri": "squares.png"}],
        "buffers": [{"uri": "squares.bin", "byteLength": sum(map(len, parts))}],
        "bufferViews": views,
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0.5, 1]},
            {"bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
    }
    os.makedirs(folder)
    for name, content in [("squares.gltf", json.dumps(model).encode()), ("squares.bin", b"".join(parts)), ("squares.png", picture_file(16))]:
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)


def content_of(path):
    with open(path, "rb") as file:
        return file.read()


class Place:
    """A folder of one run: model/, pictures/ with an old picture, reports/ with an old report."""

    def __init__(self, folder):
        shutil.rmtree(folder, ignore_errors=True)
        write_model(os.path.join(folder, "model"))
        for name in ("pictures", "reports"):
            os.mkdir(os.path.join(folder, name))
        self.folder = folder
        self.picture = os.path.join(folder, "pictures", "squares.png")
        self.report = os.path.join(folder, "reports", "squares.json")
        self.log = os.path.join(folder, "log")

    def run(self, program, shim, round_, kind, at, error, on=False):
        threads, shadows = round_
        for path, content in [(self.picture, OLD_PICTURE), (self.report, OLD_REPORT)]:
            with open(path, "wb") as file:
                file.write(content)
        command = [program, "render", os.path.join(self.folder, "model", "squares.gltf"), "-o", self.picture, "--report", self.report]
        command += ["-q", "--size", "80x32", "--threads", str(threads), "--shadows", shadows, "--shadow-size", "64"]
        fault = {"KIND": kind, "AT": str(at), "ERROR": str(error), "ON": str(int(on)), "LOG": self.log}
        environment = dict(os.environ, LD_PRELOAD=shim, **{"HALFLIT_FAULT_" + name: value for name, value in fault.items()})
        done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=60, check=False)
        return Outcome(self, done)

    def left_over(self):
        """Files that should not be there."""
        found = [os.path.join(f, name) for f in ("pictures", "reports", "model") for name in os.listdir(os.path.join(self.folder, f))]
        for path in found:
            if ".tmp" in path:
                os.remove(os.path.join(self.folder, path))
        expected = ["pictures/squares.png", "reports/squares.json", "model/squares.gltf", "model/squares.bin", "model/squares.png"]
        return sorted(set(found) - set(expected))


class Outcome:
    def __init__(self, place, done):
        self.code = done.returncode
        self.lines = done.stderr.decode(errors="replace").splitlines()
        self.picture = content_of(place.picture)
        self.report_bytes = content_of(place.report)
        try:
            self.report = json.loads(self.report_bytes)
        except ValueError:
            self.report = None
        self.left_over = place.left_over()
        log = dict(line.partition(" ")[::2] for line in content_of(place.log).decode().splitlines())
        self.calls = int(log.get("calls", -1))
        self.fired = "failed" in log
        self.after = log.get("after", "")


def codes_allowed(kind, error):
    if error in HARMLESS or kind == "thread":
        return [0]
    if kind in ("alloc", "mmap"):
        return [0, 5]
    return [0, 4]  # a file that cannot be read is never a fault of the model, nor left out with a warning


def wrong(outcome, right, kind, error, on):
    """The faults of the outcome: a list of sentences, empty without a fault."""
    found = []
    after, code = outcome.after, outcome.code
    allowed = codes_allowed(kind, error) if outcome.fired else [0]
    if code not in allowed:
        found.append("expected exit code %s, found %d" % (" or ".join(map(str, allowed)), code))
    if outcome.left_over:
        found.append("left over: " + " ".join(re.sub(r"\d+", "PID", name) for name in outcome.left_over))
    if code == 0:
        if outcome.picture != right.picture:
            found.append("exit code 0 with another picture")
        if not outcome.report or outcome.report.get("status") != "ok" or outcome.report.get("pixel_hash") != right.report["pixel_hash"]:
            found.append("exit code 0 without its report")
        if any("error" in line for line in outcome.lines):
            found.append("exit code 0 with a message of an error")
        return found
    errors = [line for line in outcome.lines if line.startswith("halflit: error: ") and len(line) > len("halflit: error: ")]
    if len(errors) != 1 or len(outcome.lines) != 1:
        found.append("expected one line of error")
    # Two files cannot be replaced at once: where the report alone fails, the picture is there, and the message names the report.
    report_alone = any("reports" in line for line in errors) and outcome.picture == right.picture
    if outcome.picture != OLD_PICTURE and not report_alone:
        found.append("an error, and the picture is " + ("the new one" if outcome.picture == right.picture else "broken"))
    # The report is known from the end of the command line on, and the model is opened after that. Where nothing works any more, or the
    # report's own file fails, the old one stays.
    if "reports" not in after and after != "" and not on and not report_alone:
        if not outcome.report or outcome.report.get("status") != "error":
            found.append("no report of the error")
    elif outcome.report_bytes != OLD_REPORT and outcome.report is None:
        found.append("a broken report")
    return found


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("shim")
    arguments.add_argument("folder")
    arguments.add_argument("--stride", type=int, default=1, help="of allocations, every STRIDEth fails")
    arguments.add_argument("--first", type=int, default=1, help="number of the first allocation that fails")
    arguments.add_argument("--rounds", type=int, default=len(ROUNDS), help="combinations of threads and shadows")
    arguments.add_argument("--kinds", default=",".join(ERRORS))
    arguments.add_argument("--examples", type=int, default=3, help="number printed of outcomes that are wrong in the same way")
    arguments.add_argument("--on", action="store_true", help="all later calls fail too")
    options = arguments.parse_args()
    begin = time.monotonic()
    jobs = os.cpu_count() or 1
    places = [Place(os.path.join(options.folder, str(i))) for i in range(jobs)]
    free = list(places)
    tried, not_reached, wrong_outcomes, codes, alike = {}, 0, 0, {}, {}

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for round_ in ROUNDS[len(ROUNDS) - options.rounds :]:
            for kind in options.kinds.split(","):
                right = places[0].run(options.program, options.shim, round_, kind, 0, 0)
                if right.code != 0 or right.report is None or wrong(right, right, kind, 0, False):
                    sys.exit("the undisturbed run failed: " + "\n".join(right.lines))
                first, stride = (options.first, options.stride) if kind == "alloc" else (1, 1)
                points = [(at, error) for error in ERRORS[kind] for at in range(first, right.calls + 1, stride)]

                def attempt(point):
                    place = free.pop()
                    try:
                        return place.run(options.program, options.shim, round_, kind, *point, options.on)
                    finally:
                        free.append(place)

                for (at, error), outcome in zip(points, pool.map(attempt, points)):
                    tried[kind] = tried.get(kind, 0) + 1
                    not_reached += not outcome.fired
                    codes[outcome.code] = codes.get(outcome.code, 0) + 1
                    sentences = wrong(outcome, right, kind, error, options.on)
                    if not sentences:
                        continue
                    wrong_outcomes += 1
                    key = (kind, outcome.code, *sentences)
                    alike[key] = alike.get(key, 0) + 1
                    if alike[key] <= options.examples:
                        what = os.strerror(error) if error else "half of the bytes"
                        print("%s %d of %d (%s), threads %d, shadows %s, after '%s': exit code %d, %s | %s"
                              % (kind, at, right.calls, what, *round_, outcome.after, outcome.code, "; ".join(sentences),
                                 " / ".join(outcome.lines)))
    for (kind, code, *sentences), count in alike.items():
        print("%d times: %s, exit code %d, %s" % (count, kind, code, "; ".join(sentences)))
    if not tried:
        sys.exit("nothing was tried")
    points = ", ".join("%s %d" % pair for pair in tried.items())
    print("%d points (%s), %d not reached, exit codes %s, %d wrong outcomes, %.1f s"
          % (sum(tried.values()), points, not_reached, dict(sorted(codes.items())), wrong_outcomes, time.monotonic() - begin))
    sys.exit(1 if wrong_outcomes else 0)


if __name__ == "__main__":
    main()
