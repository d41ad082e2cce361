#!/usr/bin/env python3
"""Runs the scripts of the gallery and compares the hashes of their pictures; makes pages and notebooks of them.

    gallery.py check|update KIND...        KIND: py, sh, cpp, c, mjs
    gallery.py pages FOLDER                a page for each script, an index, and notebooks of the Python scripts

HALFLIT_PROGRAM is the program, HALFLIT_LIBRARY the library of the Python package, HALFLIT_NODE_MODULES a folder with the package for npm.
Programs in C and C++ lie beside the program. Each script runs in an empty folder below HALFLIT_GALLERY_WORK and writes the picture that
table.txt names. HALFLIT_ASSETS is the folder of models that some scripts draw; without it they are left out. Exit code 77: a kind cannot
run here.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

import picture_hash

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "table.txt"
LANGUAGES = {"py": "python", "sh": "sh", "cpp": "cpp", "c": "c", "mjs": "js"}
PYTHON = HERE.parents[1] / "python"  # the package
WORK = pathlib.Path(os.environ.get("HALFLIT_GALLERY_WORK", "gallery_work")).resolve()
OUTPUT, MOST_LINES = "output.txt", 60  # what a script prints; lines of it that its page shows
HASH = 2  # column of the table
NO_HASH = "-"  # a program that has its own test, and a picture in the repository


class Entry:
    """A row of the table: a script, its picture and the picture's hash; and the title and sentence at the script's start."""

    def __init__(self, section, row):
        name, self.picture, self.hash = row
        self.section, self.path = section, HERE / name
        self.stem, self.kind = self.path.stem, self.path.suffix[1:]
        self.page = f"{self.stem}_{self.kind}"
        text = self.path.read_text()
        self.needs_assets = "HALFLIT_ASSETS" in text
        lines = text.splitlines()
        mark = "#" if self.kind in ("py", "sh") else "//"
        if not all(line.startswith(mark + " ") for line in lines[:2]):
            sys.exit(f"{self.path}: expected a title and a sentence in the first two lines, behind {mark}")
        self.title, self.sentence = (line[len(mark) + 1 :] for line in lines[:2])
        self.code = "\n".join(lines[2:]).strip("\n") + "\n"

    def lack(self):
        """Why the script cannot run here though its kind can, or nothing."""
        return "HALFLIT_ASSETS is not set" if self.needs_assets and "HALFLIT_ASSETS" not in os.environ else ""


def read_table():
    entries, section = [], ""
    for line in TABLE.read_text().splitlines():
        if line.startswith("# "):
            section = line[2:]
        elif line:
            entries.append(Entry(section, line.split()))
    return entries


def write_hashes(found):
    """Puts hashes, by names of scripts, into the table."""
    lines = [line.split() if line and line[0] != "#" else line for line in TABLE.read_text().splitlines()]
    for row in lines:
        if isinstance(row, list) and row[0] in found:
            row[HASH] = found[row[0]]
    TABLE.write_text("".join((f"{row[0]:26} {row[1]:26} {row[2]}" if isinstance(row, list) else row) + "\n" for row in lines))


def lack(kind):
    """Why scripts of this kind cannot run here, or nothing."""
    if kind == "py" and subprocess.run([sys.executable, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode:
        return "this Python has no numpy"
    modules = os.environ.get("HALFLIT_NODE_MODULES")
    if kind == "mjs" and not (shutil.which("node") and modules and pathlib.Path(modules, "halflit").is_dir()):
        return "no Node.js, or HALFLIT_NODE_MODULES has no package halflit"
    return ""


def run(entry):
    """Runs a script in an empty folder; returns the folder."""
    program = pathlib.Path(os.environ["HALFLIT_PROGRAM"]).resolve()
    folder = WORK / entry.page
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    environment = dict(os.environ, HALFLIT_EXAMPLES=str(HERE.parent), PYTHONPATH=str(PYTHON), PYTHONDONTWRITEBYTECODE="1")
    environment["PATH"] = f"{program.parent}:{environment['PATH']}"
    script = entry.path
    if entry.kind == "mjs":  # packages are looked for beside the script
        script = shutil.copy(entry.path, folder)
        (folder / "node_modules").symlink_to(pathlib.Path(os.environ["HALFLIT_NODE_MODULES"]).resolve())
    commands = {"py": [sys.executable, script], "sh": ["bash", "-euo", "pipefail", script], "mjs": ["node", script]}
    command = commands.get(entry.kind, [program.parent / f"halflit_gallery_{entry.stem}", HERE.parent / "knot.glb"])
    with open(folder / OUTPUT, "w", encoding="utf-8") as output:
        subprocess.run(command, cwd=folder, env=environment, check=True, stdout=output)
    return folder


def check(kinds, update):
    failed, found = 0, {}
    for entry in read_table():
        if entry.kind not in kinds or entry.hash == NO_HASH:
            continue
        if entry.lack():
            print(f"{entry.path.name}: skipped: {entry.lack()}")
            continue
        try:
            picture = run(entry) / entry.picture
            pixels = found[entry.path.name] = picture_hash.of_file(picture)
        except (OSError, ValueError, subprocess.CalledProcessError) as error:
            print(f"{entry.path.name}: {error}")
            failed += 1
            continue
        if pixels != entry.hash and not update:
            print(f"{entry.path.name}: pixels {pixels}, expected {entry.hash}: {picture}")
            failed += 1
    if update:
        write_hashes(found)
    print(f"{len(found)} scripts ran, {failed} failed")
    return 1 if failed or not found else 0


def notebook(entry):
    """The script as a Jupyter notebook of format 4: a cell of text, a cell of code that shows the picture at its end."""
    models = 'import os\n\nos.environ.setdefault("HALFLIT_EXAMPLES", ".")\n\n' if "HALFLIT_EXAMPLES" in entry.code else ""
    code = f"{models}{entry.code}\nfrom IPython.display import Image\nImage({entry.picture!r})\n"
    cells = [
        {"cell_type": "markdown", "id": "text", "metadata": {}, "source": f"# {entry.title}\n{entry.sentence}"},
        {"cell_type": "code", "id": "code", "metadata": {}, "execution_count": None, "outputs": [], "source": code},
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    return json.dumps({"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}, indent=1)


def page(entry, picture, printed):
    """The page of a script, in Markdown."""
    parts = [f"# {entry.title}", entry.sentence, f"![{entry.title}]({picture})", f"```{LANGUAGES[entry.kind]}\n{entry.code}```"]
    if printed:
        parts += ["It prints:", f"```\n{printed}\n```"]
    if entry.kind == "py":
        parts.append(f"[As a notebook]({entry.page}.ipynb)")
    return "\n\n".join([*parts, "[All pages](index.md)"]) + "\n"


def pages(output):
    output.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE.parent / "knot.glb", output)  # for the notebooks
    index, section, lacks = ["# Gallery"], "", {kind: lack(kind) for kind in LANGUAGES}
    for entry in read_table():
        own_test = entry.hash == NO_HASH
        missing = "" if own_test else lacks[entry.kind] or entry.lack()
        if missing:
            print(f"{entry.path.name}: left out: {missing}")
            continue
        folder = HERE if own_test else run(entry)
        printed = "" if own_test else "\n".join((folder / OUTPUT).read_text(encoding="utf-8").splitlines()[:MOST_LINES])
        picture = entry.page + pathlib.Path(entry.picture).suffix
        shutil.copy(folder / entry.picture, output / picture)
        (output / f"{entry.page}.md").write_text(page(entry, picture, printed))
        if entry.kind == "py":
            (output / f"{entry.page}.ipynb").write_text(notebook(entry))
        if entry.section != section:
            section = entry.section
            index.append(f"## {section}")
        image = f'<a href="{entry.page}.md"><img src="{picture}" width="240" alt="{entry.title}"></a>'
        index.append(f"{image}<br>[{entry.title}]({entry.page}.md) ({entry.kind}): {entry.sentence}")
    (output / "index.md").write_text("\n\n".join(index) + "\n")
    print(output / "index.md")


def main():
    arguments = sys.argv[1:]
    if len(arguments) == 2 and arguments[0] == "pages":
        pages(pathlib.Path(arguments[1]))
    elif len(arguments) > 1 and arguments[0] in ("check", "update") and set(arguments[1:]) <= set(LANGUAGES):
        for kind in arguments[1:]:
            if lack(kind):
                print(f"skipped: {lack(kind)}")
                sys.exit(77)
        sys.exit(check(arguments[1:], arguments[0] == "update"))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
