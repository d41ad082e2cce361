"""The recipes of package managers: by their own parsers where these are there, and against the list of libraries."""
import ast
import json
import os
import re
import tempfile
import unittest

from common import PACKAGING, ROOT, main, need, output, text_of

# Libraries that a recipe need not name: those of the window, of tests and of benchmarks.
USES = ("raster", "io", "program")


def libraries(uses):
    """(name, Debian's package) of each library with one of these uses, from the list that CMake reads."""
    rows = re.findall(r'^    "(\S+) +([a-z]+) +\S+ +\S+ +(\S+) ', text_of(ROOT, "cmake", "dependencies.cmake"), re.M)
    return [(name, package) for name, use, package in rows if use in uses]


def plain(name):
    """A library's name without what package managers write in different ways."""
    name = re.sub(r"[^a-z0-9]", "", name.lower())
    name = re.sub(r"^lib|(mux|devel|turbo)$", "", name)
    return {"jpegturbo": "jpeg", "giflib": "gif", "iflib": "gif"}.get(name, name)


class Recipes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        need("bash", "sha256sum")
        cls.temporary = tempfile.TemporaryDirectory()
        tarball = os.path.join(cls.temporary.name, "source.tar.gz")
        with open(tarball, "wb") as file:
            file.write(b"source")
        cls.folder = os.path.join(cls.temporary.name, "recipes")
        output(os.path.join(PACKAGING, "recipes.sh"), "1.2.3", tarball, cls.folder,
               env={**os.environ, "HALFLIT_HOMEPAGE": "https://home.invalid"})

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def has_libraries(self, text, uses=USES):
        words = {plain(word) for word in re.findall(r"[A-Za-z0-9_-]+", text)}
        for name, _ in libraries(uses):
            self.assertIn(plain(name), words, f"{name} is not named")

    def test_no_place_is_left_open(self):
        found = 0
        for folder, _, names in os.walk(self.folder):
            for name in names:
                found += 1
                text = text_of(folder, name)
                self.assertIsNone(re.search(r"@[A-Z0-9]+@", text), name)
                if "vcpkg.json" not in name:
                    self.assertIn("https://home.invalid/halflit-", text, name)
        self.assertEqual(found, 5)

    def test_homebrew(self):
        path = os.path.join(self.folder, "homebrew", "halflit.rb")
        self.has_libraries(text_of(path))
        need("ruby")
        output("ruby", "-c", path)

    def test_vcpkg(self):
        port = json.loads(text_of(self.folder, "vcpkg", "vcpkg.json"))
        self.assertEqual(port["version"], "1.2.3")
        self.has_libraries(json.dumps(port), ("raster", "io"))
        need("cmake")
        # The functions of vcpkg, which a port is made of, as functions that do nothing.
        portfile = os.path.join(self.folder, "vcpkg", "portfile.cmake")
        names = sorted(set(re.findall(r"^(vcpkg_\w+)\(", text_of(portfile), re.M)))
        stubs = "".join(f"function({name})\nendfunction()\n" for name in names)
        script = os.path.join(self.temporary.name, "port.cmake")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f'{stubs}set(CURRENT_PACKAGES_DIR "{self.temporary.name}/installed")\ninclude("{portfile}")\n')
        output("cmake", "-P", script)

    def test_conan(self):
        text = text_of(self.folder, "conan", "conanfile.py")
        ast.parse(text)
        self.has_libraries(text, ("raster", "io"))

    def test_conda(self):
        text = text_of(self.folder, "conda", "meta.yaml")
        self.has_libraries(text)
        need("ruby")
        output("ruby", "-ryaml", "-e", "exit YAML.load(STDIN.read)['package']['version'] == '1.2.3'", input=text)

    def test_nix(self):
        self.has_libraries(text_of(PACKAGING, "nix", "halflit.nix"))
        need("nix-instantiate")
        for path in (os.path.join(ROOT, "flake.nix"), os.path.join(PACKAGING, "nix", "halflit.nix")):
            output("nix-instantiate", "--parse", path)
        # The package's name with the version that it reads from the source, with stand-ins for Nix's own packages.
        stand_ins = (f'{{ source = "{ROOT}"; lib = {{ licenses.mit = 1; platforms.linux = 1; }};'
                     " stdenv.mkDerivation = x: x.pname + x.version; }")
        package = f"{PACKAGING}/nix/halflit.nix"
        name = output("nix-instantiate", "--eval", "-E",
                      f"let f = import {package}; in f (builtins.mapAttrs (n: v: n) (builtins.functionArgs f) // {stand_ins})",
                      env={**os.environ, "NIX_STATE_DIR": self.temporary.name, "NIX_STORE_DIR": f"{self.temporary.name}/store"})
        self.assertEqual(name.strip(), f'"halflit{output(os.path.join(PACKAGING, "versions.py"), ROOT).strip()}"')

    def test_debian(self):
        control = text_of(PACKAGING, "debian", "control")
        needed = re.search(r"^Build-Depends:(.*?)^\S", control, re.M | re.S).group(1)
        for name, package in libraries((*USES, "viewer")):
            self.assertRegex(needed, rf"\b{re.escape(package)}[,\n ]", name)
        version = re.search(r"VERSION (\d+\.\d+)", text_of(ROOT, "CMakeLists.txt").split("project(halflit")[1]).group(1)
        self.assertIn(f"Package: libhalflit{version}\n", control)


if __name__ == "__main__":
    main()
