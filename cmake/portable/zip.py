#!/usr/bin/env python3
"""Packs a folder: zip.py FOLDER FILE.zip. Names are sorted and dates fixed, so that equal contents make equal files."""
import os
import sys
import zipfile

folder, target = sys.argv[1:]
with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
    for at, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = os.path.join(at, name)
            entry = zipfile.ZipInfo(os.path.relpath(path, os.path.dirname(folder)), (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o100644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            with open(path, "rb") as file:
                archive.writestr(entry, file.read())
