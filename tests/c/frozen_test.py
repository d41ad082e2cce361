#!/usr/bin/env python3
"""Checks that halflit.h has all that an earlier version of it had, at the same places: programs built with that one go on working.

    frozen_test.py HALFLIT_H FROZEN_H
    frozen_test.py --freeze HALFLIT_H FROZEN_H      writes FROZEN_H: the header without comments

To be frozen anew with each release, never between two. A struct grows at its end, and may use its reserved members; an enumeration and the
functions may get more.
"""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "apps", "python", "halflit"))
from _header import declarations  # noqa: E402


def parsed(path):
    """(struct -> members, constant -> number, function -> declaration) of a header."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r" *//[^\n]*", "", file.read())
    structs, constants, functions = declarations(text)
    callbacks = {re.search(r"\(\*(\w+)\)", line).group(1): " ".join(line.split()) for line in re.findall(r"typedef [^;{]*\(\*\w+\)[^;]*;", text)}
    callbacks.update((re.search(r"(\w+)\(", line).group(1), line) for line in functions)
    return {name: members(text) for name, text in structs.items()}, constants, callbacks


def members(text):
    """One (type, name) for each member, and each entry of `reserved`."""
    found = []
    for declaration in " ".join(text.split()).strip("; ").split("; "):
        callback = re.match(r"(.* \(\*)(\w+)(\).*)", declaration)
        if callback:
            found.append((callback.group(1) + callback.group(3), callback.group(2)))
            continue
        kind, names = re.match(r"((?:const )?\w+(?: ?\*(?: ?const\*)?)*) ?([^*]+)$", declaration).groups()
        for name in names.split(","):
            name, _, count = name.strip().partition("[")
            if name == "reserved":
                found += [(kind, name)] * int(count.strip("]") or 1)
            else:
                found.append((kind + ("[" + count if count else ""), name))
    return found


def faults(now, then):
    structs, constants, functions = now
    old_structs, old_constants, old_functions = then
    for name, value in old_constants.items():
        if constants.get(name) != value:
            yield f"{name} was {value}, and is {constants.get(name)}"
    for name, text in old_functions.items():
        if functions.get(name) != text:
            yield f"was {text} and is {functions.get(name)}"
    words = {"int32_t", "uint32_t", "float"}  # what may take the place of a reserved member
    for name, old in old_structs.items():
        new = structs.get(name, [])
        for place, (kind, member) in enumerate(old):
            found = new[place] if place < len(new) else ("nothing", "")
            if found != (kind, member) and not (member == "reserved" and found[0] in words):
                yield f"{name}: member {place} was {kind} {member}, and is {' '.join(found)}"
                break
        else:
            if len(new) > len(old) and ("size_t", "size") not in old:
                yield f"{name}: has no size, and got {' '.join(new[len(old)])}"


def main():
    if sys.argv[1] == "--freeze":
        with open(sys.argv[2], encoding="utf-8") as file:
            text = re.sub(r" *//[^\n]*", "", file.read())
        with open(sys.argv[3], "w", encoding="utf-8") as file:
            file.write("// halflit.h of an earlier version, without comments. Made by frozen_test.py.\n" + re.sub(r"\n{2,}", "\n", text).lstrip())
        return 0
    now, then = parsed(sys.argv[1]), parsed(sys.argv[2])
    found = list(faults(now, then))
    for fault in found:
        print(fault)
    print(f"{len(then[0])} structs, {len(then[1])} constants, {len(then[2])} functions: {len(found)} faults")
    return 1 if found or len(then[2]) < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
