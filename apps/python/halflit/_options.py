"""The keywords of render(): what decides a picture, and how it is computed."""
from __future__ import annotations

import contextlib
import ctypes
import signal
import threading

from . import _c
from ._errors import UsageError
from ._records import Lobe, chosen, fill

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Callable, Iterator, Sequence, Tuple, TypedDict, Union

    import numpy as np

    from ._camera import Camera
    from ._records import Color
    from ._scene import Setup

    class PictureOptions(TypedDict, total=False):
        """Keywords of Scene.render() and halflit.render(); what is left out is chosen as the program does."""

        # The view
        camera: Union[Camera, int, str, np.ndarray]  #: a Camera or its 4 x 4 matrix, a camera of the file by index or name, or "frame"
        azimuth: float  #: view of the whole scene, degrees around +y: 0 is from +z, 90 from +x (35)
        elevation: float  #: degrees above the horizon (20)
        zoom: float  #: 2 makes things twice as large (1)
        fov: float  #: full vertical angle of that view, degrees (35)
        setup: Setup  #: what Scene.setup() chose for an earlier picture, instead of all of the above and of the light below
        # The light that is chosen
        exposure: float  #: factor on all light, above 0 (chosen)
        ambient: Color  #: light from all around, linear
        studio: str  #: "for_dark", "always", "never" or "under_lights"
        studio_turn: float  #: degrees about the vertical
        # The picture
        samples: int  #: a pixel: 1, 4, 8 or 16 (4)
        background: Union[str, Color]  #: "transparent", "environment", "#rrggbb", "#rrggbbaa" or linear numbers (#3a3f47)
        tone_curve: str  #: "none", "reinhard", "aces" or "neutral" (neutral)
        region: Tuple[int, int, int, int]  #: x, y, width, height: draws this part alone, as the array's whole
        dtype: Any  #: numpy.uint8 (sRGB codes) or numpy.float32 (linear light)
        premultiplied: bool  #: colours are multiplied by alpha (False)
        out: np.ndarray  #: the array to draw into, (height, width, 4); rows may have gaps
        aovs: Union[Sequence[str], str]  #: names of AOVS, or "all"
        # Shading
        max_error: float  #: error budget in 8-bit codes; halflit chooses the cheapest way within it (0: none)
        accuracy: str  #: "exact" or "reference" (exact)
        shading_rate: str  #: "flat", "gouraud" or "pixel" (pixel)
        texture_detail: str  #: "full", "bilinear" or "nearest" (full)
        anisotropy: int  #: 1 to 16 (4)
        specular: str  #: "none", "phong", "blinn" or "ggx" (blinn)
        normalize_specular: bool  #: sharper highlights are brighter (True)
        lobe: Union[Lobe, str, Tuple[str, float]]  #: of materials without a lobe of their own (lambert)
        environment_bands: int  #: of spherical harmonics, 1 to 10; 0: as many as environment_tolerance requires (0)
        environment_tolerance: float  #: error of leaving out bands, relative to white (1/510)
        point_size: float  #: side of points, pixels (2)
        line_width: float  #: pixels (1.5)
        # Shadows
        shadows: str  #: "off", "hard" or "soft_split" (soft_split)
        shadow_size: int  #: texels on a side of a shadow map, a power of two from 64 to 4096 (chosen)
        shadow_fade: float  #: distance to the blocker at which wrapped light ends, world units; 0: chosen (0)
        shadow_terminator_offset: bool  #: for coarse meshes (False)
        shadow_memory_limit: int  #: bytes (256 MiB)
        soft_shadow_maps: int  #: 4 to 64 (16)
        sky_shadows: int  #: directions in which light from all around may be hidden, 16 to 1024; 0: none (0)
        # How it is computed: nothing of this changes a pixel
        threads: int  #: 0: one for each core (0)
        isa: str  #: instruction set: "scalar", "sse2", "sse4.1", "avx2", "avx512" or "neon64" (the best one)
        tile_size: int  #: 16, 32 or 64 pixels (64)
        time_limit: float  #: seconds for the frame; beyond it LimitError (0: none)
        memory_limit: int  #: bytes of working memory for the frame; beyond it LimitError (0: none)
        progress: Callable[[float], Any]  #: told the share that is done, from threads of the library
        cancelled: Callable[[], Any]  #: asked before each part; true stops the frame with CancelledError


#: Planes beside the picture: name -> (member of the target, channels, number type). They show what each pixel's first sample sees.
AOVS = {
    "depth": ("depth", 1, "float32"),  # distance along the view axis; infinity where nothing is
    "normal": ("shading_normal", 3, "float32"),  # unit normal that light falls on, normal map included, world space
    "vertex_normal": ("normal", 3, "float32"),  # the same without the normal map
    "albedo": ("albedo", 3, "float32"),  # base colour, linear
    "position": ("position", 3, "float32"),  # world space
    "id": ("instance", 1, "uint32"),  # index of the instance plus 1; 0 where nothing is
    "triangle": ("triangle", 1, "uint32"),  # number of the triangle in its mesh plus 1
    "coverage": ("coverage", 1, "float32"),  # share of the samples that a surface covers
    "lights": ("lights", 1, "uint32"),  # lights that have the surface in their range and cone
}

