"""Scenes."""
from __future__ import annotations

import ctypes
import os
from typing import Any, Dict, Iterable, Iterator, List, Literal, Optional, Sequence, Tuple, Union

from . import _c
from ._camera import Camera
from ._geometry import Geometry
from ._lazy import np
from ._lazy_picture import pictures
from ._lighting import Lighting
from ._picture_options import PictureOptions, ViewOptions
from ._setup import Setup
from ._turntable import Turntable
from ._loading import Source, loading, made_or_added, sum_of
from ._types import Array, BatchLight, Size, Unpack, Up, ViewOf
from ._values import UP_AXES, finite, listed, up_axis, whole

_CAMERAS = "a list of cameras, or of (azimuth, elevation)"


class Scene(Geometry, Lighting):
    """Everything that a picture shows: meshes, instances of them, materials, textures, lights, cameras.

    Scene() is empty; Scene.load(), Scene.demo() and Scene.from_trimesh() make others. Indices begin at 0. All coordinates, of cameras,
    lights, bounds, matrices and planes, are those of the file or of the arrays; the axis that points up decides what views call top and
    front, where the ground is and where light comes from. Matrices are 4 x 4 arrays with the translation in the last column. Colours are
    linear light with Rec. 709 primaries, "#rrggbb", or uint8 sRGB codes. Arrays are read during the call; float32 arrays of the right
    shape, and int32 or uint32 faces, are handed over without a copy.

    Threads may use a scene at once: they wait for each other. Different scenes are drawn side by side.
    """

    def __init__(self, up: Optional[Up] = None) -> None:
        """An empty scene. up: the axis that points up: "x", "y", "z", "-x", "-y" or "-z"; None: y, or that of the first file that is added."""
        self._start(_c.Handle("scene_create", "scene_destroy"))
        if up is not None:
            self._call("scene_set_up", up_axis(up))

    @classmethod
    def _of(cls, handle: _c.Handle) -> Scene:
        scene = cls.__new__(cls)
        scene._start(handle)
        return scene

    @made_or_added
    def load(
        cls,
        source: Source,
        *,
        animation: Union[str, int, None] = None,
        time: float = 0.0,
        scene: Union[str, int, None] = None,
        variant: Optional[str] = None,
        keep_animations: bool = False,
        base_dir: Union[str, os.PathLike[Any], None] = None,
        recentre: bool = True,
        up: Optional[Up] = None,
        **options: Any,
    ) -> Scene:
        """A scene of a model's file (glTF, STL, PLY, OBJ, 3MF and others), of its bytes, or of a file object that is open in binary mode.
        The content tells the format. Called on a scene, it adds the file to that, as add_file() does, and returns it.

        animation: name or index of the animation that poses it (the first), or "none"; time: seconds.
        scene: name or index of the file's scene. variant: of the file's materials.
        keep_animations: for pose(). base_dir: folder of files that bytes refer to; without it none is read.
        recentre: a model that is far from the origin is drawn near it, and a tiny or huge one in another size, so that float32 keeps its
        shape. All that is given and asked for stays in the file's own coordinates.
        up: axis of the model that points up, "x", "y", "z", "-x", "-y" or "-z". The usual one is z for STL, 3MF and CAD files, y for others.
        Other keywords are members of halflit_load_options, such as strict=True, crease_deg=60, time_limit_s=10, max_texture_side=4096 or
        allow_external="/models/shared", a folder or a list of folders in which the model's files may lie too. detail_px: how fine STEP
        files become triangles. importers=".ext=PROGRAM": a program, or a list of some, that turns such files into glTF.
        """
        keywords: Dict[str, Any] = dict(animation=animation, time=time, scene=scene, variant=variant, recentre=recentre, up=up)
        keywords["keep_animations"] = keep_animations
        name, arguments = loading(source, base_dir, {**keywords, **options})
        made = cls._of(_c.Handle("scene_" + name.replace("add_file", "load"), "scene_destroy", *arguments))
        if keep_animations:
            again = arguments[0] if name == "add_file_memory" else os.path.abspath(os.fsdecode(arguments[0]))
            made._animated = again, {**keywords, **options, "base_dir": base_dir}, sum_of(again)
        return made

    def add_file(
        self,
        source: Source,
        pose: Any = None,
        *,
        animation: Union[str, int, None] = None,
        time: float = 0.0,
        scene: Union[str, int, None] = None,
        variant: Optional[str] = None,
        base_dir: Union[str, os.PathLike[Any], None] = None,
        **options: Any,
    ) -> range:
        """Adds all that a file has, which a robot's link may be, and returns the indices of the instances that were added.

        pose: 4 x 4, from the file's coordinates to the scene's (the identity); set_instance() moves the instances later. A scene that is
        empty and was made without up takes that of the file. The other keywords are those of load().

            arm = halflit.Scene(up="z")
            for link, pose in links: arm.add_file(f"meshes/{link}.stl", pose)
        """
        from ._arrays import matrix

        columns = np.ascontiguousarray((np.eye(4) if pose is None else matrix(pose, "pose")).T)
        first, count = ctypes.c_int32(), ctypes.c_int32()
        name, arguments = loading(source, base_dir, dict(animation=animation, time=time, scene=scene, variant=variant, **options))
        self._change("scene_" + name, *arguments, columns.ctypes.data, ctypes.byref(first), ctypes.byref(count))
        self._warnings = None
        return range(first.value, first.value + count.value)

    @classmethod
    def demo(cls) -> Scene:
        """The built-in demo scene, which has lights and a camera."""
        return cls._of(_c.Handle("scene_create_demo", "scene_destroy"))

    @classmethod
    def from_trimesh(cls, mesh: Any, up: Optional[Up] = None) -> Scene:
        """A scene of a trimesh.Trimesh, trimesh.PointCloud or trimesh.Scene: vertices, faces, normals, uv, colours and materials, and paths
        as lines.

        up: the axis that points up; None: as in load(), by the format of the file that trimesh has read it from, and y without one.
        """
        from ._trimesh import add, up_of

        scene = cls(up or up_of(mesh))
        add(scene, mesh)
        return scene

    # ---- what the scene has ---------------------------------------------------------------------------------------------

    @property
    def up(self) -> Up:
        """The axis that points up: "x", "y", "z", "-x", "-y" or "-z"."""
        found = ctypes.c_int32()
        self._call("scene_get_placement", None, None, ctypes.byref(found))
        return UP_AXES[found.value - 1]

    @property
    def animations(self) -> List[Dict[str, Any]]:
        """The file's animations: name, end_s (time of the last key, seconds) and channels (properties that it moves)."""
        found = []
        with self._lock:  # the names are the scene's
            for i in range(self.counts["animations"]):
                animation = _c.make("animation", False)
                self._call("scene_get_animation", i, ctypes.byref(animation))
                found.append({"name": _c.text_of(animation.name), "end_s": animation.end_s, "channels": animation.channels})
        return found

    def pose(self, animation: Union[str, int, None] = None, time: float = 0.0) -> None:
        """Poses a scene, loaded with keep_animations=True, by an animation (name, index, "none"; the first) at a time in seconds."""
        self._change("scene_pose", None if animation is None else _c.bytes_of(str(animation), "animation"), finite(time, "time"))

    @property
    def bounds(self) -> Optional[Array]:
        """World-space box of everything drawn, float64 (2, 3): its least and its largest corner; None if there is nothing."""
        box = np.empty((2, 3))
        self._call("scene_get_box", box[0].ctypes.data, box[1].ctypes.data)
        return box if np.isfinite(box).all() else None

    @property
    def cameras(self) -> List[Camera]:
        """The scene's own cameras."""
        return [self._camera(i) for i in range(self.counts["cameras"])]

    def _camera(self, index: int) -> Camera:
        camera = Camera()
        with self._lock:  # its name is the scene's
            self._call("scene_get_camera", index, ctypes.byref(camera._c))
            return camera._copied()

    def frame(self, aspect: float = 1.0, azimuth: float = 35.0, elevation: float = 20.0, zoom: float = 1.0) -> Camera:
        """A view of the whole scene. aspect: width / height of the picture; angles in degrees: azimuth around the vertical, 0 from the
        front and positive from the right; elevation above the horizon. zoom: 2 makes things twice as large."""
        camera = Camera()
        self._call("camera_frame", aspect, azimuth, elevation, zoom, ctypes.byref(camera._c))
        return camera

    # ---- drawing --------------------------------------------------------------------------------------------------------

    def setup(
        self, size: Size = None, *, poses: Optional[Iterable[Any]] = None, bounds: Any = None, **options: Unpack[ViewOptions]
    ) -> Setup:
        """Chooses camera, light and exposure for a picture of size (width, height), as render() does, for many pictures by
        render(setup=...): nothing is chosen anew while things move. After a change of light, call it again.

        poses: the camera contains the scene in all of them; each a function that poses it, or matrices (n, 4, 4) of the instances 0 to
        n - 1, which are put back. bounds: a box, (2, 3), that the camera contains. Other keywords are those of halflit.PictureOptions about
        the view and the light that is chosen.

            setup = scene.setup(512, poses=[lambda t=t: scene.pose(time=t) for t in (0, 0.5, 1)])
        """
        from ._setup import check_view, choose, choose_for_all

        check_view(options)
        with self._lock:
            if poses is not None or bounds is not None:
                return choose_for_all(self, size, poses, bounds, dict(options))
            return choose(self, size, dict(options))

    def render(self, size: Size = None, **options: Unpack[PictureOptions]) -> pictures.Picture:
        """Draws the scene and returns a Picture, a numpy array of shape (height, width, 4).

        size: (width, height) in pixels, or the side of a square; 1280 x 720, reduced to the shape of the scene's camera, if it is left
        out. What no keyword says is chosen as the program `halflit` does, and the pixels are the same. The keywords are those of
        halflit.PictureOptions.
        """
        from ._frame import draw

        with self._lock:
            return draw(self, size, dict(options))

    def _views_of(self, views: Sequence[Any], size: Any, options: Dict[str, Any]) -> List[Camera]:
        from ._views import views_of

        return views_of(self, views, size, options)

    def render_batch(
        self, cameras: Iterable[Any], size: Size = None, *, light: BatchLight = "fixed", ahead: int = 0, **options: Unpack[PictureOptions]
    ) -> Iterator[pictures.Picture]:
        """Draws the scene by many cameras: an iterator of pictures, each drawn when it is asked for.

        ahead: number of pictures that a thread draws while the caller uses the last one; leave the scene alone meanwhile.

        cameras: each a Camera, its matrix, a camera of the file, or (azimuth, elevation) in degrees. By angles, each camera is as near as
        its side allows, as in render(azimuth=, elevation=), so distances differ; render_views() keeps one distance and one scale. light: "fixed": exposure and the light
        that is chosen are those of the first camera, so that a surface looks the same in all pictures; "viewer": the studio turns with
        each camera, and the pictures are those of render(). The other keywords are those of render() but for the view, setup and out.

            views = [(azimuth, elevation) for elevation in (10, 40) for azimuth in range(0, 360, 5)]
            for picture in scene.render_batch(views, 256, aovs=["depth", "id", "barycentric"], threads=2):
                ...
        """
        from ._frame import draw_batch

        drawn = draw_batch(self, listed(cameras, "cameras", _CAMERAS), size, light, dict(options))
        if whole(ahead, "ahead", 0, 1000) == 0:
            return drawn
        from ._batch import drawn_ahead

        return drawn_ahead(drawn, ahead)

    def render_arrays(
        self, cameras: Iterable[Any], size: Size = None, *, light: BatchLight = "fixed", **options: Unpack[PictureOptions]
    ) -> Dict[str, Array]:
        """The pictures of render_batch() in one array for each plane: "color", (n, height, width, 4), and those that `aovs` names.

            data = scene.render_arrays([(azimuth, 20) for azimuth in range(0, 360, 5)], 128, samples=1, aovs=["depth", "id"])
            data["depth"].shape  # (72, 128, 128)
        """
        from ._batch import draw_arrays

        return draw_arrays(self, listed(cameras, "cameras", _CAMERAS), size, light, dict(options))

    def render_views(
        self, views: Sequence[ViewOf], size: Size = None, *, light: BatchLight = "viewer", **options: Unpack[PictureOptions]
    ) -> Dict[Any, pictures.Picture]:
        """Pictures of several sides that can be compared, by one distance and one scale, as `halflit render --view`: a dict of pictures by
        their views.

        views: names ("front", "back", "left", "right", "top", "bottom", "iso"), and (azimuth, elevation) in degrees. fit: margin in pixels
        of the largest of them; without it, all sides of the scene have that scale. light: as in render_batch(). The other keywords are
        those of render() but for the other views, setup and out.

            sheet = scene.render_views(["front", "right", "top", "iso"], 512, orthographic=True, edges="feature")
            sheet["front"].save("front.png")
        """
        from ._frame import draw_views

        return draw_views(self, listed(views, "views", "a list of names, or of (azimuth, elevation)"), size, light, dict(options))

    def turntable(
        self,
        size: Size = 256,
        *,
        azimuths: int = 24,
        elevations: Sequence[float] = (-15, 20, 55),
        light: BatchLight = "viewer",
        format: Literal["png", "webp", "jpg"] = "png",
        **options: Unpack[PictureOptions],
    ) -> Turntable:
        """A view that is turned by dragging: notebooks show it, without a network, and save() writes it as a page.

        It draws the whole scene from azimuths x elevations sides, by one distance and one scale, and shows the nearest. azimuths: number of
        them around the circle, evenly, beginning with `azimuth` (35 degrees). elevations: degrees above the horizon. format: of the
        pictures: "png" (exact), "webp" (exact, smaller, slow) or "jpg". The other keywords are those of render_views().

            scene.turntable(320, background="#ffffff").save("model.html")
        """
        from ._turntable import turntable

        return turntable(self, size, azimuths, elevations, light, format, dict(options))

    def motion(self, picture: pictures.Picture, camera: Camera, scene: Optional[Scene] = None) -> Array:
        """How far each point that a picture of this scene shows moves to the picture by another camera: float32 (height, width, 2), pixels,
        x to the right, y down. 0 where nothing is, and for points that are not before both cameras.

        picture: of the whole view, drawn with aovs "id", "triangle" and "barycentric". scene: the scene in another pose, of the same
        meshes; by default this one.
        """
        from ._motion import motion

        return motion(self, picture, camera, self if scene is None else scene)

    def measure(
        self,
        size: Size = None,
        quality: Union[Literal["fast", "draft"], Tuple[float, float]] = "fast",
        known: Optional[Dict[str, Any]] = None,
        **options: Unpack[PictureOptions],
    ) -> Dict[str, Any]:
        """Finds the cheapest settings by which a share of the pixels is near full quality, for many pictures of the scene.

        quality: "fast": 99 % of the pixels within 2 of 255 codes; "draft": 95 % within 8; or (codes, percent). The other keywords are those
        of render(). Probes, pixels that a hash chooses, are drawn in full quality and in cheaper ones, which takes about as long as a
        picture. known: what was found for another view; the result is at least as careful. Other views are not checked.

        Pixels of the background count. Returns {"settings": keywords for render(), in place of your own of these names ("shadow_size" 0: the
        chosen one), "percent": the share that the probes show, with a confidence of 95 % (100: full quality),
        "probes", "outside",
        "asked"}:

            found = None
            for azimuth in (0, 120, 240):
                found = scene.measure(256, "draft", found, azimuth=azimuth)
            pictures = [scene.render(256, azimuth=i, **found["settings"]) for i in range(360)]
        """
        from ._frame import measure

        with self._lock:
            return measure(self, size, quality, known, dict(options))

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Dict[str, Any]:
        """For Jupyter: the scene in 512 x 512 pixels, and the camera as a text. turntable() gives a view that turns."""
        picture = self.render((512, 512))
        return {"text/html": picture._repr_html_(), "image/png": picture._repr_png_()}

    def _repr_html_(self) -> Optional[str]:
        """For notebooks that ask for one kind alone."""
        return self.render((512, 512))._repr_html_()

    def _repr_png_(self) -> Optional[bytes]:
        """Likewise."""
        return self.render((512, 512))._repr_png_()
