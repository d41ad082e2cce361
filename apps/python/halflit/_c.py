"""The C interface through ctypes: structs, constants, functions and handles.

The library is loaded at the first call, not at import. ctypes releases the interpreter's lock (GIL) during each call, so threads draw
side by side.
"""
from __future__ import annotations

import ctypes
import functools
import os
import re
import signal
import sys
import threading
from typing import Any, Dict, List

from ._errors import CancelledError, UsageError, made
from ._header import declarations, header_text
from ._threads import is_for_main
from ._values import real, shown, whole

VERSION = "0.1.0"  #: of the package, and of the library that it needs

_NUMBERS = {
    "int32_t": ctypes.c_int32,
    "uint32_t": ctypes.c_uint32,
    "uint64_t": ctypes.c_uint64,
    "size_t": ctypes.c_size_t,
    "float": ctypes.c_float,
    "double": ctypes.c_double,
    "char": ctypes.c_char,
}
# The callbacks of halflit_execution that Python may give.
Progress = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double)
Cancelled = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)
_CALLBACKS = {"progress": Progress, "cancelled": Cancelled}
_RESULTS = {"const char*": ctypes.c_char_p, "const void*": ctypes.c_void_p}
Write = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t)


#: Least and largest number of each type of whole numbers.
_RANGES = {
    ctypes.c_int32: (-(2**31), 2**31 - 1),
    ctypes.c_uint32: (0, 2**32 - 1),
    ctypes.c_uint64: (0, 2**64 - 1),
    ctypes.c_size_t: (0, 2 ** (8 * ctypes.sizeof(ctypes.c_size_t)) - 1),
}


def converted(kind: Any, value: Any, name: str) -> Any:
    """The number for a C type, to which ctypes would cut it down in silence. Other types are left to ctypes."""
    if kind in _RANGES:
        return whole(value, name, *_RANGES[kind])
    return real(value, name) if kind in (ctypes.c_float, ctypes.c_double) else value


class Struct(ctypes.Structure):
    """A struct of halflit.h."""

    _kinds: Dict[Any, Any] = {}  # member -> ctypes type

    def __setattr__(self, name: str, value: Any) -> None:
        self.put(name, int(value) if isinstance(value, bool) else value, name)

    def put(self, member: str, value: Any, name: str) -> None:
        """Sets a member to what a caller gives, who may have another name for it; True is no number."""
        super().__setattr__(member, converted(self._kinds.get(member), value, name))


def _groups(pattern: str, text: str) -> Any:
    found = re.match(pattern, text)
    if found is None:
        raise ValueError(f"not a declaration: {text}")
    return found.groups()


def _members(text: str, structs: Dict[Any, Any]) -> List[Any]:
    """The ctypes fields for a struct's members, written in C."""
    fields: List[Any] = []
    for declaration in " ".join(text.split()).strip("; ").split("; "):
        callback = re.match(r"\w+ \(\*(\w+)\)", declaration)
        if callback:
            name = callback.group(1)
            fields.append((name, _CALLBACKS.get(name, ctypes.c_void_p)))
            continue
        kind, names = _groups(r"((?:const )?\w+(?: ?\*(?: ?const\*)?)*) ?([^*]+)$", declaration)
        if kind == "const char*":
            kind = ctypes.c_char_p
        elif "*" in kind:
            kind = ctypes.c_void_p
        else:
            kind = _NUMBERS.get(kind) or structs[kind]
        for name in names.split(","):
            name, _, count = name.strip(" ]").partition("[")
            fields.append((name, kind * int(count) if count else kind))
    return fields


STRUCTS, CONSTANTS, FUNCTIONS = declarations(header_text())
STRUCT: Dict[Any, Any] = {}
for _name, _text in STRUCTS.items():
    STRUCT[_name] = type(_name, (Struct,), {"_fields_": _members(_text, STRUCT)})
    STRUCT[_name]._kinds = dict(STRUCT[_name]._fields_)


@functools.lru_cache(None)
def choices(prefix: str) -> Dict[Any, Any]:
    """Names of an enumeration, such as {"opaque": 0, "mask": 1}, for HALFLIT_<prefix>_OPAQUE and so on. Not to be changed."""
    start = f"HALFLIT_{prefix}_"
    return {name[len(start) :].lower(): value for name, value in CONSTANTS.items() if name.startswith(start)}


def make(name: str, initialised: bool = True) -> Any:
    """A struct of halflit.h by its name without halflit_: its size is set, and its defaults if it has an init function."""
    struct = STRUCT["halflit_" + name]()
    if initialised:
        call(name + "_init", ctypes.byref(struct), ctypes.sizeof(struct))
    else:
        struct.size = ctypes.sizeof(struct)
    return struct


# ---- the library --------------------------------------------------------------------------------------------------------

_loaded = None
_loading = threading.Lock()


def _after_fork() -> None:
    global _loading
    _loading = threading.Lock()  # another thread may have held it


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=_after_fork)


def library_path() -> str:
    """The file that HALFLIT_LIBRARY names, or else the package's own library, or else that of the system."""
    if os.environ.get("HALFLIT_LIBRARY"):
        return os.environ["HALFLIT_LIBRARY"]
    version = VERSION.rpartition(".")[0]
    own, of_system = {
        "win32": ("halflit.dll", "halflit.dll"),
        "darwin": ("libhalflit_python.so", f"libhalflit_c.{version}.dylib"),
    }.get(sys.platform, ("libhalflit_python.so", f"libhalflit_c.so.{version}"))
    packed = os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib", own)
    return packed if os.path.exists(packed) else of_system


