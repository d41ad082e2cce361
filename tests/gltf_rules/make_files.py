"""Writes one valid and one invalid glTF file for each rule of the tables, and a list of them.
    make_files.py FOLDER
The list has one line for each file, with tabs between: its place, "valid", "seen" or "unseen" (touches the picture or not), the rule, the
words that must be said, and those that may be."""
import os
import sys

import rules_of_data  # noqa: F401: each module adds its rows
import rules_of_files  # noqa: F401
import rules_of_geometry  # noqa: F401
import rules_of_looks  # noqa: F401
import rules_of_nodes  # noqa: F401
from table import ROWS, make


def main(folder):
    lines = []
    for number, row in enumerate(ROWS):
        for half, files in zip(("valid", "invalid"), make(row)):
            place = os.path.join(folder, "%03d_%s" % (number, half))
            os.makedirs(place, exist_ok=True)
            for name, data in files.items():
                if not name:
                    name = "model.glb" if data[:4] == b"glTF" else "model.gltf"
                    kind = "valid" if half == "valid" else "unseen" if row.see is None else "seen"
                    words = "" if half == "valid" else row.see or ""
                    lines.append("\t".join([os.path.join(place, name), kind, row.section + ": " + row.name, words, "|".join(row.allowed)]))
                os.makedirs(os.path.dirname(os.path.join(place, name)), exist_ok=True)
                with open(os.path.join(place, name), "wb") as out:
                    out.write(data)
    with open(os.path.join(folder, "list.tsv"), "w", encoding="utf-8") as out:
        out.write("\n".join(lines) + "\n")
    print("%d pairs" % len(ROWS))


if __name__ == "__main__":
    main(sys.argv[1])
