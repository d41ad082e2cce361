#!/usr/bin/env python3
"""Writes the members of materials, with their documentation, into halflit.h and Python's Material, from the table of properties
(shading/material_properties.def) and the comments of material.hpp. Run it after a change to either:

    apps/c/material_members.py            writes both files
    apps/c/material_members.py --check    writes nothing; exit code 1 if one of them would change
"""
import os
import re
import sys
import textwrap

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TABLE = "shading/material_properties.def"
SOURCE = "shading/include/halflit/material.hpp"
HEADER = "apps/c/include/halflit/halflit.h"
PYTHON = "apps/python/halflit/_material.py"
UNLIMITED = ("kMostScale", "kMostNumber")


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def comments(source):
    """Member or slot -> (C++ type, default, documentation)."""
    found = {}
    slots = source[source.index("enum class TextureSlot") : source.index("inline constexpr int kTextureSlots")]
    for name, doc in re.findall(r"^    (\w+),? +///< (.*)$", slots, re.M):
        found[name + "_texture"] = ("TextureUse", "", doc)
    members = source[source.index("struct Material {") :]
    for kind, name, default, doc in re.findall(r"^    (float|Vec[34]f) (\w+)(?: = |\{)([^;]*?)\}?; +///< (.*)$", members, re.M):
        found[name] = (kind, default.replace("f", ""), doc)
    return found


def properties():
    """(name, C++ type, default, documentation, least, greatest), numbers first."""
    known, rows, table = comments(text_of(SOURCE)), [], text_of(TABLE)
    for kind, arguments in re.findall(r"^HALFLIT_(NUMBER|TEXTURE)\((.*)\)$", table, re.M):
        name, low, high = arguments.split(", ")[:3]
        name += "_texture" if kind == "TEXTURE" else ""
        if name not in known:
            sys.exit(f"material_members.py: {SOURCE} has no comment of {name}, in one line")
        rows.append((name, *known[name], low, high))
    if len(rows) != len(re.findall(r"^HALFLIT_", table, re.M)):
        sys.exit(f"material_members.py: {TABLE} has a row of more than one line")
    return rows


def c_members():
    kinds = {"float": "float {}", "Vec3f": "float {}[3]", "Vec4f": "float {}[4]", "TextureUse": "halflit_texture_use {}"}
    lines = []
    for name, kind, default, doc, _, _ in properties():
        lines.append(f"    /// {doc}" + (f" ({default})" if default else ""))
        lines.append(f"    {kinds[kind].format(name)};")
    return "\n".join(lines) + "\n"


def python_docs():
    lines = []
    for name, _, default, doc, _, _ in properties():
        text = f"{name}: {doc}" + (f" ({default})" if default else "")
        lines += textwrap.wrap(text, 132, initial_indent=" " * 8, subsequent_indent=" " * 12)
    return "\n".join(lines) + "\n"


def python_ranges():
    colors, ranges = [], []
    for name, kind, _, _, low, high in properties():
        if kind in ("Vec3f", "Vec4f"):
            colors.append(f'        "{name}": {"None" if high == "kMostNumber" else "math.inf" if high in UNLIMITED else float(high)},')
        elif kind == "float" and low.lstrip("-") not in UNLIMITED:
            ranges.append(f'        "{name}": ({float(low)}, {"math.inf" if high in UNLIMITED else float(high)}),')
    return "\n".join(["    _colors = {", *colors, "    }", "    _ranges = {", *ranges, "    }"]) + "\n"


def python_annotations():
    kinds = {"float": "float", "Vec3f": "Color", "Vec4f": "Color", "TextureUse": "Union[TextureUse, int]"}
    return "".join(f"    {name}: {kinds[kind]}\n" for name, kind, *_ in properties())


def between(text, begin, end, made):
    """Replaces what lies between the line `begin` and the next line that begins with `end`."""
    head, rest = text.split(begin + "\n", 1)
    tail = rest[rest.index(end) :]
    return head + begin + "\n" + made + tail


def main():
    header = between(text_of(HEADER), "    // From here on written by apps/c/material_members.py.", "} halflit_material;", c_members())
    python = text_of(PYTHON)
    python = between(python, "        shadow_catcher: invisible but for the shadows on it (False)", '    """', python_docs())
    python = between(python, "    # Ranges and members: written by apps/c/material_members.py.", "    # Other members.", python_ranges() + python_annotations())
    stale = [path for path, text in ((HEADER, header), (PYTHON, python)) if text != text_of(path)]
    if "--check" in sys.argv[1:]:
        for path in stale:
            print(f"{path} is stale: run apps/c/material_members.py", file=sys.stderr)
        sys.exit(1 if stale else 0)
    for path, text in ((HEADER, header), (PYTHON, python)):
        with open(os.path.join(ROOT, path), "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