VIEW = ("camera", "azimuth", "elevation", "zoom", "fov", "setup", "exposure", "ambient", "studio", "studio_turn")
PIXELS = ("dtype", "premultiplied", "out", "aovs", "region")
EXECUTION = ("threads", "isa", "tile_size", "time_limit", "memory_limit", "progress", "cancelled")
_NAMES = {"max_error": "max_error_codes"}  # keyword -> member of halflit_settings, where they differ
_CHOICES = {
    "accuracy": "ACCURACY",
    "shading_rate": "RATE",
    "texture_detail": "DETAIL",
    "specular": "SPECULAR",
    "shadows": "SHADOWS",
    "tone_curve": "TONE",
}
SETTINGS = (
    "samples background max_error accuracy shading_rate texture_detail anisotropy specular normalize_specular lobe environment_bands"
    " environment_tolerance point_size line_width shadows shadow_size shadow_fade shadow_terminator_offset shadow_memory_limit"
    " soft_shadow_maps sky_shadows tone_curve"
).split()
KNOWN = frozenset((*VIEW, *PIXELS, *EXECUTION, *SETTINGS))


def check_names(options: dict, known=KNOWN) -> None:
    """Fails as a function does for a keyword that it does not have."""
    for name in options:
        if name not in known:
            import difflib

            near = difflib.get_close_matches(name, sorted(known), 1)
            raise TypeError(f"render() has no keyword {name!r}" + (f", did you mean {near[0]!r}?" if near else ""))


def apply_settings(settings, options: dict) -> None:
    """Writes the keywords that were given into a halflit_settings."""
    for name in SETTINGS:
        if options.get(name) is None:
            continue
        value = options[name]
        if name == "background":
            set_background(settings, value)
        elif name == "lobe":
            settings.lobe, settings.override_lobe = Lobe._from(value)._c, 1
        elif name in _CHOICES and isinstance(value, str):
            setattr(settings, name, chosen(value, _CHOICES[name], name))
        else:
            setattr(settings, _NAMES.get(name, name), value)


def set_background(settings, value) -> None:
    if isinstance(value, str) and value == "environment":
        settings.background_environment = 1
        return
    settings.background = color_of(value) if isinstance(value, str) else fill(ctypes.c_float * 4, value, "background", 1.0)


def color_of(text: str):
    """Four linear floats for "transparent" or "#rrggbb", which is sRGB."""
    digits = text[1:] if text.startswith("#") else ""
    if len(digits) in (3, 4):
        digits = "".join(2 * digit for digit in digits)
    try:
        codes = [int(digits[i : i + 2], 16) / 255 for i in range(0, len(digits), 2)]
    except ValueError:
        codes = []
    if text == "transparent":
        return (ctypes.c_float * 4)()
    if len(codes) not in (3, 4):
        raise UsageError(f"expected transparent, environment, #rgb, #rrggbb, #rrggbbaa or numbers, found {text!r}")
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in codes[:3]]
    return (ctypes.c_float * 4)(*linear, *(codes[3:] or [1.0]))


def settings_dict(settings) -> dict:
    """All settings by the names of halflit_settings."""
    values = {}
    for name, _ in settings._fields_:
        value = getattr(settings, name)
        if name in ("size", "reserved"):
            continue
        if name in _CHOICES:
            value = {number: text for text, number in _c.choices(_CHOICES[name]).items()}[value]
        elif name == "lobe":
            value = Lobe._of(value).to_dict()
        elif isinstance(value, ctypes.Structure):
            value = tuple(getattr(value, member) for member, _ in value._fields_)
        values[name] = tuple(value) if isinstance(value, ctypes.Array) else value
    return values


_CALLING = threading.local()  # lock: of the scene whose frame calls a function in this thread


class SceneLock:
    """One thread at a time uses a scene. The functions that a frame of it calls cannot: the frame would wait for itself."""

    def __init__(self) -> None:
        self._lock = threading.RLock()

    def __enter__(self) -> None:
        if getattr(_CALLING, "lock", None) is self:
            raise UsageError("progress and cancelled cannot use the scene that is drawn")
        self._lock.acquire()

    def __exit__(self, *_) -> None:
        self._lock.release()


class Execution:
    """A halflit_execution for the keywords. An exception in progress() or cancelled() stops the frame, and is raised after it.

    lock: of the scene, which the frame holds while it waits for the functions.
    """

    def __init__(self, options: dict, lock: SceneLock):
        self.lock = lock
        self.struct = struct = _c.make("execution")
        self.raised: BaseException | None = None
        self.key = tuple(options.get(name) for name in EXECUTION)
        for name, member in (("threads", "threads"), ("tile_size", "tile_size"), ("time_limit", "time_limit_s"), ("memory_limit",) * 2):
            if options.get(name) is not None:
                setattr(struct, member, options[name])
        if options.get("isa") is not None:
            struct.isa = _c.bytes_of(options["isa"])
        progress, cancelled = options.get("progress"), options.get("cancelled")
        self.has_functions = progress is not None or cancelled is not None
        if self.has_functions:
            struct.progress = _c.Progress(lambda _, share: self._guarded(progress, share) and None)
            struct.cancelled = _c.Cancelled(lambda _: 1 if self.raised or self._guarded(lambda: bool(cancelled and cancelled())) or self.raised else 0)

    @contextlib.contextmanager
    def interrupts(self) -> Iterator[None]:
        """While the library calls functions, Ctrl-C ends the frame: an exception at the begin of such a call would be lost in ctypes."""
        in_main = threading.current_thread() is threading.main_thread()
        if not (self.has_functions and in_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler):
            yield
            return

        def note(*_) -> None:
            self.raised = self.raised or KeyboardInterrupt()

        signal.signal(signal.SIGINT, note)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _guarded(self, function, *arguments):
        before = getattr(_CALLING, "lock", None)
        _CALLING.lock = self.lock
        try:
            return function(*arguments) if function is not None and self.raised is None else None
        except BaseException as error:  # KeyboardInterrupt too: the frame ends, then it is raised
            self.raised = error
            return None
        finally:
            _CALLING.lock = before
