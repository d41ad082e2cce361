"""How a file is given, and how it is read."""
from __future__ import annotations

import ctypes
import functools
import os
from typing import TYPE_CHECKING, Any, BinaryIO, Dict, Tuple, Union

from . import _c
from ._errors import UsageError
from ._values import finite, truth, up_axis

Source = Union[str, "os.PathLike[Any]", bytes, bytearray, memoryview, BinaryIO]
#: Members of halflit_load_options that are truths, and those that callers do not set by their names.
_TRUTHS = ("strict", "recentre", "keep_animations")
_HIDDEN = ("size", "reserved", "allow_external_count", "importers_count", "time_s")

if TYPE_CHECKING:
    made_or_added = classmethod
else:

    class made_or_added:
        """Scene.load: of the class it makes a scene, of a scene it adds to it."""

        def __init__(self, function: Any) -> None:
            self.function = function
            self.__doc__ = function.__doc__

        def __get__(self, scene: Any, kind: Any) -> Any:
            if scene is None:
                return self.function.__get__(kind)

            @functools.wraps(self.function)
            def add(source: Any, **options: Any) -> Any:
                scene.add_file(source, **options)
                return scene

            return add


def loading(source: Any, base_dir: Any, options: Dict[str, Any]) -> Tuple[str, Tuple[Any, ...]]:
    """The function, add_file or add_file_memory, and its arguments up to the halflit_load_options."""
    how = load_options(options)
    read, name = getattr(source, "read", None), "bytes"
    if read is not None:
        named = getattr(source, "name", None)
        name = named if isinstance(named, str) else "file"
        try:
            source = read()
        except UnicodeDecodeError:  # it reads text
            source = ""
        if not isinstance(source, bytes):
            raise UsageError(f"source: expected a file that is open in binary mode, found one that reads {type(source).__name__}")
    if isinstance(source, (bytes, bytearray, memoryview)):
        data = bytes(source)
        return "add_file_memory", (data, len(data), os.fsencode(name), _c.bytes_of(base_dir, "base_dir"), ctypes.byref(how))
    return "add_file", (_c.required(source, "source"), ctypes.byref(how))


def sum_of(source: Union[str, bytes]) -> int:
    """A check sum of the bytes, or of the file that is named so."""
    import zlib  # importing halflit loads little
    if isinstance(source, bytes):
        return zlib.crc32(source)
    found = 0
    with open(source, "rb") as file:
        while part := file.read(1 << 20):
            found = zlib.crc32(part, found)
    return found


def load_options(options: Dict[str, Any]) -> Any:
    """The halflit_load_options."""
    how = _c.make("load_options")
    for name, value in options.items():
        if name == "time":
            how.time_s = finite(value, name)
        elif name not in how._kinds or name in _HIDDEN:
            raise TypeError(f"loading has no keyword {name!r}")
        elif name in ("allow_external", "importers"):
            texts = [value] if isinstance(value, (str, bytes, os.PathLike)) else value  # a text is not a list of letters
            names = [_c.bytes_of(text, name) for text in texts]
            setattr(how, name, ctypes.cast((ctypes.c_char_p * len(names))(*names), ctypes.c_void_p))
            setattr(how, name + "_count", len(names))
            setattr(how, "_names_of_" + name, (names, getattr(how, name)))  # which the struct points to
        elif name in ("animation", "scene", "variant"):
            setattr(how, name, None if value is None else _c.bytes_of(str(value), name))
        elif name == "up":
            how.up = 0 if value is None else up_axis(value)
        else:
            setattr(how, name, truth(value, name) if name in _TRUTHS else value)
    return how
