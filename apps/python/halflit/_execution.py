"""How frames are computed: threads, limits, and callbacks."""
from __future__ import annotations

import atexit
import contextlib
import os
import signal
import threading
from _weakrefset import WeakSet  # weakref takes a tenth of halflit's own import
from typing import Any, Callable, Dict, Iterator, Optional

from . import _c
from ._errors import CancelledError, UsageError
from ._options import EXECUTION
from ._threads import CALLING


class SceneLock:
    """One thread at a time uses a scene. The callbacks of its frame cannot: the frame would wait for itself."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._lost = False
        _LOCKS.add(self)

    def __enter__(self) -> None:
        if getattr(CALLING, "lock", None) is self:
            raise UsageError("progress and cancelled cannot use the scene that is drawn")
        if self._lost:
            raise UsageError("another thread used this scene when the process was forked: make it anew in this process")
        self._lock.acquire()

    def __exit__(self, *_: Any) -> None:
        self._lock.release()

    def after_fork(self) -> None:
        """In the child: the thread that used the scene is not there, and left it half changed."""
        if self._lock.acquire(blocking=False):
            self._lock.release()
        else:
            self._lock, self._lost = threading.RLock(), True


_LOCKS: WeakSet[Any] = WeakSet()


def _after_fork() -> None:
    for lock in list(_LOCKS):
        lock.after_fork()


class _Calls:
    """Frames with callbacks. At exit they are stopped and waited for: after exit, CPython kills a thread that calls back; inside the library
    that aborts the process."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        self.ending = False
        self._frames = 0
        self._changed = threading.Condition()

    @contextlib.contextmanager
    def of_a_frame(self) -> Iterator[None]:
        with self._changed:
            if self.ending:
                raise CancelledError("the interpreter ends")
            self._frames += 1
        try:
            yield
        finally:
            with self._changed:
                self._frames -= 1
                self._changed.notify_all()
            if self.ending:
                raise SystemExit  # the frame is of a daemon thread, which ends without a word

    def end(self) -> None:
        with self._changed:
            self.ending = True
            self._changed.wait_for(lambda: self._frames == 0, timeout=10)


_CALLS = _Calls()
atexit.register(_CALLS.end)
if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=_CALLS.begin)  # the frames of other threads are not there
    os.register_at_fork(after_in_child=_after_fork)


class Execution:
    """A halflit_execution for the keywords. An exception in progress() or cancelled() stops the frame, and is raised after it.

    lock: of the scene, which the frame holds while it waits for the callbacks.
    """

    def __init__(self, options: Dict[Any, Any], lock: SceneLock) -> None:
        self.lock = lock
        self.struct = struct = _c.make("execution")
        self.raised: BaseException | None = None
        # With Python's own handler, Ctrl-C ends the frame: the handler runs as soon as the library returns.
        self.in_main = threading.current_thread() is threading.main_thread()
        self.interrupts = _c.stops_at_interrupt()
        struct.stop_at_interrupt = self.interrupts
        self.key = (self.interrupts, *(options.get(name) for name in EXECUTION))
        for name, member in (("threads", "threads"), ("tile_size", "tile_size"), ("time_limit", "time_limit_s"), ("memory_limit",) * 2):
            if options.get(name) is not None:
                struct.put(member, options[name], name)
        if options.get("isa") is not None:
            struct.isa = _c.bytes_of(options["isa"], "isa")
        progress, cancelled = options.get("progress"), options.get("cancelled")
        if progress is True or progress is False:
            from ._progress import bar

            progress = bar() if progress else None
        for name, given in (("progress", progress), ("cancelled", cancelled)):
            if given is not None and not callable(given):
                raise UsageError(f"{name}: expected a function, found {given!r}")
        self.has_callbacks = progress is not None or cancelled is not None
        if self.has_callbacks:
            struct.progress = _c.Progress(lambda _, share: self._guarded(progress, share))
            struct.cancelled = _c.Cancelled(lambda _: 1 if self._stops(cancelled) else 0)

    def _stops(self, cancelled: Any) -> bool:
        if _CALLS.ending or self.raised:
            return True
        return bool(self._guarded(lambda: bool(cancelled and cancelled())) or self.raised)

    @contextlib.contextmanager
    def calls(self) -> Iterator[None]:
        """Around the call that draws: what must hold while the library calls back."""
        if not self.has_callbacks:
            yield
            return
        with _CALLS.of_a_frame(), self._interrupts():
            yield

    @contextlib.contextmanager
    def _interrupts(self) -> Iterator[None]:
        """Ctrl-C ends the frame: an exception at the start of a callback would be lost in ctypes."""
        if not (self.interrupts and self.in_main):
            yield
            return

        def note(*_: Any) -> None:
            self.raised = self.raised or KeyboardInterrupt()

        signal.signal(signal.SIGINT, note)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _guarded(self, function: Any, *arguments: Any) -> Any:
        before = getattr(CALLING, "lock", None)
        CALLING.lock = self.lock
        try:
            return function(*arguments) if function is not None and self.raised is None else None
        except BaseException as error:  # KeyboardInterrupt too: the frame ends, then it is raised
            self.raised = error
            return None
        finally:
            CALLING.lock = before
