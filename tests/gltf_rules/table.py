"""The table of rules: each row makes one file that keeps a "must" of the specification, at its edge, and one that breaks it."""
import itertools
from dataclasses import dataclass, field
from typing import Callable, Optional

from scene import Scene, base


@dataclass
class Row:
    section: str  # of glTF 2.0, or an extension's name
    name: str
    valid: Callable  # changes a scene, or returns the file's bytes, or {name: bytes} with the model first
    invalid: Callable
    see: Optional[str]  # words of the refusal or the warning; None: nothing drawn depends on it, the file loads
    allowed: list = field(default_factory=list)  # words of warnings that the valid file may have


ROWS = []


def pair(section, name, valid, invalid, see, allowed=()):
    ROWS.append(Row(section, name, valid, invalid, see, list(allowed)))


def values(section, path, good, bad, see="", with_also=None, allowed=()):
    """One pair for each bad value of a property; good ones are taken in turn. The path that must be shown is the property's own."""
    def change(value):
        def apply(scene: Scene):
            if with_also is not None:
                with_also(scene)
            scene.put(path, value)
        return apply
    for value, wrong in zip(itertools.cycle(good), bad):
        pair(section, "%s is %s" % (path, str(wrong)[:40]), change(value), change(wrong), path if see == "" else see, allowed)


def missing(section, path, see=""):
    """A required property that is left out; the object's path must be shown."""
    pair(section, path + " is missing", lambda s: None, lambda s: s.drop(path), path.rpartition(".")[0] if see == "" else see)




def put(*settings):
    """A change of a scene: put((path, value), ...)."""
    def apply(scene):
        for path, value in settings:
            scene.put(path, value)
    return apply


def files_of(made, scene):
    """The files of a change's result."""
    if made is None or not isinstance(made, (bytes, dict)):
        return {"": scene.glb()}
    return {"": made} if isinstance(made, bytes) else made


def make(row):
    """Files of the valid and of the invalid half."""
    halves = []
    for change in (row.valid, row.invalid):
        scene = base()
        halves.append(files_of(change(scene), scene))
    return halves
