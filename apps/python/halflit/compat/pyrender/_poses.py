"""The matrices of all nodes of a scene at once."""
from __future__ import annotations

from typing import Dict, List, Tuple

import numpy as np

from ._values import Array
from .node import Node
from .scene import Scene


class Poses:
    """World from node, of each node. The tree is looked at again when it has changed, and the matrices in each call."""

    def __init__(self) -> None:
        self._structure = -1
        self._nodes: List[Node] = []
        self._levels: List[Tuple[Array, Array]] = []  # rows of nodes, and of their parents
        self.rows: Dict[Node, int] = {}

    def of(self, scene: Scene) -> Array:
        """float64 (n, 4, 4), in the order of `rows`."""
        if scene._structure != self._structure:
            self._look(scene)
        if not self._nodes:
            return np.zeros((0, 4, 4))
        world = np.array([node._matrix for node in self._nodes], np.float64)
        for nodes, parents in self._levels:
            world[nodes] = world[parents] @ world[nodes]
        return world

    def _look(self, scene: Scene) -> None:
        self._structure = scene._structure
        self._nodes = list(scene._parents)
        self.rows = {node: row for row, node in enumerate(self._nodes)}
        depth: Dict[Node, int] = {}
        levels: List[List[Tuple[int, int]]] = []
        for node, parent in scene._parents.items():  # a parent comes first
            depth[node] = 0 if parent is None else depth[parent] + 1
            if parent is not None:
                levels.extend([] for _ in range(depth[node] - len(levels)))
                levels[depth[node] - 1].append((self.rows[node], self.rows[parent]))
        self._levels = [(np.array(level)[:, 0], np.array(level)[:, 1]) for level in levels]
