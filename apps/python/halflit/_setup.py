"""Chooses what the keywords of the view leave open: camera, light and exposure."""
from __future__ import annotations

import ctypes
import math
import re
from typing import Any, Dict, Iterable, List, NoReturn, Optional, Tuple

from . import _c
from ._camera import Camera
from ._color import color
from ._errors import UsageError
from ._lazy import np
from ._options import VIEW, WHOLE_SCENE, check_names
from ._record import chosen
from ._values import checked_size, finite, listed, real, shown, sized
from ._views import check_view_of, has_parallel_rays, margins, views_of


class Setup:
    """The choice of Scene.setup(): size, camera, light and settings. render(setup=...) draws by it again, whatever has moved since."""

    def __init__(self, camera: Camera, settings: Any, lighting: Any, size: Tuple[int, int], mark: object) -> None:
        self.size = size  #: width, height
        self._camera = camera
        self._settings = settings
        self._lighting = lighting
        self._mark = mark  # of its scene, which it does not keep alive

    @property
    def camera(self) -> Camera:
        """The camera; a copy."""
        return self._camera.copy()

    @property
    def exposure(self) -> float:
        """Factor on all light."""
        return float(self._settings.exposure)

    def __repr__(self) -> str:
        return f"<halflit.Setup of {self.size[0]} x {self.size[1]} pixels, exposure {self.exposure:.4g}, {self._camera!r}>"

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        raise TypeError("a halflit.Setup cannot be copied or pickled: it belongs to its scene")

    def _seen_by(self, camera: Camera) -> Setup:
        """The same light and size with another camera."""
        return Setup(camera, self._settings, self._lighting, self.size, self._mark)


class Request:
    """A halflit_picture_request, with what it points to: a camera, and the name of one of the scene."""

    def __init__(self, struct: Any, camera: Optional[Camera], name: Optional[str]) -> None:
        self.struct = struct
        self.camera = camera
        struct.camera = None if camera is None else ctypes.addressof(camera._c)
        struct.scene_camera = None if name is None else _c.bytes_of(name, "camera")
        self.name = name

    @property
    def key(self) -> Tuple[Any, ...]:
        """Equal requests have equal keys. The pointers at the structs' begin do not count."""
        pointer = ctypes.sizeof(ctypes.c_size_t)
        return (
            bytes(self.struct)[3 * pointer :],
            self.name,
            None if self.camera is None else bytes(self.camera._c)[2 * pointer :],
        )


def check_view(options: Iterable[str]) -> None:
    """Refuses what setup() does not keep."""
    check_names(options, [name for name in VIEW if name != "setup"], "setup")


def exposure_of(options: Dict[Any, Any]) -> Tuple[Optional[float], float]:
    """The factor that exposure or ev says, None: neither; and the stops that are added to it."""
    exposure, ev = options.get("exposure"), options.get("ev")
    if exposure is not None and ev is not None:
        raise UsageError("ev: cannot be combined with exposure, which is 2 ** ev")
    if isinstance(ev, str):
        stops = re.fullmatch(r"auto([+-][0-9]*\.?[0-9]+)?", ev)
        if stops is None or not -64 <= float(stops[1] or 0) <= 64:
            raise UsageError(f"ev: expected a number from -64 to 64, 'auto', or as 'auto+1' and 'auto-0.5', found {ev!r}")
        return None, float(stops[1] or 0)
    if ev is not None:
        if not -64 <= real(ev, "ev") <= 64:
            raise UsageError(f"ev: expected -64 to 64, found {ev!r}")
        return float(2.0 ** ctypes.c_float(ev).value), 0.0
    if isinstance(exposure, str):
        raise UsageError(f"exposure: expected a factor above 0, found {exposure!r}; ev takes stops and 'auto+1'")
    if exposure is not None and not 0 < real(exposure, "exposure") < math.inf:
        raise UsageError(f"exposure: expected a factor above 0, found {exposure!r}")
    return exposure, 0.0


def request_of(scene: Any, size: Optional[Tuple[int, int]], options: Dict[Any, Any]) -> Request:
    struct, given = _c.make("picture_request"), options.get("camera")
    whole_scene = [name for name in WHOLE_SCENE if options.get(name) is not None]
    if whole_scene:
        check_view_of(options, size)
    struct.frame = bool(whole_scene) or (isinstance(given, str) and given == "frame")
    camera, scene_camera = None, None
    if given is not None and not (isinstance(given, str) and given == "frame"):
        if isinstance(given, (str, int, np.integer)):
            scene_camera = str(given)
        else:
            camera = given_camera(given).copy()
    for name, member in (("azimuth", "azimuth_deg"), ("elevation", "elevation_deg"), ("zoom", "zoom"), ("fov", "fov_y_deg")):
        if name in whole_scene:
            struct.put(member, finite(options[name], name), name)
    if options.get("view") is not None:
        camera = views_of(scene, [options["view"]], size, options)[0]
    elif options.get("fit") is not None:
        struct.margin_x, struct.margin_y = margins(options["fit"], size)
    struct.orthographic = has_parallel_rays(options)
    exposure, struct.exposure_compensation_ev = exposure_of(options)
    struct.exposure = exposure or 0.0
    light_of(scene, options, struct)
    return Request(struct, camera, scene_camera)


