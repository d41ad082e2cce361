#!/usr/bin/env python3
"""Makes halflit/_declarations.py, which has the structs, constants and functions of halflit.h as text.

    declarations.py HALFLIT_H [FILE]      without FILE: to standard output
"""
import re
import sys
import textwrap


def declarations(header):
    """The text of _declarations.py for the text of halflit.h."""
    code = re.sub(r"//[^\n]*", "", header)
    code = re.sub(r"^#.*$", "", code, flags=re.M)
    lines = ['"""Structs, constants and functions of halflit.h. Made by declarations.py."""', "# fmt: off", "STRUCTS = {"]
    for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \w+;", code, re.S):
        lines += [f'    "{name}": """', *wrapped(body), '""",']
    lines += ["}", "CONSTANTS = {"]
    for body in re.findall(r"^enum \{(.*?)\};", code, re.S | re.M):
        lines += [f'    "{name}": {value},' for name, value in re.findall(r"(\w+) = (\d+)", body)]
    lines += ["}", 'FUNCTIONS = """']
    lines += [" ".join(function.split()) for function in re.findall(r"HALFLIT_C_API ([^;{}]*;)", code)]
    return "\n".join(lines) + '\n"""\n'


def wrapped(body):
    return textwrap.wrap(" ".join(body.split()), 130, initial_indent="        ", subsequent_indent="        ")


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        text = declarations(file.read())
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w", encoding="utf-8") as file:
            file.write(text)
    else:
        sys.stdout.write(text)
