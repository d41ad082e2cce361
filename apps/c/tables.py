#!/usr/bin/env python3
"""Writes what halflit.h, Python and docs/formats.md say of the members that tables list: the rows of the tables have names, ranges and
places, the structs of the C++ headers have types, defaults and documentation. Run it after a change to one of them:

    apps/c/tables.py            writes the files
    apps/c/tables.py --check    writes nothing; exit code 1 if one of them would change
"""
import os
import re
import sys
import textwrap
from typing import NamedTuple

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HEADERS = "shading/include/halflit/", "raster/include/halflit/"
C = "apps/c/include/halflit/halflit.h"
PYTHON = "apps/python/halflit/"
MARK = "    # Made by apps/c/tables.py"
C_TYPES = {"double": "double {}", "std::size_t": "uint64_t {}", "float": "float {}", "Vec3f": "float {}[3]", "Vec4f": "float {}[4]",
           "TextureUse": "halflit_texture_use {}"}  # all others: int32_t
PYTHON_TYPES = {"float": "float", "double": "float", "bool": "bool", "TextureUse": "Union[TextureUse, int]"}  # all others: int
NUMBERS = {"kMostScale": "math.inf", "kMostNumber": "math.inf", "kEndless": "math.inf", "kPi": "math.pi"}  # of ranges, in Python


class Member(NamedTuple):
    """One row of a table."""

    name: str
    c: str  # its declaration
    kind: str = ""  # in C++; empty: in the C struct alone
    default: str = ""
    doc: str = ""
    low: str = ""
    high: str = ""
    having: str = ""  # of lights: those that have it
    color: bool = False
    choices: tuple = ()  # of an enumeration
    usual: str = ""  # default of Python's pictures


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


# ---- what is read -------------------------------------------------------------------------------------------------------


def rows(path):
    """(macro, arguments) of each row of a table."""
    table = re.sub(r"^(//|#).*", "", text_of(path), flags=re.M)
    while table.strip():
        macro, _, table = table.lstrip().partition("(")
        arguments, depth = [""], 0
        for token in re.findall(r'"[^"]*"|.', table, re.S):
            table = table[len(token) :]
            depth += (token == "(") - (token == ")")
            if depth < 0:
                break
            if token == "," and depth == 0:
                arguments.append("")
            else:
                arguments[-1] += token
        arguments = [argument.strip() for argument in arguments]
        yield macro, [re.sub(r'"\s*"', "", text).strip('"') if text.startswith('"') else text for text in arguments]


def in_headers(pattern):
    """What a C++ header has for the pattern's group."""
    for path in (os.path.join(folder, name) for folder in HEADERS for name in sorted(os.listdir(os.path.join(ROOT, folder)))):
        found = re.search(pattern, text_of(path), re.M | re.S)
        if found:
            return found[1]
    return sys.exit(f"tables.py: no C++ header has {pattern}")


def declared(struct):
    """Member of a struct, or value of an enumeration -> (type, default, documentation, which stands above or behind it)."""
    found, above = {}, ""
    for line in in_headers(rf"^(?:struct|enum class) {struct}(?: : [\w:]+)? \{{\n(.*?)^\}};").splitlines():
        code, _, behind = line.partition("///")
        declaration = re.match(r" {4}([\w:<>]+ )?(\w+)(?: = ([^;]*)|\{(.*)\})?[;,]? *$", code)
        if declaration:
            kind, name, default, braced = declaration.groups("")
            found[name] = (kind.strip(), default or braced, (above or behind.removeprefix("<")).strip())
        above = "" if code.strip() else above + behind
    return found


def value_text(value, choices=()):
    """A default of C++ as documentation has it."""
    if re.fullmatch(r"k[A-Z]\w+", value):
        value = in_headers(rf"^inline constexpr \w+ {value} = (\S+);")
    if choices:
        return value.split("::")[-1].replace("automatic", "auto")  # which no enumerator of C++ may be
    value = re.sub(r"std::size_t\{(\d+)\} << 20", r"\1 MiB", value)
    value = re.sub(r"\.0\b", "", re.sub(r"(?<=\d)f\b", "", value)).replace(" / ", "/")
    return "pi / 4" if value == "0.785398163" else value


def member(name, given, struct_members, **more):
    """A member that C++ has by the name `given`."""
    if given not in struct_members or not struct_members[given][2]:
        sys.exit(f"tables.py: no header documents {given}")
    kind, default, doc = struct_members[given]
    return Member(name, C_TYPES.get(kind, "int32_t {}").format(name), kind, value_text(default, more.get("choices")), doc, **more)


def only_in_c(declaration, doc):
    return Member(re.search(r"(\w+)(\[\d+\])?$", declaration)[1], declaration, doc=doc)


