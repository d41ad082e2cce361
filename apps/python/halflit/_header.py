"""halflit.h as the package reads it. A wheel has it beside this file; a source tree in the folder of the C interface."""
from __future__ import annotations

import os
import re
from typing import Dict, List, Tuple

FOLDER = os.path.dirname(os.path.abspath(__file__))


def header_text() -> str:
    own = os.path.join(FOLDER, "halflit.h")
    path = own if os.path.exists(own) else os.path.join(FOLDER, "..", "..", "c", "include", "halflit", "halflit.h")
    with open(path, encoding="utf-8") as file:
        return file.read()


def declarations(header: str) -> Tuple[Dict[str, str], Dict[str, int], List[str]]:
    """Struct -> its members in C, constant -> number, and the functions."""
    code = re.sub(r"//.*|^#.*", "", header, flags=re.M)
    structs = dict(re.findall(r"typedef struct (\w+) \{(.*?)\} \w+;", code, re.S))
    enumerations = re.findall(r"^enum \{(.*?)\};", code, re.S | re.M)
    constants = {name: int(value) for body in enumerations for name, value in re.findall(r"(\w+) = (\d+)", body)}
    return structs, constants, [" ".join(text.split()) for text in re.findall(r"HALFLIT_C_API ([^;{}]*;)", code)]
