"""Stands for the Python module `mujoco`, which no package of Debian has, over libmujoco 2.2.2 by ctypes.

It offers the parts that programs which draw use: models, data, the abstract scene and the enumerations, with the names and types of the
module, and views of numpy into MuJoCo's own memory. Structs, enumerations and the shapes of arrays are read from the library's headers.
"""
import ctypes
import enum
import os
import re
import sys
import tempfile

import numpy as np

_HEADERS, _LIBRARY = "/usr/include/mujoco", "libmujoco.so.2.2.2"
_NUMBERS = {"int": ctypes.c_int, "float": ctypes.c_float, "mjtNum": ctypes.c_double, "double": ctypes.c_double, "mjtByte": ctypes.c_ubyte,
            "char": ctypes.c_char, "unsigned": ctypes.c_uint, "size_t": ctypes.c_size_t, "void": None}  # fmt: skip


def _text(name):
    with open(os.path.join(_HEADERS, name), encoding="utf-8") as file:
        text = re.sub(r"\\\n", " ", file.read())
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


try:
    _library = ctypes.CDLL(_LIBRARY)
    _texts = [_text(name) for name in ("mjmodel.h", "mjdata.h", "mjvisualize.h", "mjrender.h")]
    _macros = _text("mjxmacro.h")
except OSError:
    raise ImportError("no libmujoco") from None

_defined = {}
for _name, _value in re.findall(r"^#define +(mj\w+) +(\S+) *$", "\n".join(_texts), re.M):
    try:
        _defined[_name] = int(_value)
    except ValueError:
        pass

for _body, _name in re.findall(r"typedef enum \w+ *\{(.*?)\} *(\w+);", "\n".join(_texts), re.S):
    _members, _next = {}, 0
    for _entry in filter(None, (entry.strip() for entry in _body.split(","))):
        _key, _, _value = (part.strip() for part in _entry.partition("="))
        _next = eval(_value, dict(_members)) if _value else _next  # such as 1<<3
        _members[_key], _next = _next, _next + 1
    _defined.update(_members)
    globals()[_name] = enum.IntEnum(_name, _members)
_enums = _functions = _render = _structs = sys.modules[__name__]  # as the module's own parts are named


def _fields(body):
    """ctypes fields of a struct's body."""
    fields = []
    for inner, kind, names in re.findall(r"struct *\{(.*?)\} *(\w+) *;|([^;{}]+;)", body, re.S):
        if kind:
            fields.append((kind, type(kind, (ctypes.Structure,), {"_fields_": _fields(inner)})))
            continue
        kind, names = re.match(r"\s*(?:struct |const )?(\w+)\s*(.*?)\s*;", names, re.S).groups()
        for name in names.split(","):
            count = re.findall(r"\[([^\]]+)\]", name)
            base = _types.get(kind, _NUMBERS.get(kind))
            base = ctypes.c_void_p if "*" in names or "(" in name else base if kind in _NUMBERS or kind in _types else ctypes.c_int
            for size in reversed(count):
                base = base * int(eval(size, {}, _defined))
            fields.append((re.search(r"(\w+)\W*$", re.sub(r"\[.*", "", name)).group(1), base))
    return fields


_types = {}
for _name, _body in re.findall(r"^struct (mj\w+)_ *\{(.*?)^\};", "\n".join(_texts), re.S | re.M):
    if "Figure" not in _name and "ui" not in _name.lower():
        _types[_name[:]] = type(_name, (ctypes.Structure,), {"_fields_": _fields(_body)})


def _shapes(macro):
    """Array -> its C type, and how many rows and columns it has, as texts."""
    body = _macros[_macros.index(f"#define {macro} ") :].partition("\n")[0]
    found = re.findall(r"X\( *(\w+), *(\w+), *(\w+), *(.*?) *\)(?= +X|\s*$)", body)
    return {name: (kind, rows, columns) for kind, name, rows, columns in found}


class _View:
    """A struct in MuJoCo's memory, whose members are attributes."""

    def __init__(self, struct, owner=None):
        object.__setattr__(self, "_struct", struct)
        object.__setattr__(self, "_owner", owner)
        object.__setattr__(self, "_views", {})

    def __getattr__(self, name):
        if name in self._views:
            return self._views[name]
        try:
            value = getattr(self._struct, name.rstrip("_"))
        except AttributeError:
            raise AttributeError(name) from None
        if isinstance(value, ctypes.Structure):
            value = _View(value, self)
        elif isinstance(value, ctypes.Array) and value._type_ is not ctypes.c_char:
            if issubclass(value._type_, ctypes.Structure):
                value = tuple(_View(one, self) for one in value)
            else:
                value = np.ctypeslib.as_array(value)
                value = value.reshape(3, 3) if name == "mat" else value
        else:
            return value
        self._views[name] = value
        return value

    def __setattr__(self, name, value):
        if isinstance(value, str):
            value = value.encode()
        setattr(self._struct, name.rstrip("_"), value)