def materials():
    numbers, slots = declared("Material"), declared("TextureSlot")
    for macro, arguments in rows("shading/material_properties.def"):
        name = arguments[0]
        if macro == "HALFLIT_NUMBER":
            yield member(name, name, numbers, low=arguments[1], high=arguments[2], color=True)
        elif macro == "HALFLIT_TEXTURE":
            yield member(name + "_texture", name, {name: ("TextureUse", "", slots[name][2])})
        else:
            yield only_in_c(*arguments)


def lights():
    for macro, arguments in rows("shading/light_members.def"):
        if macro == "HALFLIT_LIGHT":
            given, name, having, quantity, low, high = arguments
            yield member(name, given, declared("Light"), low=low, high=high, having=having, color=quantity == "color")
        else:
            yield only_in_c(*arguments)


def cameras():
    for macro, arguments in rows("raster/camera_members.def"):
        if macro == "HALFLIT_CAMERA":
            yield member(arguments[0], arguments[0], declared("Camera"), low=arguments[2], high=arguments[3])
        else:
            yield only_in_c(*arguments)


def settings():
    table = list(rows("raster/settings_table.def"))
    usual = {arguments[0]: arguments[1] for macro, arguments in table if macro == "HALFLIT_USUAL"}
    places = {**declared("Settings"), **{"shading." + name: found for name, found in declared("ShadingSettings").items()}}
    names = dict(re.findall(r"^inline constexpr std::string_view (k\w+)\[\] = \{(.*)\};", text_of("raster/settings_table.hpp"), re.M))
    for macro, arguments in table:
        if macro == "HALFLIT_SETTING":
            place, name, values = arguments[:3]
            array = re.match(r"named\((\w+)\)", values)
            choices = tuple(re.findall(r'"([^"]*)"', names[array[1]])) if array else ()
            yield member(name, place, places, choices=choices, usual=value_text(usual.get(place, places[place][1]), choices))
        elif macro == "HALFLIT_C":
            yield only_in_c(*arguments)


def enumeration(choices):
    """TONE of HALFLIT_TONE_NONE, HALFLIT_TONE_REINHARD and so on: the enumeration of halflit.h that has these values."""
    wanted = [choice.upper().replace("-", "_") for choice in choices]
    for body in re.findall(r"^enum \{([^}]*)\};", text_of(C), re.M):
        found = re.findall(r"HALFLIT_(\w+) = \d+", body)
        prefix = found[0].removesuffix(wanted[0])
        if found == [prefix + value for value in wanted]:
            return prefix.rstrip("_")
    sys.exit(f"tables.py: {C} has no enumeration of {', '.join(wanted)}")


# ---- what is written ----------------------------------------------------------------------------------------------------


def c_members(members):
    lines = []
    for one in members:
        doc, default = one.doc, one.default
        if one.choices:
            doc, default = f"HALFLIT_{enumeration(one.choices)}: {doc}", default.replace("_", "-")
        default = {"true": "1", "false": "0"}.get(default, default)
        mark = " " * 4 + "/// "
        lines += textwrap.wrap(doc + (f" ({default})" if default else ""), 132, initial_indent=mark, subsequent_indent=mark)
        lines.append(f"    {one.c};")
    return lines


def python_choices(one):
    return ", ".join('"' + choice.replace("-", "_") + '"' for choice in one.choices)


def python_type(one):
    if one.kind.startswith("Vec"):
        return "Color" if one.color else "Point"
    return f"Literal[{python_choices(one)}]" if one.choices else PYTHON_TYPES.get(one.kind, "int")


def annotations(members):
    return [f"    {one.name}: {python_type(one)}" for one in members if one.kind]


def documentation(members, shown=""):
    """Entries of members. shown: the documentation around them, which may have some by hand."""
    lines = []
    for one in members:
        if one.kind and not re.search(rf"^ {{8}}{one.name}: ", shown, re.M):
            default = {"true": "True", "false": "False"}.get(one.usual or one.default, one.usual or one.default)
            doc = one.doc.replace("soft-split", "soft_split")
            text = f"{one.name}: " + (f"{doc.rstrip('.')}: {python_choices(one)}" if one.choices else doc) + (f" ({default})" if default else "")
            lines += textwrap.wrap(text, 132, initial_indent=" " * 8, subsequent_indent=" " * 12)
    return lines


def number_text(text):
    made = re.sub(r"k[A-Z]\w+", lambda found: NUMBERS[found[0]], text)
    return made + ".0" if re.fullmatch(r"-?\d+", made) else made


def ranges(members):
    """Tables of a Record: largest numbers of colours, and ranges of numbers that have one."""
    colors, numbers = [], []
    for one in members:
        high = number_text(one.high)
        if one.color and one.kind.startswith("Vec"):
            colors.append(f'        "{one.name}": {"None" if one.high == "kMostNumber" else high},')
        elif one.kind == "float" and not one.low.startswith("-k"):
            numbers.append(f'        "{one.name}": ({number_text(one.low)}, {high}),')
    made = ["    _colors: Dict[str, Optional[float]] = {", *colors, "    }"] if colors else []
    return [*made, "    _ranges = {", *numbers, "    }"]


