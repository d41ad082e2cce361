"""Pictures of scenes, without a window."""
from __future__ import annotations

import functools
import weakref
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np

from halflit._color import linear_from_srgb

from ._looks import GAMMA, Style
from ._pass import Pass, View
from ._poses import Poses
from ._values import Array
from ._world import World
from .constants import SHADOW_TEX_SZ, RenderFlags
from .light import DirectionalLight, Light, PointLight
from .node import Node
from .renderer import Backend
from .scene import Scene

#: sRGB code -> code of pyrender, which are 255 times light to the power of 1 / 2.2.
_CODES = np.rint(255 * linear_from_srgb(np.arange(256) / 255) ** (1 / GAMMA)).astype(np.uint8).tobytes()
_SHADOWS = {DirectionalLight: RenderFlags.SHADOWS_DIRECTIONAL, PointLight: RenderFlags.SHADOWS_POINT}


class OffscreenRenderer:
    """Draws scenes into pictures of viewport_width x viewport_height pixels. point_size: side of points, pixels.

    What a scene uploaded is kept until the scene or the renderer goes, or delete() is called.
    """

    def __init__(self, viewport_width: int, viewport_height: int, point_size: float = 1.0) -> None:
        self.viewport_width = viewport_width
        self.viewport_height = viewport_height
        self.point_size = point_size
        self._renderer = Backend()
        self._kept: weakref.WeakKeyDictionary[Scene, _Kept] = weakref.WeakKeyDictionary()

    @property
    def viewport_width(self) -> int:
        """Pixels."""
        return self._width

    @viewport_width.setter
    def viewport_width(self, value: Any) -> None:
        self._width = int(value)

    @property
    def viewport_height(self) -> int:
        """Pixels."""
        return self._height

    @viewport_height.setter
    def viewport_height(self, value: Any) -> None:
        self._height = int(value)

    @property
    def point_size(self) -> float:
        """Pixels."""
        return self._point_size

    @point_size.setter
    def point_size(self, value: Any) -> None:
        self._point_size = float(value)

    def render(
        self, scene: Scene, flags: int = RenderFlags.NONE, seg_node_map: Optional[Dict[Node, Any]] = None
    ) -> Any:
        """Colours and depths of a scene as its main camera sees it: (colour, depth), or with RenderFlags.DEPTH_ONLY the depth alone.

        colour: uint8 (height, width, 3), or with RenderFlags.RGBA (height, width, 4), with linear alpha. depth: float32 (height, width),
        distance along the camera's axis at the middle of each pixel, in world units; 0 where nothing is.
        seg_node_map: with RenderFlags.SEG the colour, codes (3,) or one number, of each node that is drawn.
        """
        node = scene.main_camera_node
        if node is None or node.camera is None:
            raise ValueError("the scene has no camera")
        kept = self._kept.get(scene)
        if kept is None:
            kept = self._kept[scene] = _Kept()
        size = (self._width, self._height)
        poses = kept.poses.of(scene)
        projection = np.asarray(node.camera.get_projection_matrix(width=size[0], height=size[1]), np.float64)
        view = kept.view_of(projection, poses[kept.poses.rows[node]])
        frame, flags = _Frame(scene, kept, poses, view, size, self._point_size), int(flags)
        space = None if flags & RenderFlags.DEPTH_ONLY else self._renderer.space_of_normals()
        return frame.draw(flags, seg_node_map) if space is None else frame.normals(flags, space)

    def delete(self) -> None:
        """Frees what was uploaded. The next picture uploads it again."""
        self._kept.clear()


class _Kept:
    """Data of a scene that a renderer keeps."""

    def __init__(self) -> None:
        self.poses = Poses()
        self.worlds: Dict[Tuple[Style, bool], World] = {}  # by style, and whether it is for SEG
        self._view: Optional[View] = None

    def view_of(self, projection: Array, pose: Array) -> View:
        if self._view is None or self._view.key != (projection.tobytes(), pose.tobytes()):
            self._view = View(projection, pose)
        return self._view


