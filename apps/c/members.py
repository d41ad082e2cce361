#!/usr/bin/env python3
"""Writes the members of materials and settings, with their documentation, into halflit.h and Python, from the tables
(shading/material_properties.def, raster/settings_table.def) and the comments of the C++ headers; the dicts of members that Python's
type checkers know, from the classes of the package; and what the schema of `explain` and docs/formats.md list of materials. Run it after
a change to one of them:

    apps/c/members.py            writes the files
    apps/c/members.py --check    writes nothing; exit code 1 if one of them would change
"""
import json
import os
import re
import sys
import textwrap

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TABLE = "shading/material_properties.def"
SOURCE = "shading/include/halflit/material.hpp"
HEADER = "apps/c/include/halflit/halflit.h"
PYTHON = "apps/python/halflit/_material.py"
PYTHON_MEMBERS = "apps/python/halflit/_members.py"
FORMATS = "docs/formats.md"
# TypedDict -> class whose members it has, its file, and those that are not in it.
PYTHON_DICTS = {
    "LobeMembers": ("Lobe", PYTHON, ()),
    "TextureUseKeywords": ("TextureUse", PYTHON, ("texture",)),
    "LightKeywords": ("Light", "apps/python/halflit/_light.py", ("type",)),
    "CameraMembers": ("Camera", "apps/python/halflit/_camera.py", ("matrix",)),
    "MaterialMembers": ("Material", PYTHON, ()),
}
# Types of attributes -> what a dict may have in their place.
WIDER = {"Union[TextureUse, int]": "TextureOf", "Union[Lobe, LobeName, Tuple[LobeName, float]]": "LobeOf"}
SETTINGS_TABLE = "raster/settings_table.def"
SETTINGS_SOURCES = ("raster/include/halflit/settings.hpp", "shading/include/halflit/shading.hpp")
USUAL_SETTINGS = "raster/choice/auto_setup.cpp"
PYTHON_SETTINGS = "apps/python/halflit/_picture_options.py"
PYTHON_TABLE = "apps/python/halflit/_options.py"
ENUMERATIONS = {"kAccuracyNames": "ACCURACY", "kRateNames": "RATE", "kTextureDetailNames": "DETAIL", "kSpecularNames": "SPECULAR",
                "kShadowModeNames": "SHADOWS", "kToneCurveNames": "TONE", "kEdgeChoiceNames": "EDGES",
                "kHiddenEdgeNames": "HIDDEN_EDGES", "kAlphaSpaceNames": "ALPHA_SPACE", "kEyeDomeNames": "EDL"}
# Setting -> members behind it that no row of the table has.
BY_HAND = {"edge_width": ["    /// of the lines, linear light, 0 to 1; no light, exposure or tone curve changes it (0, 0, 0)",
                          "    float edge_color[3];"]}
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
    """(name, C++ type, default, documentation, least, greatest), in the table's order."""
    known, rows, table = comments(text_of(SOURCE)), [], text_of(TABLE)
    for kind, arguments in re.findall(r"^HALFLIT_(NUMBER|TEXTURE)\((.*)\)$", table, re.M):
        name, low, high = arguments.split(", ")[:3]
        name += "_texture" if kind == "TEXTURE" else ""
        if name not in known:
            sys.exit(f"members.py: {SOURCE} has no comment of {name}, in one line")
        rows.append((name, *known[name], low, high))
    if len(rows) != len(re.findall(r"^HALFLIT_", table, re.M)):
        sys.exit(f"members.py: {TABLE} has a row of more than one line")
    return rows


def c_members():
    kinds = {"float": "float {}", "Vec3f": "float {}[3]", "Vec4f": "float {}[4]", "TextureUse": "halflit_texture_use {}"}
    lines = []
    for name, kind, default, doc, _, _ in properties():
        lines.append(f"    /// {doc}" + (f" ({default})" if default else ""))
        lines.append(f"    {kinds[kind].format(name)};")
    fixed = 12  # four-byte words before the members
    words = fixed + sum({"float": 1, "Vec3f": 3, "Vec4f": 4, "TextureUse": 13}[kind] for _, kind, *_ in properties())
    return "\n".join([*lines, reserved(words)]) + "\n"


def reserved(words):
    """The last member of a struct that has so many words of four bytes before it: no padding, and always one that a later member may take."""
    return f"    int32_t reserved[{1 + (words + 1) % 2}];  ///< 0"


