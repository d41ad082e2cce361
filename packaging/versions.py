#!/usr/bin/env python3
"""Prints the project's version. Fails where a file has another version or epoch.   versions.py ROOT"""
import os
import re
import sys


def found(root, path, pattern):
    """The groups of the first match of the pattern in a file, joined by points."""
    with open(os.path.join(root, path), encoding="utf-8") as file:
        match = re.search(pattern, file.read(), re.M | re.S)
    if not match:
        sys.exit(f"{path}: expected {pattern}, found nothing like it")
    return ".".join(match.groups())


def pixel_epoch(root):
    return found(root, "sh/include/halflit/version.hpp", r"kPixelEpoch = (\d+);")


def version(root):
    return found(root, "CMakeLists.txt", r"^project\(halflit VERSION ([\d.]+)")


def main(root):
    header = r"HALFLIT_VERSION_MAJOR (\d+).*HALFLIT_VERSION_MINOR (\d+).*HALFLIT_VERSION_PATCH (\d+)"
    expected = version(root)
    places = {
        "sh/include/halflit/version.hpp": header,
        "apps/python/halflit/_c.py": r'^VERSION = "([^"]+)"',
        "CHANGELOG.md": r"^## ([\d.]+) ",
        "packaging/debian/changelog": r"^halflit \(([\d.]+)-\d+\)",
    }
    wrong = [f"{path}: version {value}, expected {expected}" for path, pattern in places.items()
             if (value := found(root, path, pattern)) != expected]
    named = found(root, "CHANGELOG.md", r"^## [\d.]+ \([^)]*pixel_epoch (\d+)")
    if named != pixel_epoch(root):
        wrong.append(f"CHANGELOG.md: pixel_epoch {named}, expected {pixel_epoch(root)}")
    if wrong:
        sys.exit("\n".join(wrong))
    print(expected)


if __name__ == "__main__":
    main(sys.argv[1])