def light_of(scene: Any, options: Dict[Any, Any], struct: Any) -> None:
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
    struct.studio_turn_rad = 0.0 if turn is None else math.radians(finite(turn, "studio_turn"))


def given_camera(given: Any) -> Camera:
    """A camera that a caller gives, checked."""
    camera = given if isinstance(given, Camera) else Camera(given)
    camera._check()
    return camera


def set_up(scene: Any, request: Request) -> Setup:
    """Calls halflit_choose_picture."""
    camera, settings, size = Camera(), _c.make("settings"), (ctypes.c_int32 * 2)()
    scene._check_open()
    lighting = _c.Handle(
        "choose_picture", "lighting_destroy", scene._handle, *map(ctypes.byref, (request.struct, size, camera._c, settings))
    )
    return Setup(camera, settings, lighting, (size[0], size[1]), scene._mark)


def choose(scene: Any, size: Any, options: Dict[Any, Any]) -> Setup:
    """The setup for the keywords: that of the last frame if nothing has changed."""
    scene._check_open()
    size = None if size is None else checked_size(size)
    request = request_of(scene, size, options)
    if size is not None:
        request.struct.width, request.struct.height = size
    key = (scene._changes, *request.key)
    if scene._chosen is None or scene._chosen[1] != key:
        scene._chosen = set_up(scene, request), key
    found: Setup = scene._chosen[0]
    return found


def choose_for_all(scene: Any, size: Any, poses: Any, bounds: Any, options: Dict[str, Any]) -> Setup:
    """The setup whose camera contains the scene in all poses, and the box."""
    if options.get("camera") is not None:
        raise UsageError("poses, bounds: cannot be combined with camera, which they make")
    boxes = [] if bounds is None else [checked_box(bounds)]
    boxes += boxes_of_poses(scene, [] if poses is None else poses)
    if not boxes:
        raise UsageError("poses: expected one in which something is drawn")
    low, high = np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)
    middle, half = (low + high) / 2, np.maximum((high - low) / 2, 1e-6 * np.abs(high - low).max() or 1e-6)
    of_box = type(scene)(up=scene.up)  # around its own origin, where float32 is exact enough
    of_box.add_mesh(np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half, topology="points")
    camera = choose(of_box, size, options).camera
    matrix = camera.matrix
    matrix[:3, 3] += middle
    camera.matrix = matrix
    rest = {name: value for name, value in options.items() if name not in WHOLE_SCENE}
    return choose(scene, size, {**rest, "camera": camera})._seen_by(camera)


def checked_box(bounds: Any) -> Any:
    from ._arrays import numbers

    box = numbers(bounds, np.float64, "bounds")
    if box.shape != (2, 3) or not np.isfinite(box).all() or (box[0] > box[1]).any():
        raise UsageError(f"bounds: expected the least and the largest corner of a box, (2, 3), found {shown(bounds)}")
    return box


def boxes_of_poses(scene: Any, poses: Iterable[Any]) -> List[Any]:
    """The boxes of the scene in these poses. Matrices are put back."""
    from ._arrays import matrices

    boxes: List[Any] = []
    before: List[Any] = []
    for pose in listed(poses, "poses", "functions that pose the scene, or matrices (n, 4, 4)"):
        if callable(pose):
            pose()
        else:
            pose = matrices(pose, "poses")
            before += [scene.instance(i)[1] for i in range(len(before), len(pose))]
            scene.set_instances(pose)
        if scene.bounds is not None:
            boxes.append(scene.bounds)
    if before:
        scene.set_instances(before)
    return boxes


def kept(scene: Any, size: Any, options: Dict[Any, Any]) -> Setup:
    """The setup that the caller keeps."""
    scene._check_open()
    setup = options["setup"]
    if not isinstance(setup, Setup):
        raise UsageError(f"setup: expected what Scene.setup() returned, found {shown(setup)}")
    if setup._mark is not scene._mark:
        raise UsageError("setup: expected one of this scene, found one of another scene, whose light it has")
    others = [name for name in VIEW if name not in ("setup", "exposure", "ev") and options.get(name) is not None]
    if others:
        raise UsageError(f"setup: cannot be combined with {', '.join(others)}, which it has chosen")
    if size is not None and checked_size(size) != setup.size:
        raise UsageError(f"setup: made for {setup.size[0]} x {setup.size[1]} pixels")
    return setup