def python_docs():
    lines = []
    for name, _, default, doc, _, _ in properties():
        if name == "metallic":  # Material.__setattr__
            default = "0; 1 with a metallic_roughness_texture"
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


def python_dict(text, name, left_out):
    """The lines of a TypedDict: annotations and settable properties of a class, in this text of its file."""
    body = re.split(r"^class ", text.split(f"\nclass {name}(Record):\n", 1)[1], maxsplit=1, flags=re.M)[0]
    rows = re.findall(r"^    ([a-z]\w*): (.*)$", re.sub(r'""".*?"""', "", body, flags=re.S), re.M)
    for settable in re.findall(r"^    @(\w+)\.setter$", body, re.M):
        rows.append((settable, re.search(rf"^    def {settable}\(self\) -> (.*):$", body, re.M).group(1)))
    return "".join(f"    {member}: {WIDER.get(kind, kind)}\n" for member, kind in rows if member not in left_out)


def settings():
    """(name, C type, values, C++ default, usual default, documentation)."""
    table, sources = text_of(SETTINGS_TABLE), [text_of(path) for path in SETTINGS_SOURCES]
    constants = dict(re.findall(r"^inline constexpr int (\w+) = (\d+);", sources[0], re.M))
    usual = {
        place: constants.get(value, value)
        for place, value in re.findall(r"^    settings\.((?:shading\.)?\w+) = ([\w:.]+);", text_of(USUAL_SETTINGS), re.M)
    }
    members = {}  # place -> (type, default, documentation)
    for source, struct, prefix in ((sources[0], "struct Settings {", ""), (sources[1], "struct ShadingSettings {", "shading.")):
        body = source[source.index(struct) :]
        body = body[: body.index("\n};")]
        for before, kind, name, default, after in re.findall(
            r"((?:^ +/// .*\n)*)^    ([\w:]+) (\w+) = (.*?);(?: +///< (.*))?$", body, re.M
        ):
            doc = after or " ".join(line.strip(" /") for line in before.splitlines())
            members[prefix + name] = (kind, default, doc)
    kinds = {"int": "int32_t", "bool": "int32_t", "float": "float", "double": "double", "std::size_t": "uint64_t"}
    rows = []
    for place, name, values in re.findall(r"^HALFLIT_SETTING\(([\w.]+), (\w+), ([\w.()\", <-]+?), \"", table, re.M):
        if place not in members or not members[place][2]:
            sys.exit(f"members.py: no comment of {place}")
        kind, default, doc = members[place]
        short = lambda x: re.sub(r"(?<=\d)f$", "", x.split("::")[-1].replace("{256} << 20", "256 MiB")).replace("automatic", "auto")
        default = "256 MiB" if "<< 20" in default else re.sub(r"\.0$", "", short(default))
        if name == "environment_tolerance":
            default = "1/510"
        if default == "kDefaultToneCurve":
            default = "none"
        rows.append((name, kinds.get(kind, "int32_t"), values, default, short(usual.get(place, default)), doc))
    if len(rows) != len(re.findall(r"^HALFLIT_SETTING\(", table, re.M)):
        sys.exit(f"members.py: {SETTINGS_TABLE} has a row that is not understood")
    return rows


def commented(doc, indent):
    """Lines of documentation above a member, no wider than the rest of the code."""
    return textwrap.wrap(doc, 132, initial_indent=" " * indent + "/// ", subsequent_indent=" " * indent + "/// ")


def c_settings(wide):
    """Members of eight bytes, or those of four."""
    lines = []
    for name, kind, values, default, _, doc in settings():
        if (kind in ("double", "uint64_t")) != wide:
            continue
        enumeration = re.search(r"named\((\w+)\)", values)
        of = f"HALFLIT_{ENUMERATIONS[enumeration.group(1)]}: " if enumeration else ""
        default = {"true": "1", "false": "0"}.get(default, default.replace("_", "-") if enumeration else default)
        lines += commented(f"{of}{doc} ({default})", 4)
        lines.append(f"    {kind} {name};")
        if name in BY_HAND:
            lines += BY_HAND[name]
    return "\n".join(lines) + "\n"


def names_of(array):
    names = re.search(array + r"\[\] = \{([^}]*)\}", text_of("raster/settings_table.hpp")).group(1)
    return re.findall(r'"([^"]*)"', names.replace("-", "_"))


