"""The keywords of render() and setup() with their types, for help() and type checkers."""
from __future__ import annotations

from typing import Any, Callable, Literal, Sequence, Tuple, TypedDict, Union

from ._camera import Camera
from ._lazy import np
from ._material import LobeOf
from ._setup import Setup
from ._types import Aov, Array, Color, Isa, Studio, ViewOf


class ViewOptions(TypedDict, total=False):
    """Keywords of Scene.setup(): see PictureOptions."""

    camera: Union[Camera, int, str, Array]
    azimuth: float
    elevation: float
    zoom: float
    fov: float
    orthographic: bool
    view: ViewOf
    fit: float
    exposure: float
    ev: Union[float, str]
    ambient: Color
    studio: Studio
    studio_turn: float


class PictureOptions(ViewOptions, total=False):
    """Keywords of Scene.render() and halflit.render(). Defaults in parentheses; what is chosen is chosen as the program does.

    The view:
        camera: a Camera or its 4 x 4 matrix, a camera of the file by index or name, or "frame" for a view of the whole scene (chosen)
        azimuth: view of the whole scene, degrees around +y: 0 is from +z, 90 from +x (35)
        elevation: degrees above the horizon (20)
        zoom: 2 makes things twice as large (1)
        fov: full vertical angle of that view, degrees (35)
        orthographic: that view has parallel rays, and no fov (False)
        view: the whole scene from a side: "front", "back", "left", "right", "top", "bottom", "iso", or (azimuth, elevation). All sides have
            one distance and one scale, in place of one as near as the side allows
        fit: margin in pixels, to which that view, or any view of the whole scene, is fitted (none)
        setup: what Scene.setup() chose for an earlier picture, instead of all of the above and of the light below but exposure and ev

    The light that is chosen:
        exposure: factor on all light, above 0 (chosen)
        ev: the same in stops, as the program's --exposure: exposure is 2 ** ev; "auto+1" and "auto-0.5": stops brighter than is chosen
        ambient: light from all around (none)
        studio: when the built-in studio lights the scene: "for_dark", if it has neither ambient light nor an environment; "under_lights",
            a share of it where the scene has lights, too; "always", in place of ambient light and environment; "never" (for_dark;
            under_lights after add_light(); never with ambient)
        studio_turn: degrees about the vertical, counter-clockwise seen from above (0)

    The picture:
        background: "auto" (dark grey, light grey behind dark surfaces), "transparent", "environment", "#rrggbb", "#rrggbbaa" or linear
            numbers ("auto")
        region: x, y, width, height: draws this part alone, as the array's whole (all)
        dtype: numpy.uint8 (sRGB codes) or numpy.float32 (linear light) (uint8, or that of out)
        premultiplied: colours are multiplied by alpha (False)
        out: the array to draw into, (height, width, 4); rows may have gaps (a new one)
        aovs: names of AOVS, or "all" (none). Vertices are rounded to multiples of 1/256 pixel, so the picture's camera sees a
            "position" within 1/512 pixel, on each axis, of the pixel that has it
        edge_color: of the lines of `edges`: "#rrggbb" or linear numbers (black)
        lobe: of materials without a lobe of their own (lambert)

    Settings:
        max_error: largest difference from the exact picture in 8-bit codes: the cheapest way that is proven to keep it, for light
            once a pixel, full texture filters and exact arithmetic alone; 0: none (0)
        environment_tolerance: of bands that are left out, relative to white, in linear light; half an 8-bit code (1/510)
        shadow_memory_limit: bytes; the largest shadow maps are halved until all fit (256 MiB)
        samples: per pixel: 1, 4, 8 or 16 (4)
        tone_curve: from light to codes, for each sample, after exposure; pictures of floats and the background colour do without:
            "none", "reinhard", "aces", "neutral" (neutral)
        point_size: Size of points, pixels, 1/16 to 256; rounded to 1/256. From 3 on they are round, below that square. 0: the sizes
            that close the surface that they lie on, by their distances in the picture: 2 at least, a 25th of the picture's shorter
            side at most. (0)
        line_width: width of lines, likewise (1.5)
        accuracy: arithmetic; exact if there is an error budget: "reference", "exact" (exact)
        texture_detail: upper limit of the texture filters: "full", "bilinear", "nearest" (full)
        anisotropy: largest ratio of a footprint's length to its width that is filtered along its length, 1 to 16; 1: footprints
            count as squares; for textures that are linear within and between levels (4)
        specular: model of highlights; none: albedo is the base colour itself: "none", "phong", "blinn", "ggx" (blinn)
        normalize_specular: sharper highlights are brighter, for the same light in all; off: a peak of 1 for every exponent; ggx
            always is (True)
        normal_scale: factor on x and y of all normal maps, a coat's too; 0: surfaces have the normals of their meshes (1)
        shading_rate: how often light is evaluated: "flat", "gouraud", "pixel" (pixel)
        environment_bands: of spherical harmonics, 1 to 10; 0: the fewest whose error is within environment_tolerance (0)
        shadows: effect of shadows on wrapped light; off: no shadow maps are drawn: "off", "hard", "soft_split" (soft_split)
        shadow_size: Texels on a side of a shadow map, a multiple of 64 from 64 to 4096; a cube's faces have half. 0: three for two
            pixels of what is seen, from 256 to twice the picture's longer side, at most 2048. (0)
        soft_shadow_maps: points of a light that has a shadow_radius, each with maps of half that side: 4 to 64 (16)
        shadow_fade: soft_split: distance to the blocker from which on wrapped light is 0, world units; 0: from object size and wrap
            (0)
        sky_shadows: Number of directions in which ambient light and the environment cast shadows, by shadow maps of 256 texels: 16
            to 1024. 1 (auto): by a grid of at most 28 points on a side, which costs little; 2/5 of the light that is lost comes
            back from other surfaces. 0, or without shadows: they cast none. (1)
        shadow_terminator_offset: look-ups on the smooth surface given by the vertex normals, for coarse meshes (False)
        emission_scale: factor on the light that all surfaces emit (not on colours of unlit materials) (1)
        edges: Lines along the edges of all that is drawn but shadow catchers, over the finished picture. Surfaces of triangles hide
            them, glass does not. A line that touches a surface is in front of it. Vertices at one position count as one, because
            files split vertices: "none", "feature", "silhouette", "all" (none)
        hidden_edges: edges behind surfaces: "none", "dashed" (none)
        edge_angle_deg: between the normals of two triangles, from which on their edge is a line: 0 to 180 (30)
        edge_width: of the lines, pixels, 1/4 to 64; below 1 they are paler instead (1.5)
        max_layers: transparent surfaces on each pixel, in the mean over all pixels of the picture (as of 2^18 if it has fewer), 1
            to 2^20; more end the call with a limit's error: a small file can ask for millions. 0: no limit (128)
        contact_shadow: Opacity of the soft shadow below a model that stands, over the background, where all light from above is
            hidden: 0 to 1. There is none in a scene with a shadow catcher, without shadows, by parallel rays, and seen from below.
            0: none. (0.85)
        alpha: of codes on transparent backgrounds; floats have the share of light: "linear", "display" (display)
        shadow_softness_deg: Angle from the middle of a directional light without a shadow_radius to its edge, as the penumbras of
            its shadows show it, by a wider filter in one map: cheap, and an approximation. Penumbras are at most 24 texels wide.
            Degrees, 0 to 10; 0: all edges are sharp. (3)
        edl: Shading by the depths of the picture: a surface is darker where its neighbours are nearer to the viewer. Transparent
            surfaces count as not there: "off", "auto", "on" (auto)
        edl_strength: of that shading, 0 to 16 (1)
        edge_contrast: black lines on surfaces of dark materials are light grey instead (True)

    How it is computed: nothing of this changes a pixel:
        threads: 0: one for each core (0)
        isa: instruction set: "scalar", "sse2", "sse4.1", "avx2", "avx512" or "neon64" (the best one)
        tile_size: 16, 32 or 64 pixels (64)
        time_limit: seconds for the frame; beyond it LimitError (0: none)
        memory_limit: bytes of working memory for the frame; beyond it LimitError (0: none)
        progress: called with the share that is done, 0 to 1, from threads of the library; True: shows a bar, by tqdm if it is
            installed (none)
        cancelled: called before each part, from threads of the library; true stops the frame with CancelledError (none)
    """

    setup: Setup
    background: Union[str, Color]
    edge_color: Color
    region: Tuple[int, int, int, int]
    dtype: Any
    premultiplied: bool
    out: Array
    aovs: Union[Sequence[Aov], Aov, Literal["all"]]
    lobe: LobeOf
    # Made by apps/c/tables.py of raster/settings_table.def.
    max_error: float
    environment_tolerance: float
    shadow_memory_limit: int
    samples: int
    tone_curve: Literal["none", "reinhard", "aces", "neutral"]
    point_size: float
    line_width: float
    accuracy: Literal["reference", "exact"]
    texture_detail: Literal["full", "bilinear", "nearest"]
    anisotropy: int
    specular: Literal["none", "phong", "blinn", "ggx"]
    normalize_specular: bool
    normal_scale: float
    shading_rate: Literal["flat", "gouraud", "pixel"]
    environment_bands: int
    shadows: Literal["off", "hard", "soft_split"]
    shadow_size: int
    soft_shadow_maps: int
    shadow_fade: float
    sky_shadows: int
    shadow_terminator_offset: bool
    emission_scale: float
    edges: Literal["none", "feature", "silhouette", "all"]
    hidden_edges: Literal["none", "dashed"]
    edge_angle_deg: float
    edge_width: float
    max_layers: int
    contact_shadow: float
    alpha: Literal["linear", "display"]
    shadow_softness_deg: float
    edl: Literal["off", "auto", "on"]
    edl_strength: float
    edge_contrast: bool
    # How it is computed.
    threads: int
    isa: Isa
    tile_size: int
    time_limit: float
    memory_limit: int
    progress: Union[Callable[[float], Any], bool]
    cancelled: Callable[[], Any]
