"""render(): a picture in one call."""
from __future__ import annotations

import os

from ._records import Light
from ._scene import Scene

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Dict, Iterable, Optional, Tuple, Union

    from typing_extensions import Unpack

    from ._picture_options import PictureOptions
    from ._picture import Picture
    from ._records import Color


def render(
    source: Any,
    size: Union[int, Tuple[int, int], None] = None,
    *,
    lights: Iterable[Union[Light, Dict[str, Any]]] = (),
    environment: Any = None,
    environment_rotate: float = 0.0,
    scene_lights: bool = True,
    ground: bool = False,
    load: Optional[Dict[str, Any]] = None,
    animation: Union[str, int, None] = None,
    time: float = 0.0,
    scene: Union[str, int, None] = None,
    variant: Optional[str] = None,
    **options: Unpack[PictureOptions],
) -> Picture:
    """Draws a picture and returns it: a numpy array, uint8 of shape (height, width, 4), which notebooks show.

    source: a path (.glb, .gltf, .stl, .ply, .obj, .3mf), "demo", a file's bytes, (vertices, faces) as arrays, a trimesh, or a Scene.
    size: (width, height) in pixels, or the side of a square; 1280 x 720, reduced to the shape of the file's camera, if it is left out.

    A file without any keyword gives the pixels that `halflit render FILE --size WxH` gives. Keywords for all but a Scene:
    lights: Light objects, or dicts of their members, in the file's world; environment: an image or a path as in
    Scene.set_environment(), "sky", "studio" or "none"; environment_rotate: degrees; scene_lights: False leaves out those of the file;
    ground: a ground that shows shadows alone; animation, time (seconds), scene, variant: as in Scene.load(); load: other keywords of it.
    Further keywords are those of Scene.render(): camera, azimuth, elevation, zoom, samples, background, exposure, aovs, max_error,
    threads and so on (halflit.PictureOptions).
    """
    of_file = {"animation": animation, "time": time, "scene": scene, "variant": variant}
    if isinstance(source, Scene):
        others = {**of_file, "time": time or None, "environment": environment, "load": load, "ground": ground or None}
        others.update(lights=lights or None, scene_lights=None if scene_lights else False, environment_rotate=environment_rotate or None)
        for name, value in others.items():
            if value is not None:
                raise TypeError(f"render() of a Scene has no keyword {name}: the Scene has methods for it")
        return source.render(size, **options)
    lights = list(lights)
    with scene_of(source, {**of_file, **(load or {})}) as drawn:
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
        for light in lights:
            drawn.add_light(placed(Light._from(light), drawn))
        return drawn.render(size, **options)


def scene_of(source: Any, load: dict) -> Scene:
    """The scene that a source of render() is."""
    if isinstance(source, str) and source == "demo":
        return Scene.demo()
    if isinstance(source, (str, os.PathLike, bytes, bytearray, memoryview)):
        return Scene.load(source, **load)
    if isinstance(source, (tuple, list)) and len(source) == 2:
        scene = Scene()
        scene.add_mesh(*source)
        return scene
    from ._trimesh import is_trimesh

    if is_trimesh(source):
        return Scene.from_trimesh(source)
    raise TypeError(f"render(): expected a path, bytes, (vertices, faces), a trimesh or a Scene, found {type(source).__name__}")


def placed(light: Light, scene: Scene) -> Light:
    """The light, which is given in the file's world, in the world that is drawn."""
    if light.type == "directional" or (scene.scale == 1.0 and not any(scene.origin)):
        return light
    moved, scale = Light(**light.to_dict()), scene.scale
    moved.position = [(p - origin) * scale for p, origin in zip(light.position, scene.origin)]
    moved.color = [c * scale * scale for c in light.color]  # falls with the squared distance
    moved.range, moved.source_radius, moved.shadow_radius = (
        value * scale for value in (light.range, light.source_radius, light.shadow_radius)
    )
    return moved
