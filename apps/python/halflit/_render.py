"""render(): a picture in one call."""
from __future__ import annotations

import os
from typing import Any, Dict, Iterable, Iterator, Optional, Union

from ._errors import UsageError
from ._geometry import MaterialOf
from ._lazy import np  # noqa: F401  (in annotations)
from ._lazy_picture import pictures  # noqa: F401  (in annotations)
from ._light import Light
from ._members import LightMembers
from ._picture_options import PictureOptions
from ._scene import Scene
from ._splats import Splats
from ._types import Size, Unpack, Up
from ._values import listed, real, shown, truth


def render(
    source: Any,
    size: Size = None,
    *,
    lights: Iterable[Union[Light, LightMembers]] = (),
    environment: Any = None,
    environment_rotate: float = 0.0,
    scene_lights: bool = True,
    ground: bool = False,
    load: Optional[Dict[str, Any]] = None,
    animation: Union[str, int, None] = None,
    time: float = 0.0,
    scene: Union[str, int, None] = None,
    variant: Optional[str] = None,
    up: Optional[Up] = None,
    **options: Unpack[PictureOptions],
) -> pictures.Picture:
    """Draws a picture and returns it: a numpy array, uint8 of shape (height, width, 4), which notebooks show.

    source: a model's path, "demo", a file's bytes, a file object, (vertices, faces) as arrays, Splats, a trimesh, or a Scene.
    size: (width, height) in pixels, or the side of a square; 1280 x 720, reduced to the shape of the file's camera, if it is left out.

    A file without any keyword gives the pixels that `halflit render FILE --size WxH` gives. Keywords for all but a Scene:
    lights: Light objects, or dicts of their members; environment: an image or a path as in Scene.set_environment(), "sky", "studio" or
    "none"; environment_rotate: degrees; scene_lights: False leaves out those of the file; ground: a ground that shows shadows alone.
    up: the axis that points up, "z" and so on; by default z for STL, 3MF and CAD files, and for what trimesh has read from them, and y for the rest.
    For files and their bytes: animation, time (seconds), scene, variant, as in Scene.load(); load: other keywords of it.
    Further keywords are those of Scene.render(): camera, azimuth, elevation, zoom, samples, background, exposure, aovs, max_error,
    threads and so on (halflit.PictureOptions).
    """
    of_file = {"animation": animation, "time": real(time, "time") or None, "scene": scene, "variant": variant, "load": load}
    scene_lights, ground = truth(scene_lights, "scene_lights"), truth(ground, "ground")
    if isinstance(source, Scene):
        others = {"up": up, "environment": environment, "environment_rotate": environment_rotate or None, "lights": lights or None}
        others.update(ground=ground or None, scene_lights=None if scene_lights else False)
        refuse({**of_file, **others}, "a Scene: the Scene has methods for it")
        return source.render(size, **options)
    added: Any = [lights] if isinstance(lights, (Light, dict)) else listed(lights, "lights", "Light objects, or dicts of their members")
    with scene_of(source, of_file, up) as drawn:
        if not scene_lights:
            drawn.clear_lights()
        if ground:
            drawn.add_ground()
        if isinstance(environment, str) and environment in ("studio", "none"):
            options.setdefault("studio", "always" if environment == "studio" else "never")
            options.setdefault("studio_turn", environment_rotate)
        elif environment is not None:
            drawn.set_environment(environment, rotate=environment_rotate)
        else:
            options.setdefault("studio_turn", environment_rotate)
        for light in added:
            drawn.add_light(Light._from(light, "lights"))
        return drawn.render(size, **options)


def render_meshes(
    meshes: Iterable[Any], size: Size = 128, *, material: MaterialOf = None, up: Optional[Up] = None, **options: Unpack[PictureOptions]
) -> Iterator[pictures.Picture]:
    """Draws many small meshes, each alone in its picture: an iterator of the pictures of render((vertices, faces), size), in order.

    meshes: each (vertices, faces), Splats, or a dict of arguments of Scene.add_mesh() such as {"vertices": v, "faces": f, "colors": c}, but for
    material and place; they are read as pictures are asked for, some ahead. material: of all meshes. up: the axis that points up (y).
    threads: that draw, each one a picture; 0: one for each core. The other keywords are those of Scene.render() but for camera, setup and
    out.

    Each is set up as by render(); what does not depend on the mesh, such as the renderer and the light of an environment, is kept.
    """
    from ._batch import draw_meshes

    if not hasattr(meshes, "__iter__") or isinstance(meshes, (str, bytes, dict)):
        raise UsageError(f"meshes: expected an iterable of (vertices, faces) or dicts, found {shown(meshes)}")
    return draw_meshes(lambda: Scene(up), meshes, size, material, dict(options))


def refuse(keywords: Dict[str, Any], of: str) -> None:
    """Fails for the first keyword that was given."""
    for name, value in keywords.items():
        if value is not None:
            raise TypeError(f"render() has no keyword {name} for {of}")


def scene_of(source: Any, of_file: Dict[str, Any], up: Optional[Up]) -> Scene:
    """The scene that a source of render() is."""
    from ._trimesh import is_trimesh

    if not (isinstance(source, str) and source == "demo") and (
        isinstance(source, (str, os.PathLike, bytes, bytearray, memoryview)) or hasattr(source, "read")
    ):
        of_file["up"], more = up, of_file.pop("load")
        if more is not None and not isinstance(more, dict):
            raise UsageError(f"load: expected a dict of keywords of Scene.load(), found {shown(more)}")
        more = more or {}
        twice = [name for name in of_file if name in more]
        if twice:
            raise UsageError(f"load: {twice[0]} is a keyword of render()")
        return Scene.load(source, **{name: value for name, value in of_file.items() if value is not None}, **more)
    refuse(of_file, "what is not a file")
    if isinstance(source, str):
        refuse({"up": up}, "the demo")
        return Scene.demo()
    if is_trimesh(source):
        return Scene.from_trimesh(source, up)
    if isinstance(source, Splats):
        source = (source, None)
    if isinstance(source, (tuple, list)) and len(source) == 2 and not any(isinstance(part, (str, os.PathLike)) for part in source):
        made = Scene(up)
        made.add_mesh(*source)
        return made
    raise TypeError(f"source: expected a path, bytes, (vertices, faces), Splats, a trimesh or a Scene, found {type(source).__name__}")
