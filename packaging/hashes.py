#!/usr/bin/env python3
"""Prints hashes.txt of a release: hashes of pixels that anybody can draw again.   hashes.py ROOT"""
import os
import re
import sys

import versions


def text_of(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def self_test_rows(root):
    """(hash, command) of each scene of halflit --self-test."""
    text = text_of(root, "apps/halflit/golden/self_test_scenes.def")
    rows = re.findall(r'^HALFLIT_SELF_TEST\("[^"]*", "([^"]*)",\s*"([^"]*)",\s*0x([0-9a-f]{16})\)', text, re.M)
    if len(rows) != text.count("HALFLIT_SELF_TEST("):
        sys.exit("self_test_scenes.def: a row is written in another way than hashes.py reads")
    return [(digits, f"halflit render {scene} {flags}") for scene, flags, digits in rows]


def golden_rows(root):
    """(hash, linear hash, scene/variant) of each golden scene."""
    lines = [line.split() for line in text_of(root, "tests/golden/hashes.txt").splitlines() if not line.startswith("#")]
    return [(codes.zfill(16), linear.zfill(16), name) for name, codes, linear in lines]


def main(root):
    print(f"# halflit {versions.version(root)}, pixel_epoch {versions.pixel_epoch(root)}: hashes of pixels. The same on every processor,")
    print("# system, compiler and number of threads.")
    print("#\n# Pictures of the program: the hash of the 8-bit codes, and the command. The report has the hash as pixel_hash")
    print("# (--report -), and halflit --self-test compares them all.")
    for digits, command in self_test_rows(root):
        print(f"{digits}  {command}")
    print("#\n# Golden scenes of the source, 160x90: the hash of the 8-bit codes, that of the linear light, scene and variant.")
    print("# The program halflit_golden_tests compares them.")
    for row in golden_rows(root):
        print("  ".join(row))


if __name__ == "__main__":
    main(sys.argv[1])
