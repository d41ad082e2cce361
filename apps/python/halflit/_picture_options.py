"""The keywords of render() and setup() with their types, for help() and type checkers."""
from __future__ import annotations

from typing import Any, Callable, Sequence, Tuple, TypedDict, Union

from ._camera import Camera
from ._lazy import np
from ._material import Lobe
from ._setup import Setup
from ._types import Color


class ViewOptions(TypedDict, total=False):
    """Keywords of Scene.setup(): see PictureOptions."""

    camera: Union[Camera, int, str, np.ndarray]
    azimuth: float
    elevation: float
    zoom: float
    fov: float
    exposure: float
    ev: float
    ambient: Color
    studio: str
    studio_turn: float


class PictureOptions(ViewOptions, total=False):
    """Keywords of Scene.render() and halflit.render(). Defaults in parentheses; what is chosen is chosen as the program does.

    The view:
        camera: a Camera or its 4 x 4 matrix, a camera of the file by index or name, or "frame" for a view of the whole scene (chosen)
        azimuth: view of the whole scene, degrees around +y: 0 is from +z, 90 from +x (35)
        elevation: degrees above the horizon (20)
        zoom: 2 makes things twice as large (1)
        fov: full vertical angle of that view, degrees (35)
        setup: what Scene.setup() chose for an earlier picture, instead of all of the above and of the light below but exposure and ev

    The light that is chosen:
        exposure: factor on all light, above 0 (chosen)
        ev: the same in stops, as the program's --exposure: exposure is 2 ** ev
        ambient: light from all around (none)
        studio: when the built-in studio lights the scene: "for_dark", if it has neither ambient light nor an environment; "under_lights",
            a share of it where the scene has lights, too; "always", in place of ambient light and environment; "never" (for_dark;
            under_lights after add_light(); never with ambient)
        studio_turn: degrees about the vertical, counter-clockwise seen from above (0)

    The picture:
        samples: a pixel: 1, 4, 8 or 16 (4)
        background: "transparent", "environment", "#rrggbb", "#rrggbbaa" or linear numbers ("#3a3f47")
        tone_curve: "none", "reinhard", "aces" or "neutral" (neutral)
        region: x, y, width, height: draws this part alone, as the array's whole (all)
        dtype: numpy.uint8 (sRGB codes) or numpy.float32 (linear light) (uint8, or that of out)
        premultiplied: colours are multiplied by alpha (False)
        out: the array to draw into, (height, width, 4); rows may have gaps (a new one)
        aovs: names of AOVS, or "all" (none)

    Shading:
        max_error: error budget in 8-bit codes; halflit chooses the cheapest way within it (0: none)
        accuracy: "exact" or "reference" (exact)
        shading_rate: "flat", "gouraud" or "pixel" (pixel)
        texture_detail: "full", "bilinear" or "nearest" (full)
        anisotropy: 1 to 16 (4)
        specular: "none", "phong", "blinn" or "ggx" (blinn)
        normalize_specular: sharper highlights are brighter (True)
        lobe: of materials without a lobe of their own (lambert)
        environment_bands: of spherical harmonics, 1 to 10; 0: as many as environment_tolerance requires (0)
        environment_tolerance: error of leaving out bands, relative to white (1/510)
        point_size: side of points, pixels (2)
        line_width: pixels (1.5)

    Shadows:
        shadows: "off", "hard" or "soft_split" (soft_split)
        shadow_size: texels on a side of a shadow map, a power of two from 64 to 4096 (chosen)
        shadow_fade: distance to the blocker at which wrapped light ends, world units; 0: chosen (0)
        shadow_terminator_offset: moves look-ups onto the smooth surface, for coarse meshes (False)
        shadow_memory_limit: bytes (256 MiB)
        soft_shadow_maps: shadow maps of a light with a shadow_radius, 4 to 64 (16)
        sky_shadows: directions in which light from all around may be hidden, 16 to 1024; 0: none (0)

    How it is computed: nothing of this changes a pixel:
        threads: 0: one for each core (0)
        isa: instruction set: "scalar", "sse2", "sse4.1", "avx2", "avx512" or "neon64" (the best one)
        tile_size: 16, 32 or 64 pixels (64)
        time_limit: seconds for the frame; beyond it LimitError (0: none)
        memory_limit: bytes of working memory for the frame; beyond it LimitError (0: none)
        progress: called with the share that is done, 0 to 1, from threads of the library (none)
        cancelled: called before each part, from threads of the library; true stops the frame with CancelledError (none)
    """

    setup: Setup
    samples: int
    background: Union[str, Color]
    tone_curve: str
    region: Tuple[int, int, int, int]
    dtype: Any
    premultiplied: bool
    out: np.ndarray
    aovs: Union[Sequence[str], str]
    max_error: float
    accuracy: str
    shading_rate: str
    texture_detail: str
    anisotropy: int
    specular: str
    normalize_specular: bool
    lobe: Union[Lobe, str, Tuple[str, float]]
    environment_bands: int
    environment_tolerance: float
    point_size: float
    line_width: float
    shadows: str
    shadow_size: int
    shadow_fade: float
    shadow_terminator_offset: bool
    shadow_memory_limit: int
    soft_shadow_maps: int
    sky_shadows: int
    threads: int
    isa: str
    tile_size: int
    time_limit: float
    memory_limit: int
    progress: Callable[[float], Any]
    cancelled: Callable[[], Any]
