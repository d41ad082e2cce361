#!/usr/bin/env python3
"""Runs the command lines of README.md and of the pages of docs/.

    commands_test.py PROGRAM [PAGE...]

Each page has a folder with the files that its commands name, and its commands run in order. A command ends with 0, or with 1 where its
comment says "exit code 1". Lines that begin with "$ " print the lines below them, of which "..." at the end stands for more. Commands that
cannot run here are in not_run.txt, with the reason.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import pages

sys.path.insert(0, str(pages.ROOT / "docs/site"))
import small_models  # noqa: E402

SECONDS = 120  # limit of one command


def not_run():
    """Beginning of a command: reason."""
    rows = {}
    for line in (pathlib.Path(__file__).parent / "not_run.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            start, _, reason = line.partition(" : ")
            rows[start.strip()] = reason.strip()
    return rows


def damaged_models(folder, program):
    """Makes the files that docs/troubleshooting.md names."""
    for name, size in (("tall", "60x90"), ("wide", "90x60")):
        subprocess.run([program, "demo", folder / f"{name}.png", "--size", size, "--quiet"], check=True)
    (folder / "wrong.glb").write_text("<html>404</html>")
    (folder / "character.fbx").write_bytes(b"Kaydara FBX Binary  \0")
    (folder / "empty.stl").write_bytes(b"")
    (folder / "cut_off.glb").write_bytes((folder / "model.glb").read_bytes()[:100])
    triangle = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}]}
    for name, uri in (("lost", "lost.bin"), ("above", "../lost.bin")):
        (folder / f"{name}.gltf").write_text(json.dumps({**triangle, "buffers": [{"uri": uri, "byteLength": 36}]}))
    uri = "data:application/octet-stream;base64," + "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
    (folder / "avif.gltf").write_text(json.dumps({**triangle, "extensionsUsed": ["EXT_texture_avif"],
                                                  "buffers": [{"uri": uri, "byteLength": 36}]}))


def golden_folders(folder):
    """Makes the files that docs/golden.md and docs/recipes.md name."""
    for name in ("tests/pictures", "pictures"):
        at = folder / name
        (at / "models").mkdir(parents=True)
        (at / "models/knot.glb").write_bytes((folder / "model.glb").read_bytes())
        scenes = [{"name": "knot", "scene": "models/knot.glb", "flags": ["--size", "160x90"]}]
        (at / "golden.json").write_text(json.dumps({"schema": "halflit.golden-list/1", "scenes": scenes}))


def faults_of(line, printed, folder, environment):
    """Runs a command, and tells what is wrong with its end."""
    expected = 1 if "exit code 1" in line.partition(" # ")[2] else 0
    words = line.removeprefix("$ ")
    try:
        done = subprocess.run(["bash", "-c", words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return [f"takes more than {SECONDS} s"]
    errors = done.stderr.decode()
    if printed:
        said = [text.strip() for text in (errors + done.stdout.decode(errors="replace")).splitlines()]
        missing = [text for text in printed if not any(had == text or (text.endswith("...") and had.startswith(text[:-3])) for had in said)]
        failed = any("halflit: error:" in text for text in printed)
        ended = [] if failed == (done.returncode != 0) else [f"ends with {done.returncode}"]
        return [f"does not print: {text}\n{errors}" for text in missing] + ended
    return [] if done.returncode == expected else [f"ends with {done.returncode}, expected {expected}\n{errors}"]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program, only = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    reasons, used, ran, found = not_run(), set(), 0, []
    with tempfile.TemporaryDirectory() as work:
        bin_folder = pathlib.Path(work) / "bin"
        bin_folder.mkdir()
        (bin_folder / "halflit").symlink_to(program)
        environment = {"PATH": f"{bin_folder}:/usr/local/bin:/usr/bin:/bin", "HOME": work}
        for page in pages.pages():
            if only and page.name not in only:
                continue
            folder = pathlib.Path(work) / page.stem
            small_models.write_all(folder)
            if page.stem == "troubleshooting":
                damaged_models(folder, program)
            golden_folders(folder)
            for number, line, printed in pages.commands(page):
                start = next((start for start in reasons if line.startswith(start)), None)
                if start is not None:
                    used.add(start)
                    continue
                began = time.monotonic()
                faults = faults_of(line, printed, folder, environment)
                ran += 1
                found += [f"{page.relative_to(pages.ROOT)}:{number}: {line}\n    {fault}" for fault in faults]
                if time.monotonic() - began > 5:
                    print(f"{page.name}:{number}: {time.monotonic() - began:.0f} s: {line}")
    if not only:
        found += [f"not_run.txt: no page has '{start}'" for start in reasons if start not in used]
    print("\n".join(found) if found else f"{ran} commands ran, {len(used)} reasons not to run others")
    return 1 if found or (not only and ran < 80) else 0


if __name__ == "__main__":
    sys.exit(main())
