"""Models and scenes of MuJoCo that are made by hand, of any version: what its arrays have, without MuJoCo."""
import hashlib
import json
import sys
import types

import numpy as np

import halflit.compat.mujoco as compat
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


def _plain(value):
    """Converts objects and arrays to values that JSON can hold."""
    if isinstance(value, types.SimpleNamespace):
        return {name: _plain(one) for name, one in vars(value).items()}
    if isinstance(value, list) and value and isinstance(value[0], types.SimpleNamespace):
        return [_plain(one) for one in value]
    return np.ravel(value).tolist() if isinstance(value, (list, np.ndarray)) else value


def _main():
    """Prints a scene of MuJoCo 3.3.8, its model and the hashes of its pictures, for other front ends to draw."""
    version, size = (3, 3, 8), 96
    sys.modules["mujoco"] = types.SimpleNamespace(__version__=".".join(map(str, version)))
    rng = np.random.default_rng(7)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32)
    skin, face_corners = corners + np.float32([-3, 1, 1]), corners[faces].reshape(-1, 3) + np.float32([-3, -3, 0])
    used = model(
        samples=4, ngeom=1, nmat=1, nmesh=1, nmeshvert=4, nmeshnormal=4, nmeshface=4, ntex=1, ntexdata=6 * 8 * 8 * 3, nskin=1, nskinvert=4,
        nskinface=4, nflex=1, nhfield=1, nhfielddata=20, geom_type=[PLANE], geom_matid=[0], geom_size=[[3, 3, 0.1]], mat_texid=np.array([[-1, 0] + 8 * [-1]]),
        mat_texuniform=[0], mat_texrepeat=[[2, 2]], mesh_vertadr=[0], mesh_vertnum=[4], mesh_normaladr=[0], mesh_texcoordadr=[-1],
        mesh_faceadr=[0], mesh_facenum=[4], mesh_graphadr=[-1], mesh_vert=corners, mesh_normal=np.tile(np.float32([0, 0, 1]), (4, 1)),
        mesh_face=faces, mesh_facenormal=faces, mesh_facetexcoord=faces, tex_type=[0], tex_width=[8], tex_height=[48], tex_nchannel=[3],
        tex_colorspace=[2], tex_adr=[0], tex_data=rng.integers(0, 256, 6 * 8 * 8 * 3, np.uint8), skin_vertadr=[0], skin_vertnum=[4],
        hfield_size=[[1.0, 0.75, 0.5, 0.1]], hfield_nrow=[4], hfield_ncol=[5], hfield_adr=[0], hfield_data=rng.random(20, np.float32),
        skin_texcoordadr=[-1], skin_faceadr=[0], skin_facenum=[4], skin_face=faces,
    )  # fmt: skip
    scene = Scene(version).shine(0.2, 0.5, (0.3, 0.2, -0.9)).look((1, -6, 5), (-0.15, 0.77, -0.62), (-0.12, 0.61, 0.78))
    scene.lights[0].castshadow, scene.lights[0].specular = 1, np.full(3, 0.4)
    scene.flags[list(FLAGS[name] for name in ("shadow", "reflection"))] = 1
    scene.add(PLANE, (3, 3, 0.1), matid=0, reflectance=0.3, modelrbound=0)
    scene.add(SPHERE, (0.7, 0.7, 0.7), (1, 0, 1), (0.8, 0.3, 0.1, 1), specular=0.5, shininess=0.5, modelrbound=0.7)
    scene.add(BOX, (0.5, 0.4, 0.6), (-1, -1, 0.8), (0.1, 0.6, 0.9, 0.5), modelrbound=1)
    scene.add(MESH, (1, 1, 1), (-0.5, 1, 0.5), (0.9, 0.9, 0.2, 1), dataid=0, modelrbound=1)
    scene.add(106, (1, 1, 1), rgba=(0.2, 0.9, 0.3, 1), objid=0).add(105, (1, 1, 1), rgba=(0.9, 0.3, 0.8, 1), objid=0)
    scene.add(1, (1, 0.75, 0.5), (2, 1.5, 0.1), (0.4, 0.4, 0.9, 1), dataid=0, modelrbound=1.5)
    scene.skinvert, scene.skinnormal = skin.ravel(), np.tile(np.float32([0, 0, 1]), 4)
    scene.flexface, scene.flexnormal = face_corners.ravel(), np.tile(np.float32([0, 0.6, 0.8]), len(face_corners))
    scene.flexfacenum, scene.flexfaceused = np.array([4], np.int32), np.array([4], np.int32)
    soft = {name: getattr(scene, name) for name in ("skinvert", "skinnormal", "flexface", "flexnormal", "flexfacenum", "flexfaceused")}
    pictures = []
    for turned in (False, True):
        if turned:  # a room of another scale, and a parallel camera
            scene.enabletransform, scene.scale = 1, 1.25
            scene.translate[:], scene.rotate[:] = (0.5, -0.25, 0.125), (0.9, 0.1, -0.2, 0.375)
            for camera in scene.camera:
                camera.orthographic, camera.frustum_width, camera.frustum_bottom, camera.frustum_top = 1, 6, -5, 5
        planes = compat.render_batch([scene], compat.MjrContext(used), size, size, depth=True, segmentation=True)
        hashes = {name: hashlib.sha256(plane.tobytes()).hexdigest() for name, plane in planes.items()}
        told = types.SimpleNamespace(**vars(scene.without_memory()), **soft)
        pictures.append(types.SimpleNamespace(scene=told, sha256=types.SimpleNamespace(**hashes)))
    print(json.dumps({"model": _plain(used), "size": size, "pictures": _plain(pictures)}))


if __name__ == "__main__":
    _main()
