"""Programs of OpenGL's shaders, by their files. halflit runs none; it knows those that show normals."""
from __future__ import annotations

import os
import re
from typing import Any, Dict, List, Optional


class ShaderProgram:
    """A program by the files of its shaders, which are read by the first picture."""

    def __init__(
        self, vertex_shader: Any, fragment_shader: Any, geometry_shader: Any = None, defines: Optional[Dict[str, Any]] = None
    ) -> None:
        self.vertex_shader, self.fragment_shader, self.geometry_shader = vertex_shader, fragment_shader, geometry_shader
        self.defines = {} if defines is None else defines

    def set_uniform(self, name: str, value: Any, unsigned: bool = False) -> None:
        """Sets nothing: a program that shows normals has no uniforms of its own."""

    def delete(self) -> None:
        """Frees nothing."""


class ShaderProgramCache:
    """Programs by the names of their files."""

    def __init__(self, shader_dir: Optional[str] = None) -> None:
        self.shader_dir = shader_dir
        self._programs: Dict[Any, ShaderProgram] = {}

    def get_program(
        self, vertex_shader: Any, fragment_shader: Any, geometry_shader: Any = None, defines: Optional[Dict[str, Any]] = None
    ) -> ShaderProgram:
        """The program of these files."""
        key = (vertex_shader, fragment_shader, geometry_shader, tuple(sorted((defines or {}).items())))
        return self._programs.setdefault(key, ShaderProgram(vertex_shader, fragment_shader, geometry_shader, defines))

    def clear(self) -> None:
        """Forgets all."""
        self._programs.clear()


def shows_normals(program: Any) -> Optional[str]:
    """The space, "world" or "view", of the normals that a program shows as shares of 255, (n + 1) / 2; None: it has lights, as pyrender's
    own. Refuses other programs. Of files that are not there nothing is known, and they are taken for the usual ones of this kind."""
    vertex, fragment = (_statements(getattr(program, name, None)) for name in ("vertex_shader", "fragment_shader"))
    if any("light" in line for line in fragment):
        return None
    if fragment and not any("normal" in line.lower() for line in fragment):
        raise NotImplementedError(
            f"{program.fragment_shader}: halflit runs no shaders of OpenGL. It knows those that show normals; what else a script may "
            "want of a picture, such as positions, depths and numbers of triangles, are planes of halflit.Scene.render(aovs=...)"
        )
    turned = [line.split("=", 1)[1] for line in vertex if "normal" in line.split("=")[0].lower()]
    return "view" if any(re.search(r"\bV\b", line) for line in turned) else "world"


def _statements(file: Any) -> List[str]:
    """The assignments of a shader, without comments; none of a file that is not there."""
    try:
        with open(os.fspath(file), encoding="utf-8", errors="replace") as source:
            text = source.read()
    except (OSError, TypeError):
        return []
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S)
    return [" ".join(one.split()) for one in re.split(r"[;{}]", text) if "=" in one and not re.match(r"\s*(layout|uniform|in|out)\b", one)]


__all__ = ["ShaderProgram", "ShaderProgramCache"]