def _load() -> Any:
    global _loaded
    with _loading:
        if _loaded is not None:
            return _loaded
        path = library_path()
        try:
            library = ctypes.CDLL(path)
        except OSError as error:
            raise ImportError(f"halflit: cannot load its library: {error}; HALFLIT_LIBRARY may name another file") from None
        for declaration in FUNCTIONS:
            result, name, arguments = _groups(r"(.*?)(\w+)\((.*)\);", declaration)
            try:
                function = getattr(library, name)
            except AttributeError:
                raise ImportError(f"halflit: {path} has no {name}: it is another version than this package, {VERSION}") from None
            function.restype = _RESULTS.get(result.strip()) or _NUMBERS.get(result.strip())
            declared = [] if arguments == "void" else arguments.split(", ")
            function.argtypes = [_argument(text) for text in declared]
            # Names as in Python, where units are said by the documentation.
            function.names = [re.sub(r"_(deg|s)$", "", text.split()[-1]) for text in declared]
        version = library.halflit_version().decode()
        if version.split(".")[:2] != VERSION.split(".")[:2]:
            raise ImportError(f"halflit: {path} is version {version}, expected {VERSION}")
        _loaded = library
        return library


def _argument(text: str) -> Any:
    if text.startswith("const char* "):
        return ctypes.c_char_p
    if "*" in text or "[" in text:
        return ctypes.c_void_p
    return Write if text.startswith("halflit_write ") else _NUMBERS[text.split()[0]]


def function(name: str) -> Any:
    """A function of halflit.h by its name without halflit_."""
    return getattr(_loaded or _load(), "halflit_" + name)


#: Functions that are given the path of a file -> its place among the arguments.
_PATHS = {"scene_load": 0, "scene_add_file": 1, "scene_load_environment": 1, "write_image": 0}


#: Functions that may take seconds, which Ctrl-C ends. Frames are told by halflit_execution.
_LONG = frozenset((
    "scene_load", "scene_load_memory", "scene_load_environment", "scene_set_environment", "scene_add_mesh", "scene_set_mesh", "scene_set_vertices",
    "scene_set_material", "scene_pose", "scene_get_box", "scene_add_file", "scene_add_file_memory", "camera_frame", "camera_views",
    "choose_picture", "call",
))  # fmt: skip

def stops_at_interrupt() -> bool:
    """Ctrl-C ends a call of this thread: Python's own handler of it is in place, and runs as soon as the library returns."""
    return is_for_main() and signal.getsignal(signal.SIGINT) is signal.default_int_handler


def _let_handlers_run(code: int) -> None:
    """After Ctrl-C, Python's handler raises KeyboardInterrupt. Python 3.13 does not run it by itself where a thread forked the process."""
    if code == CancelledError.code and stops_at_interrupt() and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.get_ident(), 0)  # no signal; it runs the handlers of those that are there


def call(name: str, *arguments: Any) -> None:
    """Calls a function that returns a code, and raises what it tells."""
    called = function(name)
    given = map(converted, called.argtypes, arguments, called.names)
    if name in _LONG and stops_at_interrupt():
        stop = function("stop_at_interrupt")
        try:
            stop(1)
            code = called(*given)
        finally:
            stop(0)
    else:
        code = called(*given)
    if code:
        _let_handlers_run(code)
        path = arguments[_PATHS[name]] if name in _PATHS else None
        raise made(code, _told(function("last_error")().decode("utf-8", "replace")), path)


#: Names of halflit.h in messages -> keywords.
_KEYWORDS = {"max_error_codes": "max_error", "azimuth_deg": "azimuth", "elevation_deg": "elevation", "fov_y_deg": "fov", "studio_turn_rad": "studio_turn", "time_s": "time"}


def _told(text: str) -> str:
    """A message of the library without the struct that it begins with, which Python's callers do not see; a function has its short name."""
    found = re.match(r"(halflit_\w+): (isa: )?", text)
    if found is None:
        return text
    rest = text[found.end() :] if found.group(1) in STRUCT else re.sub("^halflit_(scene_)?", "", text)
    return re.sub("|".join(_KEYWORDS), lambda name: _KEYWORDS[name.group()], rest)


class Handle:
    """A scene or a renderer of the library. It is destroyed with its last reference; a running frame holds one."""

    _destroy = None

    def __init__(self, create: str, destroy: str, *arguments: Any) -> None:
        pointer = ctypes.c_void_p()
        call(create, *arguments, ctypes.byref(pointer))
        self._as_parameter_ = pointer
        self._destroy = function(destroy)

    def __del__(self) -> None:
        if self._destroy is not None:
            self._destroy(self._as_parameter_)


def text_of(value: Any) -> str:
    return (value or b"").decode("utf-8", "replace")


def required(value: Any, name: str) -> Any:
    """The same; None is no text."""
    if value is None:
        raise UsageError(f"{name}: expected a text or a path, found None")
    return bytes_of(value, name)


def bytes_of(value: Any, name: str) -> bytes | None:
    """A text, or a path, as the library takes it. None stays."""
    if value is None:
        return None
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise UsageError(f"{name}: expected a text or a path, found {shown(value)}")
    try:
        text = os.fsencode(value)
    except UnicodeEncodeError:  # half of a pair of surrogates
        raise UsageError(f"{name}: expected a text of Unicode's characters, found {ascii(value)}") from None
    if b"\0" in text:  # C would read up to it
        raise UsageError(f"{name}: expected a text or a path without NUL, found {value!r}")
    return text
