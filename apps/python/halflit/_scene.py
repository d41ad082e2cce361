"""Scenes."""
from __future__ import annotations

import ctypes
import math
import os

from . import _c
from ._camera import Camera
from ._errors import UsageError
from ._execution import SceneLock
from ._records import Light, Material, Record, fill

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

    import numpy as np
    from typing_extensions import Unpack

    from ._picture_options import PictureOptions
    from ._picture import Picture
    from ._records import Color, Point

_COLORS = {"srgb": "SRGB", "linear": "LINEAR", "srgb_by_alpha": "SRGB_BY_ALPHA", "normal": "NORMAL"}
_CORNERS = {"triangles": 3, "lines": 2, "points": 1}


class Setup:
    """What Scene.setup() chose: camera and settings. render(setup=...) draws by it again, whatever has moved since."""

    def __init__(self, camera: Camera, settings, request, size: Tuple[int, int]):
        self.camera = camera
        self.size = size  #: width, height
        self._settings = settings
        self._request = request  # the halflit_setup_options, and the camera that it points to

    @property
    def exposure(self) -> float:
        """Factor on all light."""
        return self._settings.exposure


class Scene:
    """Everything that a picture shows: meshes, instances of them, materials, textures, lights, cameras.

    Scene() is empty; Scene.load(), Scene.demo() and Scene.from_trimesh() make others. Indices begin at 0. The world is right-handed with
    y up. Matrices are 4 x 4 arrays with the translation in the last column. Colours are linear light with Rec. 709 primaries. Arrays are
    read during the call; float32 arrays of the right shape, and int32 or uint32 faces, are handed over without a copy.

    Threads may use a scene at once: they wait for each other. Different scenes are drawn side by side.
    """

    def __init__(self):
        self._start(_c.Handle("scene_create", "scene_destroy"))

    @classmethod
    def _of(cls, handle: _c.Handle) -> Scene:
        scene = cls.__new__(cls)
        scene._start(handle)
        return scene

    def _start(self, handle: _c.Handle) -> None:
        self._handle: Any = handle
        self._lock = SceneLock()
        self._renderer = None
        self._executed = None  # Execution.key of the renderer
        self._changes = 0  # of anything that setup() looks at
        self._light_changes = 0
        self._setup_key = None
        self._own_lights = False  # add_light() was called
        self._plain_material: Optional[int] = None
        self._told: set = set()  # warnings that were shown
        self.origin: Tuple[float, ...] = (0.0, 0.0, 0.0)  #: a point p of the file is drawn at (p - origin) * scale
        self.scale = 1.0  #: see origin; 1 unless the file's model is tiny or huge

    @classmethod
    def load(
        cls,
        source: Union[str, os.PathLike, bytes],
        *,
        animation: Union[str, int, None] = None,
        time: float = 0.0,
        scene: Union[str, int, None] = None,
        variant: Optional[str] = None,
        keep_animations: bool = False,
        base_dir: Union[str, os.PathLike, None] = None,
        recentre: bool = True,
        **options: Any,
    ) -> Scene:
        """A scene of a glTF, GLB, STL, PLY, OBJ or 3MF file, or of its bytes.

        animation: name or index of the animation that poses it (the first), or "none"; time: seconds.
        scene: name or index of the file's scene. variant: of the file's materials.
        keep_animations: for pose(). base_dir: folder of files that bytes refer to; without it none is read.
        recentre: a model that is far from the origin is moved to it, and a tiny or huge one scaled, so that float32 keeps its shape;
        `origin` and `scale` tell how.
        Other keywords are members of halflit_load_options, such as lenient=True, crease_deg=60, max_texture_side=4096 or
        allow_external=["/models/shared"].
        """
        how = _c.make("load_options")
        folders = [_c.bytes_of(folder) for folder in options.pop("allow_external", ())]
        if folders:
            how.allow_external = ctypes.cast((ctypes.c_char_p * len(folders))(*folders), ctypes.c_void_p)
            how.allow_external_count = len(folders)
        known = {name for name, _ in how._fields_} - {"size", "reserved", "allow_external_count"}
        for name, value in options.items():
            if name not in known:
                raise TypeError(f"Scene.load() has no keyword {name!r}")
            setattr(how, name, value)
        how.time_s, how.keep_animations, how.recentre = time, keep_animations, recentre
        for name, value in (("animation", animation), ("scene", scene), ("variant", variant)):
            setattr(how, name, None if value is None else _c.bytes_of(str(value)))
        if isinstance(source, (bytes, bytearray, memoryview)):
            data = bytes(source)
            handle = _c.Handle("scene_load_memory", "scene_destroy", data, len(data), b"bytes", _c.bytes_of(base_dir), ctypes.byref(how))
        else:
            handle = _c.Handle("scene_load", "scene_destroy", _c.bytes_of(source), ctypes.byref(how))
        made = cls._of(handle)
        origin, scale = (ctypes.c_double * 3)(), ctypes.c_double()
        made._call("scene_get_placement", origin, ctypes.byref(scale))
        made.origin, made.scale = tuple(origin), scale.value
        return made

    @classmethod
    def demo(cls) -> Scene:
        """The built-in demo scene, which has lights and a camera."""
        return cls._of(_c.Handle("scene_create_demo", "scene_destroy"))

    @classmethod
    def from_trimesh(cls, mesh) -> Scene:
        """A scene of a trimesh.Trimesh, trimesh.PointCloud or trimesh.Scene: vertices, faces, normals, uv, colours and materials."""
        from ._trimesh import add

        scene = cls()
        add(scene, mesh)
        return scene

    # ---- what the scene has ---------------------------------------------------------------------------------------------

    @property
    def counts(self) -> Dict[str, int]:
        """Numbers of triangles (over all instances), meshes, instances, materials, textures, cameras, lights, warnings and animations."""
        found = _c.make("counts", False)
        self._call("scene_get_counts", ctypes.byref(found))
        return {name: getattr(found, name) for name, _ in found._fields_ if name != "size"}

    @property
    def warnings(self) -> List[str]:
        """What the loader could not draw, one line each."""
        text, lines = ctypes.c_char_p(), []
        for i in range(self.counts["warnings"]):
            self._call("scene_get_warning", i, ctypes.byref(text))
            lines.append(_c.text_of(text.value))
        return lines

    @property
    def animations(self) -> List[Dict[str, Any]]:
        """The file's animations: name, end_s (time of the last key, seconds) and channels (properties that it moves)."""
        found = []
        for i in range(self.counts["animations"]):
            animation = _c.make("animation", False)
            self._call("scene_get_animation", i, ctypes.byref(animation))
            found.append({"name": _c.text_of(animation.name), "end_s": animation.end_s, "channels": animation.channels})
        return found

    @property
    def bounds(self) -> Optional[np.ndarray]:
        """World-space box of everything drawn, float32 (2, 3): its least and its largest corner; None if there is nothing."""
        import numpy as np

        box = np.empty((2, 3), np.float32)
        self._call("scene_get_bounds", box[0].ctypes.data, box[1].ctypes.data)
        return box if np.isfinite(box).all() else None

    @property
    def cameras(self) -> List[Camera]:
        """The scene's own cameras."""
        return [self._camera(i) for i in range(self.counts["cameras"])]

    def _camera(self, index: int) -> Camera:
        camera = Camera()
        self._call("scene_get_camera", index, ctypes.byref(camera._c))
        return owned(camera)

    def frame(self, aspect: float = 1.0, azimuth: float = 35.0, elevation: float = 20.0, zoom: float = 1.0) -> Camera:
        """A view of the whole scene. aspect: width / height of the picture; angles in degrees: azimuth around +y, 0 from +z and positive
        from the right; elevation above the horizon. zoom: 2 makes things twice as large."""
        camera = Camera()
        self._call("camera_frame", aspect, azimuth, elevation, zoom, ctypes.byref(camera._c))
        return camera

    # ---- materials and textures -----------------------------------------------------------------------------------------

    def add_texture(self, pixels, color: str = "srgb") -> int:
        """Adds a texture of uint8 (height, width, 1 to 4 channels; row 0 on top) or of a PIL picture, and returns its index.

        color: "srgb", "linear", "srgb_by_alpha" (for materials that mask or blend) or "normal" (a normal map).
        """
        index = ctypes.c_int32()
        self._texture("scene_add_texture", (), pixels, color, (ctypes.byref(index),))
        return index.value

    def set_texture(self, index: int, pixels, color: str = "srgb") -> None:
        """Replaces a texture; the size may differ."""
        self._texture("scene_set_texture", (index,), pixels, color, ())

    def _texture(self, name: str, before: tuple, pixels, color: str, after: tuple) -> None:
        from ._arrays import rgba8

        if color not in _COLORS:
            raise UsageError(f"color: expected one of {', '.join(_COLORS)}, found {color!r}")
        array = rgba8(pixels)
        code = _c.CONSTANTS["HALFLIT_COLOR_" + _COLORS[color]]
        self._change(name, *before, array.ctypes.data, array.shape[1], array.shape[0], array.strides[0], code, *after)

    def add_material(self, material: Optional[Material] = None, **members: Any) -> int:
        """Adds a Material, or one of these members, and returns its index: add_material(base_color=(1, 0.4, 0.2), metallic=0)."""
        index = ctypes.c_int32()
        made = material if material is not None else Material(**members)
        self._change("scene_add_material", ctypes.byref(made._c), ctypes.byref(index))
        return index.value

    def material(self, index: int) -> Material:
        """A material of the scene. Change a member, then call set_material()."""
        material = Material()
        self._call("scene_get_material", index, ctypes.byref(material._c))
        return owned(material)

    def set_material(self, index: int, material: Optional[Material] = None, **members: Any) -> None:
        """Replaces a material in all meshes that have it, or some of its members: set_material(0, roughness=0.3)."""
        with self._lock:
            made = material if material is not None else self.material(index)
            for name, value in members.items():
                setattr(made, name, value)
            self._change("scene_set_material", index, ctypes.byref(made._c))

    # ---- meshes and instances -------------------------------------------------------------------------------------------

    def add_mesh(
        self,
        vertices,
        faces=None,
        *,
        normals=None,
        uv=None,
        uv1=None,
        colors=None,
        tangents=None,
        material: Union[int, Material, Dict[str, Any], None] = None,
        topology: str = "triangles",
        name: Optional[str] = None,
        matrix=None,
        place: bool = True,
    ) -> int:
        """Adds a mesh and returns its index. It is drawn where `matrix` (4 x 4; the identity) places it, unless place is False.

        vertices: (n, 3) world units. faces: (m, 3) vertex numbers, counter-clockwise seen from the front; None: 0 1 2, 3 4 5 and so on.
        normals: (n, 3), "smooth" (made from the faces around each vertex), or None: each triangle is flat.
        uv, uv1: (n, 2), v = 0 is the first row of a texture. colors: (n, 3) or (n, 4), linear floats or uint8 sRGB codes.
        tangents: (n, 4), direction and +1 or -1. material: index, Material, or a dict of its members; None: white, not metallic, rough,
        and seen from both sides.
        topology: "triangles", "lines" (faces: (m, 2)) or "points" (faces: (m,)).
        """
        with self._lock:
            mesh, keep = self._mesh(vertices, faces, normals, uv, uv1, colors, tangents, material, topology, name)
            index = ctypes.c_int32()
            self._change("scene_add_mesh", ctypes.byref(mesh), ctypes.byref(index))
            del keep
            if place:
                self.add_instance(index.value, matrix)
            return index.value

    def set_mesh(self, index: int, vertices, faces=None, *, normals=None, uv=None, uv1=None, colors=None, tangents=None,
                 material: Union[int, Material, Dict[str, Any], None] = None, topology: str = "triangles",
                 name: Optional[str] = None) -> None:  # fmt: skip
        """Replaces a mesh in all its instances; arguments as in add_mesh()."""
        with self._lock:
            mesh, keep = self._mesh(vertices, faces, normals, uv, uv1, colors, tangents, material, topology, name)
            self._change("scene_set_mesh", index, ctypes.byref(mesh))
            del keep

    def _mesh(self, vertices, faces, normals, uv, uv1, colors, tangents, material, topology, name):
        """A halflit_mesh, and the arrays that it points to."""
        from . import _arrays

        if topology not in _CORNERS:
            raise UsageError(f"topology: expected one of {', '.join(_CORNERS)}, found {topology!r}")
        mesh = _c.make("mesh")
        positions = _arrays.floats(vertices, 3, "vertices")
        count = len(positions)
        corners = None if faces is None else _arrays.indices(faces, _CORNERS[topology])
        if isinstance(normals, str):
            import numpy as np

            if normals != "smooth" or topology != "triangles":
                raise UsageError(f'normals: expected an array, or "smooth" for triangles, found {normals!r}')
            if corners is not None and corners.size and int(corners.max()) >= count:
                raise UsageError(f"faces: vertex {int(corners.max())}, but the number of vertices is {count}")
            normals = _arrays.smooth_normals(positions, np.arange(count - count % 3) if corners is None else corners)
        keep = {"positions": positions, "indices": corners}
        for member, value, columns in (("normals", normals, 3), ("uv0", uv, 2), ("uv1", uv1, 2), ("tangents", tangents, 4)):
            keep[member] = None if value is None else _arrays.floats(value, columns, member, count)
        keep["colors"] = None if colors is None else _arrays.colors(colors, count)
        for member, array in keep.items():
            setattr(mesh, member, None if array is None else array.ctypes.data)
        mesh.vertex_count, mesh.index_count = count, 0 if corners is None else corners.size
        mesh.topology = _c.CONSTANTS["HALFLIT_TOPOLOGY_" + topology.upper()]
        mesh.name = _c.bytes_of(name)
        if isinstance(material, (Material, dict)):
            material = self.add_material(Material._from(material))
        mesh.material = self._plain() if material is None else material
        return mesh, keep

    def _plain(self) -> int:
        """The material of meshes that are given none, as that of models without materials."""
        if self._plain_material is None:
            self._plain_material = self.add_material(roughness=0.6, double_sided=True)
        return self._plain_material

    def set_vertices(self, mesh: int, vertices, normals=None) -> None:
        """Moves the vertices of a mesh that was added: (n, 3), n as before. normals: (n, 3); None: the mesh keeps those that it has."""
        from . import _arrays

        positions = _arrays.floats(vertices, 3, "vertices")
        directions = None if normals is None else _arrays.floats(normals, 3, "normals", len(positions))
        pointer = None if directions is None else directions.ctypes.data
        self._change("scene_set_vertices", mesh, positions.ctypes.data, pointer, len(positions))

    def add_instance(self, mesh: int, matrix=None) -> int:
        """Places a mesh in the world by a 4 x 4 matrix (the identity), and returns the instance's index."""
        index = ctypes.c_int32()
        place, keep = placement(matrix)
        self._change("scene_add_instance", mesh, place, ctypes.byref(index))
        del keep
        return index.value

    def instance(self, index: int) -> Tuple[int, np.ndarray]:
        """Mesh and matrix, float32 (4, 4), of an instance."""
        import numpy as np

        mesh, columns = ctypes.c_int32(), np.empty((4, 4), np.float32)
        self._call("scene_get_instance", index, ctypes.byref(mesh), columns.ctypes.data)
        return mesh.value, columns.T.copy()

    def set_instance(self, index: int, matrix) -> None:
        """Moves an instance. The next frame recomputes what depends on it alone."""
        place, keep = placement(matrix)
        self._change("scene_set_instance", index, place)
        del keep

    def add_ground(self) -> int:
        """Adds a ground below the scene that is invisible but for the shadows on it, and returns its instance's index."""
        index = ctypes.c_int32()
        self._change("scene_add_ground", ctypes.byref(index))
        return index.value

    def pose(self, animation: Union[str, int, None] = None, time: float = 0.0) -> None:
        """Poses a scene, loaded with keep_animations=True, by an animation (name, index, "none"; the first) at a time in seconds."""
        self._change("scene_pose", None if animation is None else _c.bytes_of(str(animation)), time)

    # ---- light ----------------------------------------------------------------------------------------------------------

    def add_light(self, light: Union[Light, str] = "directional", **members: Any) -> int:
        """Adds a Light, or one of this type and these members: add_light("point", position=(0, 2, 0), color=(4, 4, 4))."""
        index = ctypes.c_int32()
        made = light if isinstance(light, Light) else Light(light, **members)
        self._relight("scene_add_light", ctypes.byref(made._c), ctypes.byref(index))
        self._own_lights = True
        return index.value

    def light(self, index: int) -> Light:
        """A light of the scene. Change a member, then call set_light()."""
        light = Light()
        self._call("scene_get_light", index, ctypes.byref(light._c))
        return light

    def set_light(self, index: int, light: Light) -> None:
        """Replaces a light."""
        self._relight("scene_set_light", index, ctypes.byref(light._c))

    def set_ambient(self, sky: Color, ground: Optional[Color] = None) -> None:
        """Sets the light from all around, linear: sky from above, ground (the same) from below. An environment replaces it."""
        colors = [fill(ctypes.c_float * 3, value, "ambient") for value in (sky, sky if ground is None else ground)]
        self._relight("scene_set_ambient", *colors)

    def set_environment(self, image, *, rotate: float = 0.0, extract_suns: bool = True, calibrated: bool = False) -> None:
        """Lights the scene by an image of the light from all directions, in the place of ambient light.

        image: float32 (height, width, 3), linear, row 0 straight up, the middle column along -z; a path (.hdr, .pfm, .exr); or "sky".
        rotate: degrees about +y, counter-clockwise seen from above. calibrated: the array is made for exposure 1.
        """
        how = _c.make("environment_options")
        how.rotate_rad, how.extract_suns, how.calibrated = rotate * (math.pi / 180), extract_suns, calibrated
        if isinstance(image, str) and image == "sky":
            self._relight("scene_set_sky", ctypes.byref(how))
        elif isinstance(image, (str, os.PathLike)):
            self._relight("scene_load_environment", _c.bytes_of(image), ctypes.byref(how))
        else:
            import numpy as np

            array = np.ascontiguousarray(image, dtype=np.float32)
            if array.ndim != 3 or array.shape[2] != 3:
                raise UsageError(f"environment: expected an array of shape (height, width, 3), found {array.shape}")
            self._relight("scene_set_environment", array.ctypes.data, array.shape[1], array.shape[0], ctypes.byref(how))

    def clear_lights(self) -> None:
        """Removes the lights, the ambient light and the environment, those of the file too."""
        self._relight("scene_clear_lights")
        self._own_lights = False

    # ---- drawing --------------------------------------------------------------------------------------------------------

    def setup(self, size: Union[int, Tuple[int, int], None] = None, **options: Unpack[PictureOptions]) -> Setup:
        """Chooses camera, light and exposure for a picture of size (width, height), as render() does, for many pictures by
        render(setup=...): nothing is chosen anew while things move. After a change of light, call it again."""
        from ._frame import choose

        with self._lock:
            return choose(self, size, dict(options))

    def render(self, size: Union[int, Tuple[int, int], None] = None, **options: Unpack[PictureOptions]) -> Picture:
        """Draws the scene and returns a Picture, a numpy array of shape (height, width, 4).

        size: (width, height) in pixels, or the side of a square; 1280 x 720, reduced to the shape of the scene's camera, if it is left
        out. What no keyword says is chosen as the program `halflit` does, and the pixels are the same. The keywords are those of
        halflit.PictureOptions.
        """
        from ._frame import draw

        with self._lock:
            return draw(self, size, dict(options))

    # ---- calls ----------------------------------------------------------------------------------------------------------

    def _call(self, name: str, *arguments) -> None:
        with self._lock:
            if self._handle is None:
                raise UsageError("the scene is closed")
            _c.call(name, self._handle, *arguments)

    def _change(self, name: str, *arguments) -> None:
        with self._lock:
            self._call(name, *arguments)
            self._changes += 1

    def _relight(self, name: str, *arguments) -> None:
        with self._lock:
            self._change(name, *arguments)
            self._light_changes += 1
            self._setup_key = None

    def close(self) -> None:
        """Frees the scene's memory at once; otherwise it is freed when nothing refers to the scene any more."""
        with self._lock:
            self._handle = self._renderer = None

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._handle is None:
            return "<halflit.Scene, closed>"
        return f"<halflit.Scene of {', '.join(f'{n} {name}' for name, n in self.counts.items() if n)}>"

    def _repr_png_(self) -> Optional[bytes]:
        """What Jupyter shows: the scene in 512 x 512 pixels."""
        return self.render((512, 512))._repr_png_()


def owned(record: Record):
    """The record with a name of its own: the scene's may go away."""
    record._c.name = bytes(record._c.name or b"")
    return record


def placement(matrix):
    """The address of 16 floats, and the array that has them; None for None."""
    if matrix is None:
        return None, None
    from ._arrays import matrix as columns

    array = columns(matrix)
    return array.ctypes.data, array
