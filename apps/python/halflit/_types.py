"""Types of arguments."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Sequence, Tuple, Union

if TYPE_CHECKING:
    from typing_extensions import Unpack as Unpack
else:
    try:
        from typing import Unpack  # Python 3.11
    except ImportError:
        try:
            from typing_extensions import Unpack
        except ImportError:  # nobody checks types here; get_type_hints() shall work nevertheless

            class Unpack:
                def __class_getitem__(cls, _):
                    return Any


#: "#rrggbb", numbers of linear light, or uint8 sRGB codes. "np.ndarray" is looked up where the type is used: see _lazy.
Color = Union[str, Sequence[float], "np.ndarray"]  # type: ignore[name-defined]  # noqa: F821
Point = Union[Sequence[float], "np.ndarray"]  # type: ignore[name-defined]  # noqa: F821
#: (width, height) in pixels, or the side of a square.
Size = Union[int, Tuple[int, int], None]
Members = Dict[str, Any]
