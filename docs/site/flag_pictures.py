#!/usr/bin/env python3
"""Two pictures for each flag about the picture, off and on, and the page that shows them.

    flag_pictures.py PROGRAM OUTPUT [FLAG...]     OUTPUT/flag_pictures.md, and pictures in OUTPUT/flag_pictures
    flag_pictures.py --check PROGRAM              flags of the program without a pair, and pairs of flags that are gone

flag_pictures.txt has the pairs. A pair whose two pictures have the same pixels is an error.
"""
import concurrent.futures
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import small_models

HERE = pathlib.Path(__file__).resolve().parent
SIZE = ["--size", "240x180"]


class Pair:
    """A row of the table. `reason` is set where the flag has no pictures."""

    def __init__(self, group, row):
        self.group = group
        fields = [field.strip() for field in row.split("|")]
        self.flag = fields[0]
        self.name = self.flag.lstrip("-")
        self.reason = fields[1][len("same:") :].strip() if fields[1].startswith("same:") else ""
        if not self.reason:
            if len(fields) != 5:
                sys.exit(f"flag_pictures.txt: {self.flag}: expected 5 fields, found {len(fields)}")
            self.scene, self.both, *self.sides = fields[1:]

    def words(self, side):
        """The words of the command, without program and output."""
        flags = []
        for text in (self.both, self.sides[side]):
            if "--camera-orbit " in text:  # its value has spaces
                flags += text.split(" ", 1)
            else:
                flags += text.split()
        return [self.scene, *flags]

    def command(self, side):
        return "halflit " + shlex.join(self.words(side))

    def file(self, side):
        return f"{self.name}_{('off', 'on')[side]}.png"


def read_table():
    pairs, group = [], ""
    for line in (HERE / "flag_pictures.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            group = line[2:]
        elif line:
            pairs.append(Pair(group, line))
    return pairs


def flags_of(program):
    """(group, flag, help) of each flag of render, from the page that the program prints."""
    page = subprocess.run([program, "flags", "--markdown"], check=True, stdout=subprocess.PIPE).stdout.decode()
    page = page.split("\n## halflit render\n")[1].split("\n## ")[0]
    rows, group = [], ""
    for line in page.splitlines():
        found = re.match(r"\| `(?:-[a-zA-Z], )?(--[a-z-]+)[^`]*` \| (.*) \|$", line)
        if found:
            rows.append((group, *found.groups()))
        elif line and not line.startswith("|"):
            group = re.split(r" ?[(:]", line)[0]
    return rows


def faults(program):
    """Rows that the table lacks, and rows too many."""
    pairs = read_table()
    groups = {pair.group for pair in pairs}
    have, want = [pair.flag for pair in pairs], [flag for group, flag, _ in flags_of(program) if group in groups]
    return ([f"{flag}: has no row in docs/site/flag_pictures.txt" for flag in want if flag not in have]
            + [f"{flag}: has a row in docs/site/flag_pictures.txt, but is no flag of halflit render" for flag in have if flag not in want]
            + [f"{flag}: has several rows in docs/site/flag_pictures.txt" for flag in sorted(set(have)) if have.count(flag) > 1])


def draw(program, pairs, folder):
    """Draws the pictures into the folder. Returns the faults: commands that fail, and pairs of equal pictures."""
    with tempfile.TemporaryDirectory() as models:
        small_models.write_all(models)

        def one(pair, side):
            words = pair.words(side)
            output = folder / pair.file(side)
            size = [] if "--size" in words else SIZE
            command = [program, "render", *words[:1], str(output), *size, *words[1:], "--quiet"]
            done = subprocess.run(command, cwd=models, stderr=subprocess.PIPE, check=False)
            return [] if done.returncode == 0 else [f"{pair.command(side)}: {done.stderr.decode().strip()}"]

        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            found = [fault for result in pool.map(lambda job: one(*job), [(pair, side) for pair in pairs for side in (0, 1)])
                     for fault in result]
    for pair in pairs:
        files = [folder / pair.file(side) for side in (0, 1)]
        if all(file.exists() for file in files) and len({file.read_bytes()[16:24] for file in files}) == 1:  # PNG's width and height
            done = subprocess.run([program, "diff", *files], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
            if done.returncode != 1:  # 1: they differ
                found.append(f"{pair.flag}: its two pictures are equal, or cannot be compared: {done.stderr.decode().strip()}")
    return found


def page_of(program, pairs):
    text = ["# Each flag in pictures", "", "Made by `./dev docs` from `docs/site/flag_pictures.txt`. Left: without the flag, or with its",
            "plainer value. Right: with it. [Flags](flags.md) has all flags with their values.", ""]
    helps = {flag: help_text for _, flag, help_text in flags_of(program)}
    group = ""
    for pair in pairs:
        if pair.group != group:
            group = pair.group
            text += [f"## {group}", ""]
        text += [f"### {pair.flag}", "", helps[pair.flag] + ".", ""]
        if pair.reason:
            text += [f"No pictures: {pair.reason}.", ""]
        else:
            off, on = (f"![{pair.flag}, {word}](flag_pictures/{pair.file(side)})" for side, word in enumerate(("off", "on")))
            text += [f"| `{pair.command(0)}` | `{pair.command(1)}` |", "|---|---|", f"| {off} | {on} |", ""]
    return "\n".join(text)


def make(program, output, only=()):
    """The page and its pictures; returns the number of pictures. Ends the program at faults."""
    pairs, program = read_table(), str(pathlib.Path(program).resolve())
    drawn = [pair for pair in pairs if not pair.reason and (not only or pair.flag in only)]
    folder = pathlib.Path(output).resolve() / "flag_pictures"
    folder.mkdir(parents=True, exist_ok=True)
    found = faults(program) + draw(program, drawn, folder)
    if found:
        sys.exit("\n".join(found))
    (pathlib.Path(output) / "flag_pictures.md").write_text(page_of(program, pairs), encoding="utf-8")
    return 2 * len(drawn)


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--check":
        lines = faults(sys.argv[2])
        print("\n".join(lines), end="\n" if lines else "")
        sys.exit(1 if lines else 0)
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    print(f"{make(sys.argv[1], sys.argv[2], sys.argv[3:])} pictures")
