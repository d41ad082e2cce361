"""Scenes."""
from __future__ import annotations

from typing import Any, Dict, Iterable, List, Optional, Set, Union

import numpy as np

from ._values import Array, Boxed, color, text
from .camera import Camera
from .light import DirectionalLight, Light, PointLight, SpotLight
from .mesh import Mesh
from .node import Node
from .primitive import moved

Thing = Union[Mesh, Light, Camera]


class Scene(Boxed):
    """A tree of nodes. bg_color: (4,) or (3,), shares of 255 as they appear in the picture (white). ambient_light: (3,), linear light from
    all around (none)."""

    def __init__(
        self, nodes: Optional[Iterable[Node]] = None, bg_color: Any = None, ambient_light: Any = None, name: Optional[str] = None
    ) -> None:
        self.bg_color = bg_color
        self.ambient_light = ambient_light
        self.name = text(name)
        self._parents: Dict[Node, Optional[Node]] = {}  # a parent comes before its children
        self._main_camera_node: Optional[Node] = None
        self._structure = 0  # counts changes of the tree
        given = list(nodes or ())
        inner = {child for node in given for child in node.children}
        for node in given:
            if node not in inner:
                self.add_node(node)

    @property
    def bg_color(self) -> Array:
        """float32 (4,)."""
        return self._bg_color

    @bg_color.setter
    def bg_color(self, value: Any) -> None:
        self._bg_color = color(4, 1.0)(value)

    @property
    def ambient_light(self) -> Array:
        """float32 (3,)."""
        return self._ambient_light

    @ambient_light.setter
    def ambient_light(self, value: Any) -> None:
        self._ambient_light = color(3, 0.0)(value)

    # ---- what the scene has ---------------------------------------------------------------------------------------------

    @property
    def nodes(self) -> Set[Node]:
        """All nodes."""
        return set(self._parents)

    @property
    def mesh_nodes(self) -> Set[Node]:
        """The nodes with a mesh."""
        return {node for node in self._parents if node.mesh is not None}

    @property
    def light_nodes(self) -> Set[Node]:
        """The nodes with a light."""
        return {node for node in self._parents if node.light is not None}

    @property
    def point_light_nodes(self) -> Set[Node]:
        """The nodes with a point light."""
        return {node for node in self._parents if isinstance(node.light, PointLight)}

    @property
    def spot_light_nodes(self) -> Set[Node]:
        """The nodes with a spot light."""
        return {node for node in self._parents if isinstance(node.light, SpotLight)}

    @property
    def directional_light_nodes(self) -> Set[Node]:
        """The nodes with a directional light."""
        return {node for node in self._parents if isinstance(node.light, DirectionalLight)}

    @property
    def camera_nodes(self) -> Set[Node]:
        """The nodes with a camera."""
        return {node for node in self._parents if node.camera is not None}

    @property
    def meshes(self) -> Set[Mesh]:
        """The meshes."""
        return {node.mesh for node in self._parents if node.mesh is not None}

    @property
    def lights(self) -> Set[Light]:
        """The lights."""
        return {node.light for node in self._parents if node.light is not None}

    @property
    def point_lights(self) -> Set[Light]:
        """The point lights."""
        return {light for light in self.lights if isinstance(light, PointLight)}

    @property
    def spot_lights(self) -> Set[Light]:
        """The spot lights."""
        return {light for light in self.lights if isinstance(light, SpotLight)}

    @property
    def directional_lights(self) -> Set[Light]:
        """The directional lights."""
        return {light for light in self.lights if isinstance(light, DirectionalLight)}

    @property
    def cameras(self) -> Set[Camera]:
        """The cameras."""
        return {node.camera for node in self._parents if node.camera is not None}

    @property
    def main_camera_node(self) -> Optional[Node]:
        """The node of the camera that draws: the first that was added, or the one that was set."""
        return self._main_camera_node

    @main_camera_node.setter
    def main_camera_node(self, value: Node) -> None:
        if value not in self._parents:
            raise ValueError("main_camera_node: expected a node of the scene")
        self._main_camera_node = value

    @property
    def bounds(self) -> Array:
        """Box, (2, 3), of all meshes; zeros without any."""
        meshes = [(node, node.mesh) for node in self._parents if node.mesh is not None]
        boxes = [moved(mesh.bounds, self.get_pose(node)[None]) for node, mesh in meshes if mesh.primitives]
        if not boxes:
            return np.zeros((2, 3))
        return np.array([np.min([box[0] for box in boxes], axis=0), np.max([box[1] for box in boxes], axis=0)])

    # ---- changes --------------------------------------------------------------------------------------------------------

    def add(
        self,
        obj: Thing,
        name: Optional[str] = None,
        pose: Any = None,
        parent_node: Optional[Node] = None,
        parent_name: Optional[str] = None,
    ) -> Node:
        """Adds a mesh, a light or a camera by a new node, which is returned. pose: (4, 4), relative to the parent."""
        for kind, member in ((Mesh, "mesh"), (Light, "light"), (Camera, "camera")):
            if isinstance(obj, kind):
                node = Node(name=name, matrix=pose, **{member: obj})  # type: ignore[arg-type]
                break
        else:
            raise TypeError(f"expected a Mesh, a Light or a Camera, found {type(obj).__name__}")
        if parent_node is None and parent_name is not None:
            found = [parent for parent in self._parents if parent.name == parent_name]
            if len(found) != 1:
                raise ValueError(f"parent_name: expected the name of one node, found {len(found)} named {parent_name!r}")
            parent_node = found[0]
        self.add_node(node, parent_node=parent_node)
        return node

    def add_node(self, node: Node, parent_node: Optional[Node] = None) -> None:
        """Adds a node and its children. parent_node: None: it is a root."""
        if node in self._parents:
            raise ValueError("the node is in the scene already")
        if parent_node is not None:
            if parent_node not in self._parents:
                raise ValueError("parent_node: expected a node of the scene")
            if node not in parent_node.children:
                parent_node.children.append(node)
        self._parents[node] = parent_node
        self._structure += 1
        if node.camera is not None and self._main_camera_node is None:
            self._main_camera_node = node
        for child in node.children:
            self.add_node(child, node)

    def has_node(self, node: Node) -> bool:
        """Whether the node is in the scene."""
        return node in self._parents

    def remove_node(self, node: Node) -> None:
        """Removes a node and its children."""
        parent = self._parents[node]
        self._remove(node)
        if parent is not None:
            parent.children.remove(node)
        if self._main_camera_node not in self._parents:
            left = [other for other in self._parents if other.camera is not None]
            self._main_camera_node = left[0] if left else None

    def _remove(self, node: Node) -> None:
        del self._parents[node]
        self._structure += 1
        for child in node.children:
            self._remove(child)

    def clear(self) -> None:
        """Removes all nodes."""
        self._parents.clear()
        self._main_camera_node = None
        self._structure += 1

    def get_nodes(
        self, node: Optional[Node] = None, name: Optional[str] = None, obj: Optional[Thing] = None, obj_name: Optional[str] = None
    ) -> Set[Node]:
        """The nodes that fit all that is given: the node itself, its name, the mesh, light or camera that it has, or the name of that."""
        if node is not None:
            return {node} & self._parents.keys()
        found: List[Node] = []
        for one in self._parents:
            things = [thing for thing in (one.mesh, one.camera, one.light) if thing is not None]
            if name is not None and one.name != name:
                continue
            if obj is not None and not any(thing is obj for thing in things):
                continue
            if obj_name is None or any(thing.name == obj_name for thing in things):
                found.append(one)
        return set(found)

    def get_pose(self, node: Node) -> Array:
        """World from node, (4, 4)."""
        if node not in self._parents:
            raise ValueError("the node is not in the scene")
        pose: Array = np.array(node._matrix, np.float64)
        parent = self._parents[node]
        while parent is not None:
            pose = parent._matrix @ pose
            parent = self._parents[parent]
        return pose

    def set_pose(self, node: Node, pose: Any) -> None:
        """Places a node, relative to its parent."""
        if node not in self._parents:
            raise ValueError("the node is not in the scene")
        node.matrix = pose

    @staticmethod
    def from_trimesh_scene(trimesh_scene: Any, bg_color: Any = None, ambient_light: Any = None) -> Scene:
        """A scene of the meshes of a trimesh.Scene."""
        made = Scene(bg_color=bg_color, ambient_light=ambient_light)
        meshes = {name: Mesh.from_trimesh(mesh) for name, mesh in trimesh_scene.geometry.items()}
        for node in trimesh_scene.graph.nodes_geometry:
            pose, name = trimesh_scene.graph[node]
            made.add(meshes[name], pose=pose)
        return made