def python_settings():
    """Documentation, annotations, and the table by which keywords are read."""
    docs, annotations, table = [], [], []
    for name, kind, values, _, usual, doc in settings():
        if name == "exposure":
            continue
        keyword = name.replace("_codes", "")
        enumeration = re.search(r"named\((\w+)\)", values)
        truth = values.startswith("truth")
        usual = {"true": "True", "false": "False", "reference": "reference"}.get(usual, usual)
        doc = doc.replace("soft-split", "soft_split")
        if enumeration:
            doc += ": " + ", ".join(f'"{x}"' for x in names_of(enumeration.group(1)))
        docs += textwrap.wrap(f"{keyword}: {doc} ({usual})", 132, initial_indent=" " * 8, subsequent_indent=" " * 12)
        names = names_of(enumeration.group(1)) if enumeration else []
        number = "bool" if truth else "float" if kind in ("float", "double") else "int"
        kind = f"Literal[{', '.join(map(json.dumps, names))}]" if enumeration else number
        annotations.append(f"    {keyword}: {kind}")
        table.append(f'    "{keyword}": ("{name}", "{ENUMERATIONS[enumeration.group(1)] if enumeration else kind}"),')
    join = lambda lines: "\n".join(lines) + "\n"
    return join(docs), join(annotations), join(table)


def formats_page(text):
    """The page of formats, with the extensions of the table in its row of materials."""
    row = re.search(r"^\| materials \| (.*) \|$", text, re.M)
    listed = set(row.group(1).split(", ")) | set(re.findall(r"extensions/(\w+)/", text_of(TABLE)))
    return text[: row.start(1)] + ", ".join(sorted(listed)) + text[row.end(1) :]


def between(text, begin, end, made):
    """Replaces what lies between the line `begin` and the next line that begins with `end`."""
    head, rest = text.split(begin + "\n", 1)
    tail = rest[rest.index(end) :]
    return head + begin + "\n" + made + tail


def made():
    """Path -> text, of all files that are written."""
    header = between(text_of(HEADER), "    // From here on written by apps/c/members.py.", "} halflit_material;", c_members())
    header = between(header, "    // Settings of eight bytes: written by apps/c/members.py.", "    halflit_region region;", c_settings(True))
    narrow = c_settings(False)
    fixed = 13  # four-byte words between the settings of eight and those of four bytes
    words = sum(int(count or 1) for count in re.findall(r" \w+(?:\[(\d+)\])?;$", narrow, re.M))
    narrow += reserved(fixed + words) + "\n"
    header = between(header, "    // Settings of four bytes: written by apps/c/members.py.", "} halflit_settings;", narrow)
    python = between(text_of(PYTHON), "        shadow_catcher: invisible but for the shadows on it (False)", '    """', python_docs())
    python = between(python, "    # Ranges and members: written by apps/c/members.py.", "    # Other members.", python_ranges() + python_annotations())
    docs, annotations, table = python_settings()
    options = between(text_of(PYTHON_SETTINGS), "    Settings:", "\n    How it is computed", docs)
    options = between(options, "    # Settings: written by apps/c/members.py.", "    # How it is computed.", annotations)
    keywords = between(text_of(PYTHON_TABLE), "SETTINGS: Dict[str, Tuple[str, str]] = {", "}", table)
    members = text_of(PYTHON_MEMBERS)
    for name, (kind, path, left_out) in PYTHON_DICTS.items():
        lines = python_dict(python if path == PYTHON else text_of(path), kind, left_out)
        members = re.sub(rf'(^class {name}\(.*?""".*?"""\n\n).*?(?=^\n|\Z)', lambda found: found.group(1) + lines, members, flags=re.S | re.M)
    return {HEADER: header, PYTHON: python, PYTHON_MEMBERS: members, PYTHON_SETTINGS: options, PYTHON_TABLE: keywords,
            FORMATS: formats_page(text_of(FORMATS))}


def main():
    stale = {path: text for path, text in made().items() if text != text_of(path)}
    for path, text in stale.items():
        if "--check" in sys.argv[1:]:
            print(f"{path} is stale: run apps/c/members.py", file=sys.stderr)
            continue
        with open(os.path.join(ROOT, path), "w", encoding="utf-8") as file:
            file.write(text)
    sys.exit(1 if stale and "--check" in sys.argv[1:] else 0)


if __name__ == "__main__":
    main()
