"""Types of arguments."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Literal, Sequence, Tuple, Union

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
#: The axis that points up.
Up = Literal["x", "y", "z", "-x", "-y", "-z"]
ViewName = Literal["front", "back", "left", "right", "top", "bottom", "iso"]
#: A side that the whole scene is seen from: a name, or (azimuth, elevation) in degrees.
ViewOf = Union[ViewName, Tuple[float, float]]
#: Light of many pictures: that of the first, or turned with each camera.
BatchLight = Literal["fixed", "viewer"]
Wrap = Literal["repeat", "mirror", "clamp"]
Filter = Literal["nearest", "linear"]
MipFilter = Literal["none", "nearest", "linear"]
AlphaMode = Literal["opaque", "mask", "blend"]
LightType = Literal["directional", "point", "spot"]
LobeName = Literal["lambert", "green", "half-lambert", "valve", "sloan", "mcauley"]
Topology = Literal["triangles", "lines", "points"]
SplatReference = Literal["inria", "inria_aa", "khr", "mip"]
Encoding = Literal["srgb", "linear"]
TextureEncoding = Literal["srgb", "linear", "srgb_by_alpha", "normal"]
Studio = Literal["for_dark", "under_lights", "always", "never"]
Isa = Literal["scalar", "sse2", "sse4.1", "avx2", "avx512", "neon64"]
Part = Literal["node", "instance", "mesh", "material", "camera"]
Aov = Literal[
    "depth", "normal", "vertex_normal", "albedo", "position", "id", "triangle", "coverage", "lights", "barycentric", "uv", "ray",
    "view_normal", "mesh", "material", "part", "depth16",
]  # fmt: skip
