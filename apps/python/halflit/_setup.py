"""What the keywords of the view leave open: camera, light and exposure."""
from __future__ import annotations

import ctypes
import math
from typing import Iterable, Optional, Tuple

from . import _c
from ._camera import Camera
from ._color import color
from ._errors import UsageError
from ._lazy import np
from ._options import VIEW, check_names
from ._record import chosen
from ._values import real, shown, sized, truth
from ._world import World

USUAL = (1280, 720)  # the program's size


class Setup:
    """What Scene.setup() chose: camera and settings. render(setup=...) draws by it again, whatever has moved since."""

    def __init__(self, camera: Camera, settings, request: Request, size: Tuple[int, int]):
        self.size = size  #: width, height
        self._camera = camera  # in the file's world
        self._settings = settings
        self._request = request

    @property
    def camera(self) -> Camera:
        """The camera; a copy."""
        return self._camera.copy()

    @property
    def exposure(self) -> float:
        """Factor on all light."""
        return self._settings.exposure


class Request:
    """A halflit_setup_options, and the camera, in the world that is drawn, that it points to."""

    def __init__(self, struct, camera: Optional[Camera]):
        self.struct = struct
        self.camera = camera
        struct.camera = None if camera is None else ctypes.addressof(camera._c)

    @property
    def key(self) -> tuple:
        """Equal requests have equal keys. The pointers at the structs' begin do not count."""
        pointers = ctypes.sizeof(ctypes.c_size_t) + ctypes.sizeof(ctypes.c_void_p)
        return bytes(self.struct)[pointers:], None if self.camera is None else bytes(self.camera._c)[pointers:]

    def by(self, camera: Camera) -> Request:
        """The same with this camera."""
        struct = type(self.struct).from_buffer_copy(self.struct)
        struct.frame = 0
        return Request(struct, camera)


def check_view(options: Iterable[str]) -> None:
    """Refuses what setup() does not keep."""
    check_names(options, [name for name in VIEW if name != "setup"], "setup")


def checked_size(size) -> Tuple[int, int]:
    if isinstance(size, (int, np.integer)):
        size = (size, size)
    found = sized(size, "size")
    if len(found) != 2:
        raise UsageError(f"size: expected (width, height) in pixels, or the side of a square, found {shown(size)}")
    width, height = found
    if min(width, height) < 1 or width * height > 2**28:
        raise UsageError(f"size: expected 1 to 2^28 pixels, found {width} x {height}")
    return width, height


def shaped(camera: Camera) -> Tuple[int, int]:
    """The largest size with the camera's aspect ratio that fits into the usual one."""
    aspect = camera._shape()
    if not 1e-3 < aspect < 1e3:
        return USUAL
    fitted = min(float(USUAL[0]), USUAL[1] * aspect)
    return max(1, int(fitted + 0.5)), max(1, int(fitted / aspect + 0.5))


def exposure_of(options: dict) -> Optional[float]:
    """The factor that exposure or ev says; None: neither."""
    exposure, ev = options.get("exposure"), options.get("ev")
    if exposure is not None and ev is not None:
        raise UsageError("ev: cannot be combined with exposure, which is 2 ** ev")
    if ev is not None:
        if not -64 <= real(ev, "ev") <= 64:
            raise UsageError(f"ev: expected -64 to 64, found {ev!r}")
        return 2.0 ** ctypes.c_float(ev).value
    if exposure is not None and not 0 < real(exposure, "exposure") < math.inf:
        raise UsageError(f"exposure: expected a factor above 0, found {exposure!r}")
    return exposure


def request_of(scene, options: dict) -> Request:
    struct, given = _c.make("setup_options"), options.get("camera")
    whole_scene = [name for name in ("azimuth", "elevation", "zoom", "fov", "orthographic") if options.get(name) is not None]
    struct.frame = bool(whole_scene) or (isinstance(given, str) and given == "frame")
    camera = None
    if given is not None and not (isinstance(given, str) and given == "frame"):
        if whole_scene:
            raise UsageError(f"camera: cannot be combined with {', '.join(whole_scene)}, which make a camera of their own")
        camera = scene._world.into(camera_of(scene, given))
    for name, member in (("azimuth", "azimuth_deg"), ("elevation", "elevation_deg"), ("zoom", "zoom"), ("fov", "fov_y_deg")):
        if name in whole_scene:
            struct.put(member, options[name], name)
    struct.orthographic = truth(options.get("orthographic") or False, "orthographic")
    struct.exposure = exposure_of(options) or 0.0
    light_of(scene, options, struct)
    return Request(struct, camera)


