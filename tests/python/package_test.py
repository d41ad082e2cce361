"""The package as a whole: it agrees with halflit.h, imports quickly, and says what each part is."""
import ast
import ctypes
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import typing
import unittest
import unittest.mock

import numpy as np

import halflit
from halflit import _c, _members, _options, _picture_options

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
APPS = os.path.join(ROOT, "apps")


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


#: A program of a user; a comment has the name that type checkers refuse in its line.
TYPED = """\
import io
import numpy as np
import halflit
picture: halflit.Picture = halflit.render("demo", (8, 8), samples=8)
scene = halflit.Scene.load(io.BytesIO(b""), up="z")
mesh = scene.add_mesh(np.zeros((3, 3)), material={"base_color": (1, 0, 0), "lobe": ("sloan", 0.6), "normal_texture": 3})
scene.add_light({"type": "point", "position": (0, 2, 0)})
scene.add_light("spot", outer_cone_rad=0.4)
setup = scene.setup(8, azimuth=30, view="iso")
camera = halflit.Camera(np.eye(4), fov_y_rad=0.8)
for other in scene.render_batch([camera, (30, 20)], 8, aovs=["depth"], dtype=np.float32):
    other.save(io.BytesIO(), format="png")
    print(other.aovs["depth"].max(), other.report["total_ms"], other.mean(), other.settings, other.copy().camera)
halflit.render("x", sampels=3)  # sampels
scene.setup(8, samples=3)  # samples
scene.add_mesh(np.zeros((3, 3)), material={"base_colour": (1, 0, 0)})  # MaterialMembers
scene.add_light("spot", colour=(1, 1, 1))  # colour
halflit.Material(rougness=0.3)  # rougness
print(scene.material(0).metalic)  # metalic
"""


