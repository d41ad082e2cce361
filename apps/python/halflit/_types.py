"""Types of arguments."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Sequence, Tuple, Union

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Unpack as Unpack

    Array = np.ndarray[Any, np.dtype[Any]]
else:
    Array = "np.ndarray"  # looked up where the type is used: see _lazy
    try:
        from typing import Unpack  # Python 3.11
    except ImportError:
        try:
            from typing_extensions import Unpack
        except ImportError:  # nobody checks types here; get_type_hints() shall work nevertheless

            class Unpack:
                def __class_getitem__(cls, _: Any) -> Any:
                    return Any


#: "#rrggbb", a name of CSS such as "white", numbers of linear light, or uint8 sRGB codes.
Color = Union[str, Sequence[float], Array]
Point = Union[Sequence[float], Array]
#: (width, height) in pixels, or the side of a square.
Size = Union[int, Tuple[int, int], None]
Members = Dict[str, Any]