def light_of(scene, options: dict, struct) -> None:
    """Writes the keywords of the light that is chosen."""
    # Lights that the caller adds get a share of the studio, as those of the program's --light.
    studio = "under_lights" if scene._own_lights else "for_dark"
    if options.get("ambient") is not None:
        struct.own_ambient, struct.ambient_color = 1, (ctypes.c_float * 3)(*color(options["ambient"], "ambient", 3))
        studio = "never"
    given = options.get("studio")
    if isinstance(given, str):
        studio = given
    elif given is not None:
        struct.put("studio", given, "studio")
    if given is None or isinstance(given, str):
        struct.studio = chosen(studio, "STUDIO", "studio")
    turn = options.get("studio_turn")
    struct.studio_turn_rad = 0.0 if turn is None else math.radians(real(turn, "studio_turn"))


def camera_of(scene, given) -> Camera:
    """The camera that a caller names, in the file's world."""
    if not isinstance(given, (str, int, np.integer)):
        camera = given if isinstance(given, Camera) else Camera(given)
        camera._check()
        return camera
    cameras, name = scene.cameras, str(given)
    for camera in cameras:
        if camera.name == name:
            return camera
    if name.isdecimal() and int(name) < len(cameras):
        return cameras[int(name)]
    raise UsageError(f"camera: expected a name or an index below {len(cameras)}, found {given!r}")


def set_up(scene, size: Tuple[int, int], request: Request) -> Setup:
    """Calls halflit_setup, which puts the light that is chosen into the library's scene, in the place of that of the last call."""
    camera, settings = Camera(), _c.make("settings")
    scene._lit_by = scene._lit_key = None
    scene._call("setup", *size, ctypes.byref(request.struct), ctypes.byref(camera._c), ctypes.byref(settings))
    setup = Setup(scene._world.out(camera), settings, request.by(camera), size)
    scene._lit_by = setup
    return setup


def choose(scene, size, options: dict) -> Setup:
    """The setup for the keywords: that of the last frame if nothing has changed."""
    scene._check_open()
    request = request_of(scene, options)
    asked = None if size is None else checked_size(size)
    key = (scene._changes, asked, *request.key)
    if scene._lit_by is not None and scene._lit_key == key:
        return scene._lit_by
    setup = set_up(scene, asked or USUAL, request)
    if asked is None and not request.struct.frame:
        fitted = shaped(drawn_camera(scene._world, setup))
        if fitted != USUAL:
            setup = set_up(scene, fitted, request)
    scene._lit_key = key
    return setup


def kept(scene, size, options: dict) -> Setup:
    """The setup that the caller keeps. Its light is put into the scene again if another setup, or a change of light, took it away."""
    scene._check_open()
    setup = options["setup"]
    if not isinstance(setup, Setup):
        raise UsageError(f"setup: expected what Scene.setup() returned, found {shown(setup)}")
    others = [name for name in VIEW if name not in ("setup", "exposure", "ev") and options.get(name) is not None]
    if others:
        raise UsageError(f"setup: cannot be combined with {', '.join(others)}, which it has chosen")
    if size is not None and checked_size(size) != setup.size:
        raise UsageError(f"setup: made for {setup.size[0]} x {setup.size[1]} pixels")
    if scene._lit_by is not setup:
        # The studio turns with the camera, so the light is chosen for the camera of this setup.
        set_up(scene, setup.size, setup._request.by(scene._world.into(setup._camera)))
        scene._lit_by = setup
    return setup


def drawn_camera(world: World, setup: Setup) -> Camera:
    """The setup's camera in the world that is drawn."""
    return world.into(setup._camera)
