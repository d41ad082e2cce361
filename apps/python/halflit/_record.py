"""Structs of halflit.h as objects whose members are attributes.

A member that is an enumeration has the names of its values ("blend"), a colour or a point is a tuple, truth is a bool.
"""
from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, Any, Dict, FrozenSet, List, Optional, Tuple, Type, TypeVar

from . import _c
from ._color import color
from ._errors import UsageError
from ._values import reals, shown, truth


R = TypeVar("R", bound="Record")


class Record:
    """Base of the classes with members: keywords of the constructor and attributes are the members of the struct, with its defaults."""

    _kind = ""  # name of the struct without halflit_
    _truths: FrozenSet[str] = frozenset()
    _choices: Dict[str, str] = {}  # member -> prefix of its constants
    _colors: Dict[str, Optional[float]] = {}  # member -> largest number, see color(); None: light
    _ranges: Dict[str, Tuple[float, float]] = {}  # member -> least and largest number; all others have to be finite
    _nested: Dict[str, Type[Record]] = {}  # struct of a member -> its class

    _c: Any  # the struct

    def __init__(self, **members: Any) -> None:
        self._begin(_c.make(self._kind))
        for name, value in members.items():
            setattr(self, name, value)

    def _begin(self, struct: Any) -> None:
        object.__setattr__(self, "_c", struct)

    @classmethod
    def _of(cls: Type[R], struct: Any) -> R:
        """A record around a struct, which it keeps."""
        record = cls.__new__(cls)
        record._begin(struct)
        return record

    @classmethod
    def _from(cls: Type[R], value: Any, name: str = "", **members: Any) -> R:
        """Converts a dict (or a name, an index) to the record, and sets the members in a copy of it. name: of the argument, for messages."""
        if isinstance(value, dict):
            value = cls(**value)
        elif not isinstance(value, cls):
            raise UsageError(f"{name or cls._kind}: expected a {cls.__name__} or a dict of its members, found {shown(value)}")
        if members:
            value = value._copied()
            for member, wanted in members.items():
                setattr(value, member, wanted)
        found: R = value
        return found

    def _copied(self: R) -> R:
        """Another record that is equal. Its name is its own: that of a scene may go away."""
        other = type(self)._of(type(self._c).from_buffer_copy(self._c))
        if "name" in self._members():
            other._c.name = bytes(self._c.name or b"")
        return other

    @classmethod
    def _members(cls) -> List[Any]:
        fields = _c.STRUCT["halflit_" + cls._kind]._fields_
        return [name for name, _ in fields if name not in ("size", "reserved") and not name.endswith("_rest")]

    if not TYPE_CHECKING:  # which shall find misspelled members

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") or name not in self._members():
                raise AttributeError(f"{type(self).__name__} has no member {name}")
            value = getattr(self._c, name)
            if name in self._choices:
                return next((text for text, number in _c.choices(self._choices[name]).items() if number == value), value)
            if name in self._truths:
                return bool(value)
            if isinstance(value, ctypes.Array):
                rest = getattr(self._c, name + "_rest", None)
                return tuple(value) if rest is None else tuple(map(sum, zip(value, rest)))
            if isinstance(value, ctypes.Structure):
                return self._nested[type(value).__name__]._of(value)
            return _c.text_of(value) if name == "name" else value

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("size", "reserved") or name not in self._members():
            raise UsageError(f"{type(self).__name__} has no member {name}, expected one of {', '.join(self._members())}")
        setattr(self._c, name, self._converted(name, value))
        if hasattr(self._c, name + "_rest"):  # of the doubles that were given
            getattr(self._c, name + "_rest")[:] = [x - y for x, y in zip(reals(value, 3, name), getattr(self._c, name))]

    def _converted(self, name: str, value: Any) -> Any:
        kind: Any = self._c._kinds[name]
        field = kind
        if name in self._choices and isinstance(value, str):
            return chosen(value, self._choices[name], name)
        if name in self._truths:
            return truth(value, name)
        if name in self._colors:
            return field(*(self._checked(x, name) for x in color(value, name, field._length_, self._colors[name])))
        if issubclass(kind, ctypes.Array):
            return field(*(self._checked(x, name) for x in reals(value, field._length_, name)))
        if issubclass(kind, ctypes.Structure):
            return self._nested[field.__name__]._from(value, name)._c
        if name == "name":
            return _c.bytes_of(value, name)
        return self._checked(_c.converted(field, value, name), name)

    def _checked(self, number: Any, name: str) -> Any:
        low, high = self._ranges.get(name, (-math.inf, math.inf))
        if not (math.isfinite(number) and low <= number <= high):
            bounds = "" if name not in self._ranges else f" from {low:g} on" if high == math.inf else f" from {low:g} to {high:g}"
            raise UsageError(f"{name}: expected a finite number{bounds}, found {number}")
        return number

    def to_dict(self) -> Dict[str, Any]:
        """All members by their names."""
        values = {name: getattr(self, name) for name in self._members()}
        return {name: value.to_dict() if isinstance(value, Record) else value for name, value in values.items()}

    def _defaults(self) -> Dict[str, Any]:
        """The members that repr() leaves out if they have these values."""
        return type(self)().to_dict()

    def __reduce__(self) -> Any:
        """A copy, or a pickle, has a struct of its own."""
        return _remade, (type(self), self.to_dict())

    def __repr__(self) -> str:
        defaults = self._defaults()
        members = [f"{name}={value!r}" for name, value in self.to_dict().items() if value != defaults[name]]
        return f"{type(self).__name__}({', '.join(members)})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record) or type(self) is not type(other):
            return False
        return self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]


def _remade(kind: Any, members: Dict[Any, Any]) -> Record:
    made: Record = kind()
    for name, value in members.items():  # all of them, which the constructor may refuse
        setattr(made, name, value)
    return made


def chosen(value: str, prefix: str, name: str) -> int:
    """The number of an enumeration's value by its name; - and _ are the same."""
    known = _c.choices(prefix)
    try:
        return int(known[value.replace("-", "_")])
    except KeyError:
        raise UsageError(f"{name}: expected one of {', '.join(known)}, found {value!r}") from None
