"""Which threads draw for the main thread."""
from __future__ import annotations

import threading
from typing import Callable, Optional

CALLING = threading.local()  # lock: of the scene whose frame runs a callback in this thread


def is_for_main() -> bool:
    """The main thread draws, or waits for the frames of this thread."""
    return threading.current_thread() is threading.main_thread() or getattr(CALLING, "is_for_main", False)


def _draws_for_main() -> None:
    CALLING.is_for_main = True


def begins_helper() -> Optional[Callable[[], None]]:
    """Function that a thread has to call first if this thread waits for its frames. If this is the main thread, Ctrl-C ends them too."""
    return _draws_for_main if is_for_main() else None
