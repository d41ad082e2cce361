"""Models and scenes of MuJoCo that are made by hand, of any version: what its arrays have, without MuJoCo."""
import types

import numpy as np

from halflit.compat.mujoco._layouts import layout_of

PLANE, SPHERE, BOX, MESH = 0, 2, 6, 7
FLAGS = {"shadow": 0, "reflection": 2, "skybox": 4, "haze": 6, "segment": 7, "idcolor": 8, "cull_face": 9}


class Row:
    """A row of a structured array: numbers, and views of its arrays, as the objects of the module `mujoco` have."""

    def __init__(self, rows, i):
        self.__dict__.update(rows=rows, i=i)

    def __getattr__(self, name):
        if name not in self.rows.dtype.names:
            raise AttributeError(name)
        value = self.rows[name][self.i]
        return value.reshape(3, 3) if name == "mat" else value

    def __setattr__(self, name, value):
        self.rows[name][self.i] = np.reshape(value, self.rows[name].shape[1:])


class Scene:
    """A mjvScene whose structs are arrays of a version's layout."""

    def __init__(self, version=(2, 2, 2), maxgeom=8):
        kinds = layout_of(version).types
        rows = {"geoms": np.zeros(maxgeom, kinds["geom"]), "lights": np.zeros(4, kinds["light"]), "camera": np.zeros(2, kinds["camera"])}
        for name, array in rows.items():
            setattr(self, name, tuple(Row(array, i) for i in range(len(array))))
        self.rows, self.maxgeom, self.ngeom, self.nlight = rows, maxgeom, 0, 0
        self.enabletransform, self.scale = 0, 1.0
        self.translate, self.rotate = np.zeros(3, np.float32), np.array([1, 0, 0, 0], np.float32)
        self.flags = np.zeros(layout_of(version).flags[-1] + 1, np.uint8)
        self.flags[-1] = 1  # cull_face
        self.look()

    def look(self, eye=(0, 0, 10), forward=(0, 0, -1), up=(0, 1, 0), near=0.2, far=40.0):
        """A camera of 90 degrees."""
        for camera in self.camera:
            camera.pos, camera.forward, camera.up = eye, forward, up
            camera.frustum_bottom, camera.frustum_top, camera.frustum_near, camera.frustum_far = -near, near, near, far
        return self

    def add(self, kind, size, pos=(0, 0, 0), rgba=(1, 1, 1, 1), **members):
        names = self.rows["geoms"].dtype.names
        given = {"dataid": -1, "objtype": 5, "objid": self.ngeom, "category": 2, "matid": -1, "texid": -1, "texrepeat": (1, 1),
                 "segid": self.ngeom, "mat": np.eye(3), **members}  # fmt: skip
        geom = self.geoms[self.ngeom]
        for name, value in {"type": kind, "size": size, "pos": pos, "rgba": rgba, **given}.items():
            if name in names:
                setattr(geom, name, value)
        self.ngeom += 1
        return self

    def shine(self, ambient=0.0, diffuse=0.0, direction=(0, 0, -1)):
        """A directional light without shadows."""
        light = self.lights[self.nlight]
        light.pos, light.dir, light.attenuation, light.cutoff = (0, 0, 20), direction, (1, 0, 0), 45
        light.ambient, light.diffuse = np.full(3, ambient), np.full(3, diffuse)
        setattr(light, "type" if "type" in self.rows["lights"].dtype.names else "directional", 1)
        self.nlight += 1
        return self

    def without_memory(self):
        """The same as objects with lists."""

        def listed(row):
            names = [name for name in row.rows.dtype.names if name != "label"]
            return types.SimpleNamespace(**{name: np.asarray(getattr(row, name)).tolist() for name in names})

        names = ("ngeom", "nlight", "enabletransform", "scale", "maxgeom")
        lists = {name: [listed(row) for row in getattr(self, name)] for name in self.rows}
        arrays = {name: getattr(self, name).tolist() for name in ("flags", "translate", "rotate")}
        return types.SimpleNamespace(**{name: getattr(self, name) for name in names}, **lists, **arrays)


def model(extent=4.0, samples=0, **members):
    """A mjModel without geoms, whose members are given."""
    part = types.SimpleNamespace
    visual = part(
        map=part(znear=0.05, zfar=10.0, shadowclip=1.0, shadowscale=0.6, fogstart=3.0, fogend=10.0, haze=0.3),
        quality=part(shadowsize=1024, offsamples=samples, numslices=28, numstacks=16, numquads=4),
        global_=part(linewidth=1.0, offwidth=640, offheight=480),
        rgba=part(fog=np.zeros(4, np.float32), haze=np.ones(4, np.float32)),
    )
    numbers = "ngeom nmat nmesh nmeshvert nmeshtexvert nmeshface nmeshgraph nhfield nhfielddata ntex ntexdata nskin nskinvert nskintexvert"
    return part(vis=visual, stat=part(extent=extent), **{**dict.fromkeys(numbers.split(), 0), **members})