class Header(unittest.TestCase):
    def test_members_are_those_of_the_tables(self):
        done = subprocess.run([sys.executable, os.path.join(APPS, "c", "tables.py"), "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_structs_have_the_sizes_of_the_library(self):
        # A struct of any other size would be refused, or its last member would not be set.
        sizes = {name: ctypes.sizeof(struct) for name, struct in _c.STRUCT.items()}
        self.assertGreater(len(sizes), 15)
        with_defaults = re.findall(r"\b(\w+)_init\(", " ".join(_c.FUNCTIONS))
        for name, struct in _c.STRUCT.items():
            if name not in with_defaults:
                continue
            longer = (ctypes.c_char * (sizes[name] + 64))(*b"\xff" * (sizes[name] + 64))
            _c.call(name[len("halflit_") :] + "_init", longer, len(longer))
            self.assertEqual(longer.raw[sizes[name] :], b"\0" * 64, name)  # the library fills what it does not know with 0
        self.assertAlmostEqual(_c.make("settings").line_width, 1.5)  # the last members
        self.assertEqual(_c.make("material").sheen_roughness_texture.texture, -1)
        self.assertEqual(_c.make("environment_options").keep_image, 1)

    def test_keywords_are_typed(self):
        members = {member for member, _ in _options.SETTINGS.values()} | {"background", "edge_color", "lobe"}
        chosen = {"size", "reserved", "region", "exposure", "override_lobe", "background_environment"}
        self.assertEqual(members, {name for name, _ in _c.STRUCT["halflit_settings"]._fields_} - chosen)
        for kind, keywords in (
            (halflit.Material, _members.MaterialMembers),
            (halflit.Light, _members.LightMembers),
            (halflit.Camera, _members.CameraMembers),
            (halflit.Lobe, _members.LobeMembers),
            (halflit.TextureUse, _members.TextureUseMembers),
        ):
            self.assertEqual(set(kind._members()) - {"matrix", "world_from_camera"}, set(keywords.__annotations__), kind)
        for kind in (halflit.Material, halflit.Light, halflit.Camera, halflit.Lobe, halflit.TextureUse):
            self.assertEqual(set(kind._members()) - {"matrix", "sides", "world_from_camera"}, {name for name in kind.__annotations__ if name[0] != "_"}, kind)

    def test_defaults_are_those_that_are_told(self):
        # tables.py reads them in the C++ headers; here they are those of the compiled library.
        def told(kind):
            entries = re.findall(r"^ {8}(\w+): (.*(?:\n {12}.*)*)", kind.__doc__, re.M)
            return {name: re.search(r"\(([^()]*)\)$", text) for name, text in entries}

        def value(text):
            return eval(text.replace("MiB", "* 2**20"), {"pi": np.pi}) if re.search(r"\d|True|False|None|\bpi\b", text) else text  # noqa: S307

        settings = _options.settings_dict(halflit.Scene.demo().setup(8)._settings)
        settings = {keyword: settings[member] for keyword, (member, _) in _options.SETTINGS.items()}
        for kind, values in (
            (_picture_options.PictureOptions, settings),
            *((kind, kind().to_dict()) for kind in (halflit.Material, halflit.Light, halflit.TextureUse)),
            (halflit.Camera, {**halflit.Camera().to_dict(), "sides": None}),
        ):
            checked = 0
            for name, found in told(kind).items():
                if found is None or isinstance(values.get(name, {}), dict) or found[1] in ("the identity", '""') or name == "metallic":
                    continue
                checked += 1
                wanted = value(found[1])
                if isinstance(wanted, (str, type(None))):
                    self.assertEqual(wanted, values[name], name)
                else:
                    np.testing.assert_allclose(np.float64(values[name]), np.float64(wanted), rtol=1e-6, err_msg=name)
            self.assertGreater(checked, 7, kind)

    def test_public_names_are_a_literal_list(self):
        # Type checkers read the file without running it.
        (names,) = re.findall(r"^__all__ = (\[.*?\])$", text_of("apps", "python", "halflit", "__init__.py"), re.M | re.S)
        self.assertEqual(ast.literal_eval(names), halflit.__all__)
        self.assertEqual(halflit.__all__, sorted(halflit.__all__, key=lambda name: (name[0].islower(), name)))

    def test_version(self):
        self.assertEqual(halflit.version(), halflit.__version__)
        self.assertIn(f"project(halflit VERSION {halflit.__version__} ", text_of("CMakeLists.txt"))
        self.assertGreaterEqual(halflit.pixel_epoch(), 1)


class Import(unittest.TestCase):
    def test_no_circles(self):
        """No module needs, at import or later, one that needs it."""
        for package, least in (("halflit", 50), (os.path.join("halflit", "compat", "pyrender"), 20)):
            folder = os.path.join(APPS, "python", package)
            modules = {name[:-3] for name in os.listdir(folder) if name.endswith(".py") and name != "__init__.py"}
            needs = {}
            for module in modules:
                tree = ast.parse(text_of(folder, module + ".py"))
                for node in ast.walk(tree):  # types alone are needed by no one
                    if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
                        node.body = [ast.Pass()]
                found = needs.setdefault(module, set())
                for node in ast.walk(tree):
                    if isinstance(node, ast.ImportFrom) and node.level == 1:
                        found.update([node.module] if node.module else [alias.name for alias in node.names])
                found &= modules
            self.assertGreater(sum(map(len, needs.values())), least)
            while needs:
                free = [module for module, found in needs.items() if not found & needs.keys()]
                self.assertTrue(free, f"{package}: in circles, or above one: {sorted(needs)}")
                for module in free:
                    del needs[module]

    def test_import_loads_little(self):
        # Time is for benchmarks, as it differs between machines; what takes it is not loaded: numpy, the library, and what they need.
        code = (
            "import sys, time; before = set(sys.modules); start = time.perf_counter(); import halflit; took = time.perf_counter() - start\n"
            "assert halflit._c._loaded is None; print(took * 1000, *sorted(set(sys.modules) - before))"
        )
        environment = {**os.environ, "PYTHONPATH": os.path.join(APPS, "python")}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        environment["PYTHONPYCACHEPREFIX"] = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"halflit_pycache_{os.getuid()}")
        runs = [subprocess.check_output([sys.executable, "-c", code], env=environment).decode().split() for _ in range(10)]
        print(f"import halflit: {min(float(run[0]) for run in runs):.1f} ms", file=sys.stderr)
        allowed = (
            "abc atexit collections contextlib copyreg ctypes enum errno functools halflit importlib itertools keyword math operator re"
            " reprlib signal struct threading types typing warnings"
        )
        loaded = {name.partition(".")[0] for name in runs[-1][1:]}
        self.assertLessEqual({name for name in loaded if not name.startswith("_")}, set(allowed.split()))

    def test_dir_and_help_show_all_names(self):
        self.assertLessEqual(set(halflit.__all__), set(dir(halflit)))
        code = "import halflit, pydoc; print(sorted(set(halflit.__all__) - set(dir(halflit)))); print(pydoc.plain(pydoc.render_doc(halflit)))"
        environment = {**os.environ, "PYTHONPATH": os.path.join(APPS, "python")}
        said = subprocess.check_output([sys.executable, "-c", code], env=environment).decode()
        self.assertTrue(said.startswith("[]\n"))
        for text in ("class Picture(", "contact_sheet(", "class Scene(", "class MeshIndex("):
            self.assertIn(text, said)

    def test_the_default_of_metallic_is_told(self):
        (told,) = re.findall(r"^ +metallic: .*\((.*)\)$", halflit.Material.__doc__, re.M)
        self.assertEqual(told, f"{halflit.Material().metallic:g}; {halflit.Material(metallic_roughness_texture=0).metallic:g} with a metallic_roughness_texture")

    def test_a_library_that_is_not_there_is_named(self):
        code = "import halflit\ntry: halflit.version()\nexcept ImportError as error: print(error)"
        environment = {**os.environ, "PYTHONPATH": os.path.join(APPS, "python"), "HALFLIT_LIBRARY": "/nowhere/lib.so"}
        said = subprocess.check_output([sys.executable, "-c", code], env=environment).decode()
        self.assertIn("/nowhere/lib.so", said)
        self.assertIn("HALFLIT_LIBRARY", said)


class Documentation(unittest.TestCase):
    def test_every_public_name_has_a_docstring_and_types(self):
        checked = 0
        for name in halflit.__all__:
            value = getattr(halflit, name)
            if name == "AOVS":
                continue
            self.assertTrue(value.__doc__, name)
            functions = [value] if inspect.isfunction(value) else []
            if inspect.isclass(value):
                own = [base for base in value.__mro__ if base.__module__.startswith("halflit")]
                public = [member for base in own for name, member in vars(base).items() if not name.startswith("_")]
                functions = [f for f in public if inspect.isfunction(f) or isinstance(f, (property, classmethod))]
            for function in functions:
                function = getattr(function, "fget", None) or getattr(function, "__func__", function)
                self.assertTrue(function.__doc__ or function.__name__ == "close", f"{name}.{function.__name__}")
                if function.__name__ not in ("setter",) and not isinstance(function, property):
                    self.assertIn("return", function.__annotations__, f"{name}.{function.__name__} has no type")
                checked += 1
        self.assertGreater(checked, 40)
        self.assertTrue(os.path.exists(os.path.join(APPS, "python", "halflit", "py.typed")))

    def test_type_hints_are_found_when_the_program_runs(self):
        # As documentation generators and validators look for them.
        checked = 0
        for name in halflit.__all__:
            value = getattr(halflit, name)
            for member in (value, *vars(value).values()) if inspect.isclass(value) else (value,):
                member = getattr(member, "fget", None) or getattr(member, "__func__", member)
                if inspect.isclass(member) or inspect.isfunction(member):
                    typing.get_type_hints(member)
                    checked += 1
        self.assertGreater(checked, 60)
        hints = typing.get_type_hints(halflit.Scene.render)
        self.assertIs(hints["return"], halflit.Picture)

    @unittest.skipUnless(shutil.which("mypy"), "no mypy")
    def test_types_hold_and_catch_misspelled_names(self):
        with tempfile.TemporaryDirectory() as folder:
            user = os.path.join(folder, "user.py")
            with open(user, "w", encoding="utf-8") as file:
                file.write(TYPED)
            command = ["mypy", "--strict", "--enable-incomplete-feature=Unpack", "--python-executable", sys.executable, "--cache-dir", folder]
            command.append(user)
            environment = {**os.environ, "MYPYPATH": os.path.join(APPS, "python")}
            said = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False).stdout.decode()
        errors = [line for line in said.splitlines() if ": error:" in line]  # of the package's own files too
        expected = [line.split("# ")[1] for line in TYPED.splitlines() if "# " in line]
        self.assertEqual(len(errors), len(expected), said)
        for error, name in zip(errors, expected):
            self.assertIn(name, error)

    @unittest.skipUnless(shutil.which("pyright"), "no pyright")
    def test_pyright_finds_the_same_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            user = os.path.join(folder, "user.py")
            with open(user, "w", encoding="utf-8") as file:
                file.write(TYPED)
            package = os.path.join(APPS, "python")
            command = ["pyright", "--outputjson", "--pythonpath", sys.executable, user, os.path.join(package, "halflit")]
            done = subprocess.run(command, env={**os.environ, "PYTHONPATH": package}, stdout=subprocess.PIPE, check=False)
        found = [(os.path.basename(one["file"]), one["range"]["start"]["line"]) for one in json.loads(done.stdout)["generalDiagnostics"]]
        self.assertEqual(found, [("user.py", i) for i, line in enumerate(TYPED.splitlines()) if "# " in line])

    def test_the_readmes_program_draws(self):
        for path in (("README.md",), ("docs", "library.md"), ("apps", "python", "README.md")):
            programs = re.findall(r"```python\n(.*?)```", text_of(*path), re.S)
            self.assertTrue(programs, path)
            for program in programs:
                saved = []
                scope = {"__name__": "readme"}
                with unittest.mock.patch.object(halflit.Picture, "save", lambda self, name: saved.append((name, self))):
                    exec(program, scope)  # noqa: S102
                self.assertLessEqual(len(program.strip().splitlines()), 45)
                for name, picture in saved:
                    self.assertGreater(len(np.unique(np.asarray(picture).reshape(-1, 4), axis=0)), 50, name)


if __name__ == "__main__":
    unittest.main()
