"""Exceptions: one class for each code of halflit.h."""
from __future__ import annotations


class Error(Exception):
    """A call of halflit failed. The text is one line that names the place, what was found and what was expected."""

    code = 6  #: HALFLIT_ERROR_INTERNAL: a fault of the library


class UsageError(Error, ValueError):
    """An argument is out of range, or two exclude each other."""

    code = 2


class BadInputError(Error, ValueError):
    """A damaged file, or faulty arrays."""

    code = 3


class FileError(Error, OSError):
    """A file cannot be read or written."""

    code = 4


class LimitError(Error):
    """A limit was hit, or the memory is full."""

    code = 5


class CancelledError(Error):
    """`cancelled` stopped the frame."""

    code = 7


BY_CODE = {kind.code: kind for kind in (UsageError, BadInputError, FileError, LimitError, Error, CancelledError)}