class _Frame:
    """One picture."""

    def __init__(self, scene: Scene, kept: _Kept, poses: Array, view: View, size: Tuple[int, int], point_size: float) -> None:
        self.scene, self.kept, self.poses, self.view, self.size = scene, kept, poses, view, size
        self.sizes = {"point_size": min(max(point_size, 1 / 16), 256.0), "line_width": 1.0}
        self.nodes = [node for node in scene._parents if node.mesh is not None and node.mesh.is_visible]
        self.lights = [node for node in scene._parents if node.light is not None]

    def draw(self, flags: int, seg_node_map: Optional[Dict[Node, Any]]) -> Union[Array, Tuple[Array, Array]]:
        back = bool(flags & RenderFlags.SKIP_CULL_FACES)
        if flags & RenderFlags.DEPTH_ONLY:
            return self.depth_of(self.world(Style("depth", "none", back, 0)))
        if flags & RenderFlags.SEG:
            return self.segmentation(seg_node_map or {}, back, bool(flags & RenderFlags.RGBA))
        wire = "flip" if flags & RenderFlags.FLIP_WIREFRAME else "own"
        wire = "none" if flags & RenderFlags.ALL_SOLID else "all" if flags & RenderFlags.ALL_WIREFRAME else wire
        kind = "flat" if flags & RenderFlags.FLAT else "lit" if self.lights else "ambient"
        style = Style(kind, wire, back, 0)
        world = self.world(style)
        shown = world
        lines = flags & (RenderFlags.VERTEX_NORMALS | RenderFlags.FACE_NORMALS)
        if lines:
            shown = self.world(style._replace(normals=lines))
        color = (self.flat if style.kind == "flat" else self.lit)(shown, flags)
        if world.has_blends:  # what blends has a depth too
            world = self.world(style._replace(kind="depth"))
        return color, self.depth_of(world)

    def world(self, style: Style, nodes: Optional[List[Node]] = None) -> World:
        """The halflit scene of this style, as the scene is now. nodes: those that SEG draws."""
        key = (style, nodes is not None)
        world = self.kept.worlds.get(key)
        if world is None:
            world = self.kept.worlds[key] = World(style)
        rows = self.kept.poses.rows
        world.update(self.nodes if nodes is None else nodes, self.poses, rows, self.scene._structure)
        if style.kind == "lit":
            world.light(self.lights, self.poses, rows)
        return world

    def run(self, world: World, **options: Any) -> Pass:
        ambient = self.scene.ambient_light if world.style.is_shaded else np.zeros(3, np.float32)
        return Pass(world, self.view, self.size, ambient, {**self.sizes, **options})

    def depth_of(self, world: World) -> Array:
        return self.finite(self.run(world).planes("depth")["depth"])

    def finite(self, depth: Array) -> Array:
        depth[depth > 3e38] = 0
        if abs(self.view.scale - 1) > 1e-6:
            depth /= np.float32(self.view.scale)  # in the camera's space
        return depth

    def normals(self, flags: int, space: str) -> Tuple[Array, Array]:
        """Normals of the vertices in the place of colours: (n + 1) / 2 as shares of 255."""
        world = self.world(Style("depth", "none", bool(flags & RenderFlags.SKIP_CULL_FACES), 0))
        planes = self.run(world).planes("vertex_normal", "depth")
        normals, is_seen = planes["vertex_normal"], planes["depth"] < 3e38
        if space == "view":
            normals = normals @ self.view.camera.matrix[:3, :3].astype(np.float32)
        colors = np.empty((*is_seen.shape, 4), np.uint8)
        colors[:] = np.floor(self.background(flags) * 255 + 0.5)
        colors[is_seen, :3] = np.clip(normals[is_seen] * 127.5 + 128, 0, 255)
        colors[is_seen, 3] = 255
        return colors if flags & RenderFlags.RGBA else np.ascontiguousarray(colors[:, :, :3]), self.finite(planes["depth"])

    def segmentation(self, colors: Dict[Node, Any], back: bool, has_alpha: bool) -> Tuple[Array, Array]:
        world = self.world(Style("depth", "none", back, 0), [node for node in self.nodes if node in colors])
        planes = self.run(world).planes("depth", "id")
        table = np.zeros((1 + max((index + 1 for _, index in world.instance_nodes), default=0), 4), np.uint8)
        table[:, 3] = 255
        for node, index in world.instance_nodes:
            table[index + 1, :3] = np.clip(np.rint(np.asarray(colors[node], np.float64)), 0, 255)
        return table[:, : 4 if has_alpha else 3][planes["id"]], self.finite(planes["depth"])

    def samples(self, flags: int) -> int:
        return 1 if flags & RenderFlags.DISABLE_ANTI_ALIASING else 4

    def background(self, flags: int) -> Array:
        color = np.clip(self.scene.bg_color, 0, 1).astype(np.float64)
        if not flags & RenderFlags.RGBA:
            color[3] = 1
        return color

    def flat(self, world: World, flags: int) -> Array:
        """Colours as they were given, without light and without a curve."""
        background = self.background(flags)
        light = self.run(world, samples=self.samples(flags), background=background.tolist()).pixels(np.float32)
        codes = (np.clip(light, 0, 1).astype(np.float64) * 255 + 0.5).astype(np.uint8)
        return self.cut(codes, np.floor(background * 255 + 0.5), flags)

    def lit(self, world: World, flags: int) -> Array:
        background, codes, tables = _background(tuple(self.background(flags)))
        options: Dict[str, Any] = {"samples": self.samples(flags), "background": background, "tone_curve": "none"}
        options.update(alpha="linear", edl="off")
        options["specular"] = "ggx" if world.style.kind == "lit" else "none"
        shadows = any(flags & _shadow_flag(node.light) for node in self.lights if node.light is not None)
        options.update(shadows="hard" if shadows else "off", shadow_size=SHADOW_TEX_SZ if shadows else 0)
        pixels = self.run(world, **options).pixels(np.uint8)
        made = np.empty((*pixels.shape[:2], 4 if flags & RenderFlags.RGBA else 3), np.uint8)
        whole = pixels.view("<u4")[:, :, 0]  # four bytes at once: rows of single bytes take five times as long
        for channel in range(made.shape[2]):
            made[:, :, channel] = whole >> np.uint32(8 * channel)
        if made.shape[2] == 3 and tables == (_CODES, _CODES, _CODES):
            return np.frombuffer(bytearray(made).translate(_CODES), np.uint8).reshape(made.shape)
        for channel, table in enumerate(tables):
            made[:, :, channel] = np.frombuffer(made[:, :, channel].tobytes().translate(table), np.uint8).reshape(made.shape[:2])
        return self.cut(made, codes, flags)

    def cut(self, codes: Array, background: Array, flags: int) -> Array:
        """The channels that are asked for. Where nothing is seen, the background's colour is there even if it has no alpha."""
        if not flags & RenderFlags.RGBA:
            return codes if codes.shape[2] == 3 else np.ascontiguousarray(codes[:, :, :3])
        if background[3] == 0:
            codes[codes[:, :, 3] == 0, :3] = background[:3]
        return codes


@functools.lru_cache(maxsize=64)
def _background(color: Tuple[float, ...]) -> Tuple[List[float], Array, Tuple[bytes, ...]]:
    """Linear light of a background, its codes, and for each channel what _CODES is with it: no sRGB code may have the background's code,
    and the nearest one gets it then."""
    codes = np.floor(np.array(color) * 255 + 0.5).astype(np.uint8)
    nearest = np.abs(np.array(list(_CODES))[:, None] - codes[:3]).argmin(axis=0)
    tables = [bytearray(_CODES) for _ in range(3)]
    for table, at, code in zip(tables, nearest, codes):
        table[at] = code
    return [*linear_from_srgb(nearest / 255).tolist(), color[3]], codes, tuple(bytes(table) for table in tables)


def _shadow_flag(light: Light) -> int:
    return _SHADOWS.get(type(light), RenderFlags.SHADOWS_SPOT)


__all__ = ["OffscreenRenderer"]
