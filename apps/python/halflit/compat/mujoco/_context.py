"""The part of MuJoCo's interface that draws: contexts, rectangles and the functions mjr_..."""
from __future__ import annotations

import ctypes
import enum
import itertools
import operator
import threading
from typing import Any, Callable, Dict, List, Optional, Sequence, Set, Tuple

import numpy as np

from halflit import _c
from halflit._errors import UsageError, warn
from halflit._types import Array

from ._models import checked_threads, handle_of, look_of
from ._scenes import Snapshot, version_of_scene

WINDOW, DISTANCE = _c.CONSTANTS["HALFLIT_MUJOCO_DEPTH_WINDOW"], _c.CONSTANTS["HALFLIT_MUJOCO_DEPTH_DISTANCE"]
SEGMENT, COLOR = _c.CONSTANTS["HALFLIT_MUJOCO_PASS_SEGMENT"], _c.CONSTANTS["HALFLIT_MUJOCO_PASS_COLOR"]

Rect = Tuple[int, int, int, int]
#: Pictures of the buffer that are kept, each as a copy of its scene.
_MOST_FRAMES = 64


class mjtFramebuffer(enum.IntEnum):
    mjFB_WINDOW, mjFB_OFFSCREEN = 0, 1


class mjtDepthMap(enum.IntEnum):
    mjDEPTH_ZERONEAR, mjDEPTH_ZEROFAR = 0, 1


class mjtFont(enum.IntEnum):
    mjFONT_NORMAL, mjFONT_SHADOW, mjFONT_BIG = 0, 1, 2


class mjtFontScale(enum.IntEnum):
    mjFONTSCALE_50, mjFONTSCALE_100, mjFONTSCALE_150, mjFONTSCALE_200, mjFONTSCALE_250, mjFONTSCALE_300 = 50, 100, 150, 200, 250, 300


class mjtGridPos(enum.IntEnum):
    mjGRID_TOPLEFT, mjGRID_TOPRIGHT, mjGRID_BOTTOMLEFT, mjGRID_BOTTOMRIGHT = 0, 1, 2, 3
    mjGRID_TOP, mjGRID_BOTTOM, mjGRID_LEFT, mjGRID_RIGHT = 4, 5, 6, 7


class GLContext:
    """Stands for a context of OpenGL, of which there is none."""

    def __init__(self, max_width: int = 0, max_height: int = 0, device_id: int = -1) -> None:
        pass

    def make_current(self) -> None:
        """Does nothing."""

    def free(self) -> None:
        """Does nothing."""