def _call(name, *arguments, result=None):
    function = getattr(_library, name)
    function.restype = result
    return function(*arguments)


def _ref(view):
    return None if view is None else ctypes.byref(view._struct)


def _array_view(kind, address, shape):
    count = int(np.prod(shape))
    if not address or not count:
        return np.zeros(shape, np.ctypeslib.as_array((_NUMBERS[kind] * 1)()).dtype)
    return np.ctypeslib.as_array((_NUMBERS[kind] * count).from_address(address)).reshape(shape)


def _with_arrays(kind, macro, sizes_of):
    """A class whose arrays are properties, which dir() lists."""
    shapes = _shapes(macro)

    def made(name):
        def get(self):
            if name not in self._views:
                kind, rows, columns = shapes[name]
                sizes = sizes_of(self)
                number = [int(eval(text, {"MJ_M": lambda n: n}, _Sizes(sizes))) for text in (rows, columns)]
                self._views[name] = _array_view(kind, getattr(self._struct, name), number if columns != "1" else number[:1])
            return self._views[name]

        return property(get)

    def member(name):
        return property(lambda self: _View.__getattr__(self, name), lambda self, value: _View.__setattr__(self, name, value))

    names = [name for name, _ in _types[kind]._fields_]
    return type(kind, (_View,), {name: made(name) if name in shapes else member(name) for name in names})


class _Sizes(dict):
    """Names in the shapes of arrays."""

    def __init__(self, model):
        super().__init__(_defined)
        self.model = model

    def __missing__(self, name):
        return getattr(self.model._struct, name)


class MjModel(_with_arrays("mjModel", "MJMODEL_POINTERS", lambda model: model)):
    @classmethod
    def from_xml_path(cls, path):
        error = ctypes.create_string_buffer(1000)
        address = _call("mj_loadXML", os.fsencode(path), None, error, len(error), result=ctypes.c_void_p)
        if not address:
            raise ValueError(error.value.decode())
        return cls(_types["mjModel"].from_address(address))

    @classmethod
    def from_xml_string(cls, text):
        with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
            file.write(text)
            file.flush()
            return cls.from_xml_path(file.name)

    def __del__(self):
        _call("mj_deleteModel", _ref(self))


class MjData(_with_arrays("mjData", "MJDATA_POINTERS", lambda data: data._owner)):
    def __init__(self, model):
        address = _call("mj_makeData", _ref(model), result=ctypes.c_void_p)
        super().__init__(_types["mjData"].from_address(address), model)

    def __setattr__(self, name, value):
        setattr(self._struct, name, value)

    def __del__(self):
        _call("mj_deleteData", _ref(self))


class MjvScene(_View):
    def __init__(self, model, maxgeom):
        super().__init__(_types["mjvScene"](), model)
        _call("mjv_defaultScene", _ref(self))
        _call("mjv_makeScene", _ref(model), _ref(self), maxgeom)
        geoms = (_types["mjvGeom"] * maxgeom).from_address(self._struct.geoms)
        self._views["geoms"] = tuple(_View(geom, self) for geom in geoms)
        for name in ("skinvert", "skinnormal"):
            self._views[name] = _array_view("float", getattr(self._struct, name), [3 * model.nskinvert])

    def __del__(self):
        _call("mjv_freeScene", _ref(self))


def _plain(kind):
    def __init__(self):
        _View.__init__(self, _types[f"mjv{kind}"]())
        _call(f"mjv_default{kind}", _ref(self))

    return type(f"Mjv{kind}", (_View,), {"__init__": __init__})


MjvCamera, MjvOption, MjvPerturb = _plain("Camera"), _plain("Option"), _plain("Perturb")


def _of_model_and_data(name):
    return lambda m, d: _call(name, _ref(m), _ref(d))


mj_step, mj_step1, mj_step2 = (_of_model_and_data(name) for name in ("mj_step", "mj_step1", "mj_step2"))
mj_forward, mj_resetData = _of_model_and_data("mj_forward"), _of_model_and_data("mj_resetData")


def mj_name2id(m, type, name):
    return _call("mj_name2id", _ref(m), int(type), name.encode(), result=ctypes.c_int)


def mj_id2name(m, type, id):
    name = _call("mj_id2name", _ref(m), int(type), id, result=ctypes.c_char_p)
    return None if name is None else name.decode()


def mjv_updateScene(m, d, opt, pert, cam, catmask, scn):
    _call("mjv_updateScene", _ref(m), _ref(d), _ref(opt), _ref(pert), _ref(cam), int(catmask), _ref(scn))


def mjv_defaultFreeCamera(m, cam):
    _call("mjv_defaultFreeCamera", _ref(m), _ref(cam))


def mjv_initGeom(geom, type, size, pos, mat, rgba):
    doubles = [(ctypes.c_double * n)(*np.ravel(value)) for value, n in ((size, 3), (pos, 3), (mat, 9))]
    _call("mjv_initGeom", _ref(geom), int(type), *doubles, (ctypes.c_float * 4)(*rgba))


__version__ = "2.2.2"