def between(text, begin, end, lines):
    """Replaces what lies between the line that begins with `begin` and the next line that begins with `end`."""
    start = text.index("\n", text.index("\n" + begin) + 1) + 1
    stop = text.index("\n" + end, start - 1) + 1 if end else len(text)
    return text[:start] + "".join(line + "\n" for line in lines) + text[stop:]


def header(setting, material, light, camera):
    text, wide = text_of(C), [one for one in setting if one.kind in ("double", "std::size_t")]
    for table, members, end in (
        ("shading/material_properties.def", material, "} halflit_material;"),
        ("shading/light_members.def", light, "} halflit_light;"),
        ("raster/camera_members.def", camera, "} halflit_camera;"),
        ("raster/settings_table.def: eight", wide, "    halflit_region"),
        ("raster/settings_table.def: four", [one for one in setting if one not in wide], "} halflit_settings;"),
    ):
        text = between(text, "    // Made by apps/c/tables.py of " + table, end, c_members(members))
    return text


def python_class(name, last, members):
    """The file of a class. last: the last member that its documentation has by hand."""
    text = text_of(f"{PYTHON}_{name}.py")
    start = text.index(f"\nclass {name.title()}(Record)")
    head, body = text[:start], between(text[start:], f"        {last}:", '    """', [])
    body = between(body, f"        {last}:", '    """', documentation(members, body.split('    """', 2)[1]))
    having = [f'        "{one.name}": "{one.having}",' for one in members if one.having not in ("", "any")]
    lines = [*(["    _having = {", *having, "    }"] if having else []), *ranges(members), *annotations(members)]
    return head + between(body, MARK, "    # Other members.", lines)


def python_dicts(material, light, camera):
    text = text_of(PYTHON + "_members.py")
    for name, end, members in (("light", "\n", light), ("camera", "\n", camera), ("material", "", material)):
        lines = [line.replace(PYTHON_TYPES["TextureUse"], "TextureOf") for line in annotations(members)]
        text = between(text, f"{MARK}: {name}", end, lines)
    return text


def python_keywords(setting):
    """The types and documentation of keywords, and the table that finds their settings."""
    options, table = text_of(PYTHON + "_picture_options.py"), text_of(PYTHON + "_options.py")
    chosen = re.findall(r"^    (\w+): ", options.split("class PictureOptions", 1)[0], re.M)  # by other keywords
    setting = [one for one in setting if one.kind and one.name not in chosen]
    keywords = [one._replace(name=one.name.removesuffix("_codes")) for one in setting]
    options = between(options, "    Settings:", "\n", documentation(keywords))
    kinds = [enumeration(one.choices) if one.choices else python_type(one) for one in setting]
    rows = [f'    "{keyword.name}": ("{one.name}", "{kind}"),' for one, keyword, kind in zip(setting, keywords, kinds)]
    return between(options, MARK, "    # How it is computed.", annotations(keywords)), between(table, "SETTINGS: Dict", "}", rows)


def formats():
    """The page of formats, with the extensions of the table in its row of materials."""
    text = text_of("docs/formats.md")
    row = re.search(r"^\| materials \| (.*) \|$", text, re.M)
    listed = set(row[1].split(", ")) | set(re.findall(r"extensions/(\w+)/", text_of("shading/material_properties.def")))
    return text[: row.start(1)] + ", ".join(sorted(listed)) + text[row.end(1) :]


def made():
    """Path -> text, of all files that are written."""
    material, light, camera, setting = list(materials()), list(lights()), list(cameras()), list(settings())
    options, table = python_keywords(setting)
    return {
        C: header(setting, material, light, camera),
        PYTHON + "_material.py": python_class("material", "metallic", material),
        PYTHON + "_light.py": python_class("light", "type", light),
        PYTHON + "_camera.py": python_class("camera", "far_z", camera),
        PYTHON + "_members.py": python_dicts(material, light, camera),
        PYTHON + "_picture_options.py": options,
        PYTHON + "_options.py": table,
        "docs/formats.md": formats(),
    }


def main():
    stale = {path: text for path, text in made().items() if text != text_of(path)}
    for path, text in stale.items():
        if "--check" in sys.argv[1:]:
            print(f"{path} is stale: run apps/c/tables.py", file=sys.stderr)
            continue
        with open(os.path.join(ROOT, path), "w", encoding="utf-8") as file:
            file.write(text)
    sys.exit(1 if stale and "--check" in sys.argv[1:] else 0)


if __name__ == "__main__":
    main()
