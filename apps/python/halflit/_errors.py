"""Exceptions, one class for each code of halflit.h, and warnings."""
from __future__ import annotations

import errno
import os
import sys
import warnings
from typing import Optional


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
    """A file cannot be read or written. errno is set where the system told the reason, filename where it is the file that was named.

    If the file does not exist, the exception is a FileNotFoundError too.
    """

    code = 4

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class MissingFileError(FileError, FileNotFoundError):
    """A file, or its folder, does not exist."""


class LimitError(Error):
    """A limit was hit, or the memory is full."""

    code = 5


class CancelledError(Error):
    """`cancelled` stopped the frame."""

    code = 7


BY_CODE = {kind.code: kind for kind in (UsageError, BadInputError, FileError, LimitError, Error, CancelledError)}
_REASONS = {os.strerror(number): number for number in (errno.ENOENT, errno.EACCES, errno.ENOSPC, errno.EROFS, errno.ENAMETOOLONG)}


def made(code: int, text: str, path: Optional[bytes]) -> Error:
    """The exception for a code and its message. path: the file that was named."""
    if code != FileError.code:
        return BY_CODE.get(code, Error)(text)
    # The library tells the system's reason as the message's last part.
    start, _, reason = text.rpartition(": ")
    number = _REASONS.get(reason)
    error = MissingFileError(text) if number == errno.ENOENT else FileError(text)
    if number is not None:
        error.errno, error.strerror = number, reason
    name = None if path is None else os.fsdecode(path)
    if name is not None and start in (name, name + ": cannot be opened"):  # not a file that it refers to
        error.filename = name
    return error


def warn(text: str) -> None:
    """A warning at the line outside of the package that called it."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and (frame.f_globals.get("__package__") or "").partition(".")[0] == __package__:
        level, frame = level + 1, frame.f_back
    warnings.warn(f"halflit: {text}", stacklevel=level)