class MjrRect:
    """A part of the buffer, pixels; the first row is the bottom one."""

    __slots__ = ("left", "bottom", "width", "height")

    def __init__(self, left: int, bottom: int, width: int, height: int) -> None:
        self.left, self.bottom, self.width, self.height = int(left), int(bottom), int(width), int(height)

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, MjrRect) and _rect(self) == _rect(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"MjrRect(left={self.left}, bottom={self.bottom}, width={self.width}, height={self.height})"


def _rect(viewport: Any) -> Rect:
    return int(viewport.left), int(viewport.bottom), int(viewport.width), int(viewport.height)


def _holds(outer: Rect, inner: Rect) -> bool:
    return all(outer[i] <= inner[i] and inner[i] + inner[i + 2] <= outer[i] + outer[i + 2] for i in (0, 1))


class Defaults:
    """Of contexts that are made without a look or a number of threads; install() sets them."""

    look: Optional[str] = None
    threads = 0


class MjrContext:
    """A model's shapes and textures, and what was drawn last. They are copied at the first picture, and again after mjr_uploadTexture() and
    its like. look: the release whose pictures are made, "2.2" or later; None: by the version of the module that the model is
    from. threads: 0: all cores. Pictures are drawn when they are read, from a copy of the scene: what is not read takes no time. The buffer
    holds the last 64 pictures that no later one covers.
    """

    def __init__(self, model: Any = None, fontscale: Any = 150, *, look: Optional[str] = None, threads: Optional[int] = None) -> None:
        self.model = model
        self.threads = checked_threads(Defaults.threads if threads is None else threads)
        self.fontScale = int(fontscale)
        self.lineWidth, self.shadowClip, self.shadowScale, self.fogStart, self.fogEnd = 1.0, 0.0, 0.0, 0.0, 0.0
        self.fogRGBA = np.zeros(4, np.float32)
        self.shadowSize, self.offWidth, self.offHeight, self.offSamples, self.ntexture, self.nskin = 0, 800, 600, 0, 0, 0
        self.windowAvailable, self.windowSamples, self.windowStereo, self.windowDoublebuffer = 0, 0, 0, 0
        self.currentBuffer, self.readPixelFormat, self.readDepthMap = mjtFramebuffer.mjFB_WINDOW, 0x1907, mjtDepthMap.mjDEPTH_ZERONEAR
        self.charHeight, self.charHeightBig = 0, 0
        self.auxWidth, self.auxHeight, self.auxSamples = (np.zeros(10, np.int32) for _ in range(3))
        self.glInitialized = int(model is not None)
        self._version = version_of_scene(model)
        self.look = look_of(Defaults.look if look is None else look, self._version)
        self._lock = threading.Lock()
        self._handle: Any = None
        self._is_stale = True
        self._sizes: Optional[Dict[str, int]] = None
        self._frames: List[Snapshot] = []
        self._spare: List[Snapshot] = []
        self._picture: Any = None
        if model is not None:
            visual, extent = model.vis, float(model.stat.extent)
            self.lineWidth, self.shadowScale = float(visual.global_.linewidth), float(visual.map.shadowscale)
            self.shadowClip = extent * float(visual.map.shadowclip)
            self.fogStart, self.fogEnd = extent * float(visual.map.fogstart), extent * float(visual.map.fogend)
            self.fogRGBA[:] = visual.rgba.fog
            self.shadowSize, self.offSamples = int(visual.quality.shadowsize), int(visual.quality.offsamples)
            self.offWidth, self.offHeight = int(visual.global_.offwidth), int(visual.global_.offheight)
            self.ntexture, self.nskin = int(model.ntex), int(model.nskin)
        self._settings = self._made_with = self._current()

    def free(self) -> None:
        """Frees what was copied. Nothing can be drawn with this context after that."""
        self.glInitialized, self._handle = 0, None
        self._frames, self._spare = [], []

    # ---- for this package -----------------------------------------------------------------------------------------------

    def _current(self) -> Dict[str, Any]:
        """Members of this object that a caller may set, as halflit_mujoco_model has them."""
        extent = (float(self.model.stat.extent) if self.model is not None else 1.0) or 1.0
        return {
            "linewidth": self.lineWidth, "shadowscale": self.shadowScale, "shadowsize": int(self.shadowSize),
            "fog_rgba": tuple(self.fogRGBA), "shadowclip": self.shadowClip / extent,
            "fogstart": self.fogStart / extent, "fogend": self.fogEnd / extent,
        }  # fmt: skip

    def upload(self) -> None:
        """The model is copied again at the next picture. Pictures that were taken before keep the older copy."""
        self._is_stale = True

    def snapshot(self, scene: Any) -> Snapshot:
        """A copy of what the scene shows now."""
        if not self.glInitialized:
            raise RuntimeError("the context has no model, or was freed")
        current = self._current()
        if self._is_stale or current != self._made_with:
            changed = {name: value for name, value in current.items() if value != self._settings[name]}
            self._handle = handle_of(self.model, self._version, self.look, self.threads, scene, changed)
            self._made_with, self._is_stale, self._sizes = current, False, None
        snapshot = (self._spare.pop() if self._spare else Snapshot()).take(scene)
        if self._sizes is None and snapshot.sizes.get("skinvert", 0) in (0, 12 * int(getattr(self.model, "nskinvert", 0))):
            self._sizes = snapshot.sizes
        if snapshot.sizes != self._sizes:  # the library reads as many vertices as its copy of the model has
            raise UsageError("the scene has other skins or flexes than the context's model")
        snapshot.handle = self._handle
        if snapshot.is_wireframe:
            _warn_once("mjRND_WIREFRAME does nothing: surfaces are drawn")
        return snapshot

    def release(self, snapshot: Snapshot) -> None:
        snapshot.handle = None
        self._spare.append(snapshot)

    def picture(self, snapshot: Snapshot, **members: Any) -> Any:
        """A halflit_mujoco_picture of the snapshot. Arrays are not checked."""
        picture = _c.make("mujoco_picture")
        picture.scene = snapshot.address
        picture.samples = 1 if self.offSamples <= 1 else 4
        for name, value in members.items():
            picture.put(name, value.ctypes.data if isinstance(value, np.ndarray) else value, name)
        return picture

    def draw(self, pictures: Any, snapshots: Sequence[Snapshot]) -> None:
        """Draws an array of halflit_mujoco_picture, or one, of these snapshots."""
        first = 0
        with self._lock:
            for handle, group in itertools.groupby(snapshots, operator.attrgetter("handle")):
                count = len(list(group))
                _c.call("mujoco_render", handle, ctypes.byref(pictures, first * ctypes.sizeof(_c.STRUCT["halflit_mujoco_picture"])), count)
                first += count

    def render(self, rect: Rect, scene: Any) -> None:
        if rect[2] <= 0 or rect[3] <= 0:
            return
        frame = self.snapshot(scene)
        frame.rect = rect
        shown = [other for other in self._frames if not _holds(rect, other.rect)]
        # What ends before the first pixel is in no buffer.
        kept = [*shown, frame][-_MOST_FRAMES:] if rect[0] + rect[2] > 0 and rect[1] + rect[3] > 0 else shown
        for other in (*self._frames, frame):
            if other not in kept:
                self.release(other)
        self._frames = kept

    def read(self, rect: Rect, rgb: Any, depth: Any) -> None:
        last = self._frames[-1] if self._frames else None
        if last is not None and last.rect == rect:
            self._read_frame(last, rgb, depth)
            return
        for planes, empty in ((rgb, 0), (depth, 0 if int(self.readDepthMap) else 1)):
            if planes is not None:
                planes[:] = empty
        for frame in self._frames:  # those that are read in part
            left, bottom = max(rect[0], frame.rect[0]), max(rect[1], frame.rect[1])
            width = min(rect[0] + rect[2], frame.rect[0] + frame.rect[2]) - left
            height = min(rect[1] + rect[3], frame.rect[1] + frame.rect[3]) - bottom
            if width <= 0 or height <= 0:
                continue
            size = frame.rect[:1:-1]
            whole = (None if rgb is None else np.empty((*size, 3), np.uint8), None if depth is None else np.empty(size, np.float32))
            self._read_frame(frame, *whole)
            row, column = bottom - frame.rect[1], left - frame.rect[0]
            for planes, part in zip((rgb, depth), whole):
                if part is not None:
                    planes[bottom - rect[1] :, left - rect[0] :][:height, :width] = part[row : row + height, column : column + width]

    def _read_frame(self, frame: Snapshot, rgb: Any, depth: Any) -> None:
        is_reversed = depth is not None and int(self.readDepthMap) == mjtDepthMap.mjDEPTH_ZEROFAR
        picture = self._picture = self._picture or self.picture(frame, bottom_up=1)
        picture.scene, picture.width, picture.height = frame.address, frame.rect[2], frame.rect[3]
        picture.rgb = None if rgb is None else rgb.ctypes.data
        picture.depth = None if depth is None else depth.ctypes.data
        picture.samples = 1 if self.offSamples <= 1 else 4
        picture.depth_unit = DISTANCE if is_reversed else WINDOW
        picture.depth_pass = SEGMENT if frame.is_segment else COLOR
        self.draw(picture, [frame])
        if is_reversed:
            near, far, is_parallel = frame.planes()
            distance = depth.astype(np.float64)
            depth[:] = np.clip((far - distance) / (far - near) * (1 if is_parallel else near / distance), 0, 1)


def mjr_render(viewport: Any, scn: Any, con: MjrContext) -> None:
    """Takes a picture of the scene into that part of the buffer."""
    con.render(_rect(viewport), scn)


def mjr_readPixels(rgb: Any, depth: Any, viewport: Any, con: MjrContext) -> None:
    """Pixels of the buffer, bottom row first. rgb: uint8, three a pixel; depth: float32, one a pixel; None: it is not read."""
    rect = _rect(viewport)
    con.read(rect, _pixels(rgb, "rgb", np.uint8, (rect[3], rect[2], 3)), _pixels(depth, "depth", np.float32, (rect[3], rect[2])))


def _pixels(given: Any, name: str, kind: Any, shape: Tuple[int, ...]) -> Optional[Array]:
    """The caller's memory, as an array of that shape."""
    if given is None:
        return None
    array = np.asarray(given)
    count = int(np.prod(shape))
    if array.dtype != kind or array.size < count or not array.flags.c_contiguous or not array.flags.writeable:
        found = f"found {array.dtype} {array.shape}"
        raise UsageError(f"{name}: expected a writeable array of {np.dtype(kind)} without gaps, of {count} numbers, {found}")
    return array.reshape(-1)[:count].reshape(shape)


def mjr_setBuffer(framebuffer: int, con: MjrContext) -> None:
    """Sets currentBuffer. There is one buffer, which both names mean: nothing is shown in a window."""
    con.currentBuffer = mjtFramebuffer(int(framebuffer))


def mjr_restoreBuffer(con: MjrContext) -> None:
    """Does nothing."""


def mjr_resizeOffscreen(width: int, height: int, con: MjrContext) -> None:
    """Sets offWidth and offHeight. The buffer has no size of its own."""
    con.offWidth, con.offHeight = int(width), int(height)


def mjr_maxViewport(con: MjrContext) -> MjrRect:
    """The whole buffer."""
    return MjrRect(0, 0, con.offWidth, con.offHeight)


def mjr_uploadTexture(m: Any, con: MjrContext, texid: int) -> None:
    """The model's textures, meshes and height fields are copied again for the next picture."""
    con.upload()


mjr_uploadMesh = mjr_uploadHField = mjr_uploadTexture


def mjr_changeFont(fontscale: int, con: MjrContext) -> None:
    """Sets fontScale."""
    con.fontScale = int(fontscale)


def mjr_finish() -> None:
    """Does nothing."""


def mjr_getError() -> int:
    """0: there is none."""
    return 0


def mjr_findRect(x: int, y: int, nrect: int, rect: Any) -> int:
    """The first of the rectangles that has the pixel; -1: none."""
    found = (i for i in range(nrect) if _holds(_rect(rect[i]), (x, y, 1, 1)))
    return next(found, -1)


_warned: Set[str] = set()


def _warn_once(text: str) -> None:
    if text not in _warned:
        _warned.add(text)
        warn(text)


def _left_out(name: str, what: str) -> Callable[..., None]:
    def nothing(*_: Any, **__: Any) -> None:
        _warn_once(f"{name}() does nothing: {what}")

    nothing.__name__ = nothing.__qualname__ = name
    nothing.__doc__ = f"Does nothing, and warns once: {what}."
    return nothing


_TEXT, _BUFFERS = "texts and figures are not drawn over pictures", "there is one buffer, and no window"
mjr_overlay, mjr_text, mjr_figure = _left_out("mjr_overlay", _TEXT), _left_out("mjr_text", _TEXT), _left_out("mjr_figure", _TEXT)
mjr_label, mjr_rectangle = _left_out("mjr_label", _TEXT), _left_out("mjr_rectangle", _TEXT)
mjr_addAux, mjr_setAux = _left_out("mjr_addAux", _BUFFERS), _left_out("mjr_setAux", _BUFFERS)
mjr_blitAux, mjr_blitBuffer = _left_out("mjr_blitAux", _BUFFERS), _left_out("mjr_blitBuffer", _BUFFERS)
mjr_drawPixels = _left_out("mjr_drawPixels", _BUFFERS)
