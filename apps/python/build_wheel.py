#!/usr/bin/env python3
"""Makes the wheel of the Python package, and is its PEP 517 backend. Needs patchelf and binutils, and no Python package.

    build_wheel.py LIBRARY FOLDER [LICENCES]
        writes FOLDER/halflit-VERSION-py3-none-PLATFORM.whl and prints its name. LIBRARY: libhalflit_python.so, or halflit.dll for Windows.
        LICENCES: a folder with the licences of libraries that are linked statically (./dev package --portable)
    python3 -m build --wheel --no-isolation --config-setting library=LIBHALFLIT_PYTHON_SO
    python3 -m build --sdist --no-isolation

Without `library` the backend builds the library in build/release, by cmake. One wheel serves every Python 3: the package calls the library
through ctypes and knows nothing of Python's or numpy's binary interface.

The wheel brings the libraries that halflit needs beside it, renamed by their content so that another package's copy of the same library
does not take their place, and with their licences. glibc and the C++ library stay those of the system, as PEP 600 asks: two C++ libraries
in one process do not go together, unless one is linked statically and shows no names. A library that is linked so loads under musl too
(cmake/portable/musl_names.c), and the wheel's name says it.
"""
import base64
import gzip
import hashlib
import io
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
C_LIBRARY = re.compile(r"^lib(c|m|dl|pthread|rt)\.so")
OF_SYSTEM = re.compile(C_LIBRARY.pattern + r"|^(lib(resolv|util|stdc\+\+|gcc_s)\.so|ld-linux|linux-vdso)")
# The newest version of the C++ library's symbols that distributions of a glibc have, as in auditwheel's policies.
GLIBCXX_OF_GLIBC = ((24, 22), (26, 24), (27, 24), (28, 25), (31, 28), (34, 29), (35, 30), (38, 32), (39, 33), (41, 34))


def version():
    with open(os.path.join(HERE, "halflit", "_c.py"), encoding="utf-8") as file:
        return re.search(r'^VERSION = "([^"]+)"', file.read(), re.M).group(1)


def metadata():
    with open(os.path.join(HERE, "README.md"), encoding="utf-8") as file:
        readme = file.read()
    return f"""Metadata-Version: 2.1
Name: halflit
Version: {version()}
Summary: Models in, pictures out: a software rasterizer, without a GPU
License: MIT
Requires-Python: >=3.8
Requires-Dist: numpy
Description-Content-Type: text/markdown

{readme}"""


# ---- shared libraries ---------------------------------------------------------------------------------------------------


def output(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, check=False)
    if done.returncode:
        sys.exit(f"build_wheel: {' '.join(command)}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


def needed(path):
    """Libraries that the file needs, directly or not, and that a system need not have: name -> path."""
    found = {}
    if all(OF_SYSTEM.match(name) for name in re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-d", path))):
        return found  # of another processor, perhaps, whose libraries ldd does not know
    for name, where in re.findall(r"^\s*(\S+) => (.*?)(?: \(0x|$)", output("ldd", path), re.M):
        if OF_SYSTEM.match(name):
            continue
        if not os.path.exists(where):
            sys.exit(f"build_wheel: {path} needs {name}, which is not there")
        found[name] = os.path.realpath(where)
    return found


OF_WINDOWS = re.compile(r"^(kernel32|ntdll|msvcrt|advapi32|shell32|user32|psapi|bcrypt|ole32)\.dll$", re.I)


def bundle_for_windows(library, folder):
    """Puts halflit.dll into the folder. It must need nothing but Windows."""
    own = os.path.join(folder, "halflit.dll")
    prefix = "x86_64-w64-mingw32-" if shutil.which("x86_64-w64-mingw32-objdump") else ""
    strange = [name for name in re.findall(r"DLL Name: (\S+)", output(prefix + "objdump", "-p", library)) if not OF_WINDOWS.match(name)]
    if strange:
        sys.exit(f"build_wheel: {library} needs {', '.join(strange)}, which Windows does not have")
    output(prefix + "strip", "--strip-unneeded", "-o", own, library)
    return [own]


def machine(path):
    """The file's processor, by the name that platforms have in names of wheels."""
    kind = re.search(r"Machine: +(.*)", output("readelf", "-h", path)).group(1)
    return {"Advanced Micro Devices X86-64": "x86_64", "AArch64": "aarch64"}.get(kind, platform.machine())


def bundle(library, folder):
    """Puts the library and those that it needs into the folder, each with the folder as its search path. Returns their paths there."""
    own = os.path.join(folder, "libhalflit_python.so")
    shutil.copy(library, own)
    tool = f"{machine(own)}-linux-gnu-strip"
    output(tool if shutil.which(tool) else "strip", "--strip-unneeded", own)  # before patchelf, whose files strip damages
    libraries = needed(library)
    renamed = {}
    for name, path in libraries.items():
        with open(path, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()[:8]
        stem, _, rest = name.partition(".so")
        renamed[name] = f"{stem}-{digest}.so{rest}"
        shutil.copy(path, os.path.join(folder, renamed[name]))
    paths = [own, *(os.path.join(folder, name) for name in renamed.values())]
    for path in paths:
        os.chmod(path, 0o755)
        wanted = set(output("patchelf", "--print-needed", path).split())
        # One change a call: patchelf 0.14 mixes up the names of several.
        if path != own:
            output("patchelf", "--set-soname", os.path.basename(path), path)
        for name in sorted(wanted & set(renamed)):
            output("patchelf", "--replace-needed", name, renamed[name], path)
        for name in sorted(wanted):  # glibc's loader, which is there without being asked for; musl has another one
            if name.startswith("ld-linux"):
                output("patchelf", "--remove-needed", name, path)
        output("patchelf", "--set-rpath", "$ORIGIN", path)
    return paths, libraries


def musl_tag(library, paths):
    """musllinux_1_2 with a dot before it if musl can load the files, which are made from `library`; otherwise an empty string. A library
    with the C++ library inside is made for musl, too: what musl lacks is an error."""
    text = "".join(output("readelf", "-d", path) for path in paths)
    if not all(C_LIBRARY.match(name) for name in re.findall(r"\(NEEDED\).*\[(.*)\]", text)):
        return ""
    with open(os.path.join(ROOT, "cmake", "portable", "musl_names.txt"), encoding="utf-8") as file:
        there = {name for line in file if not line.startswith("#") for name in line.split()}
    needed_names = re.findall(r" U ([^@\s]+)", "".join(output("nm", "-D", "--undefined-only", path) for path in paths))
    lacking = sorted(set(needed_names) - there)
    if lacking:
        sys.exit(f"build_wheel: {library} needs of musl: {' '.join(lacking)}, which cmake/portable/musl_names.txt does not have")
    # std::istream >> and std::regex ask the locale's tables, which musl has elsewhere than glibc.
    if re.search(r" _ZNSi6sentryC|basic_regex", output("nm", library)):
        sys.exit(f"build_wheel: {library} reads text by streams or std::regex, which musl's locales do not allow")
    return f".musllinux_1_2_{machine(paths[0])}"


def platform_tag(library, paths):
    """manylinux_2_X of the oldest glibc that all files can be loaded with: by the versions of its symbols, and of the C++ library's; and
    that of musl where they can be loaded with it."""
    text = "".join(output("readelf", "-V", path) for path in paths)
    glibc = max(int(minor) for minor in re.findall(r"Name: GLIBC_2\.(\d+)", text))
    glibcxx = max([0, *(int(minor) for minor in re.findall(r"Name: GLIBCXX_3\.4\.(\d+)", text))])
    for minor, newest in GLIBCXX_OF_GLIBC:
        if newest >= glibcxx:
            return f"manylinux_2_{max(minor, glibc)}_{machine(paths[0])}{musl_tag(library, paths)}"
    return f"linux_{machine(paths[0])}"


def licences(libraries):
    """The copyright notices of the Debian packages that the libraries come from: file name -> text. Elsewhere: none is found."""
    found = {}
    for path in libraries.values():
        for name in (path, path.replace("/usr/lib/", "/lib/", 1)):
            owner = subprocess.run(["dpkg", "-S", name], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False) \
                if shutil.which("dpkg") else None  # fmt: skip
            if owner is not None and owner.returncode == 0:
                package = owner.stdout.decode().partition(":")[0]
                notice = f"/usr/share/doc/{package}/copyright"
                if os.path.exists(notice):
                    with open(notice, "rb") as file:
                        found[package + ".txt"] = file.read()
                break
    return found


# ---- the wheel ----------------------------------------------------------------------------------------------------------


def make(library, folder, licences_folder=None):
    """Writes the wheel into the folder and returns its name."""
    files = {}
    for folder_of, folders, names in os.walk(os.path.join(HERE, "halflit")):
        folders.sort()
        for name in sorted(names):
            if name.endswith((".py", ".pyi", ".typed")):
                path = os.path.join(folder_of, name)
                with open(path, "rb") as file:
                    files[os.path.relpath(path, HERE)] = file.read()
    fonts = os.path.join(ROOT, "apps", "engine", "fonts")
    for name, path in (("halflit.h", os.path.join(ROOT, "apps", "c", "include", "halflit")), ("dejavu_sans.ttf", fonts)):
        with open(os.path.join(path, name), "rb") as file:
            files["halflit/" + name] = file.read()
    with tempfile.TemporaryDirectory() as scratch:
        if library.endswith(".dll"):
            paths, libraries, tag = bundle_for_windows(library, scratch), {}, "py3-none-win_amd64"
        else:
            paths, libraries = bundle(library, scratch)
            tag = "py3-none-" + platform_tag(library, paths)  # several, with dots between them
        for path in paths:
            with open(path, "rb") as file:
                files["halflit/lib/" + os.path.basename(path)] = file.read()
    info = f"halflit-{version()}.dist-info/"
    notices = licences(libraries)
    for name in sorted(os.listdir(licences_folder)) if licences_folder else ():
        with open(os.path.join(licences_folder, name), "rb") as file:
            notices[name] = file.read()
    for name, text in notices.items():
        files[f"{info}licenses/bundled/{name}"] = text
    for name, path in (("LICENSE", ROOT), ("bundled/dejavu_sans.txt", fonts)):
        with open(os.path.join(path, "LICENSE"), "rb") as file:
            files[info + "licenses/" + name] = file.read()
    files[info + "METADATA"] = metadata().encode()
    start, _, platforms = tag.rpartition("-")
    tags = "".join(f"Tag: {start}-{one}\n" for one in platforms.split("."))
    files[info + "WHEEL"] = f"Wheel-Version: 1.0\nGenerator: halflit\nRoot-Is-Purelib: false\n{tags}".encode()
    name = f"halflit-{version()}-{tag}.whl"
    record = []
    os.makedirs(folder, exist_ok=True)
    with zipfile.ZipFile(os.path.join(folder, name), "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(data)}\n")
            write(archive, path, data)
        write(archive, info + "RECORD", ("".join(record) + f"{info}RECORD,,\n").encode())
    return name


def write(archive, path, data):
    """Adds a file with a fixed date, so that equal contents make equal wheels."""
    entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
    entry.external_attr = (0o100755 if ".so" in path or path.endswith(".dll") else 0o100644) << 16
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, data)


# ---- PEP 517 ------------------------------------------------------------------------------------------------------------


def built_library():
    folder = os.path.join(ROOT, "build", "release")
    flags = [] if os.path.exists(os.path.join(ROOT, "tests")) else ["-DHALFLIT_BUILD_TESTS=OFF"]  # a source distribution has none
    for command in (["cmake", "--preset", "release", *flags], ["cmake", "--build", folder, "--target", "halflit_python"]):
        subprocess.run(command, cwd=ROOT, check=True)
    return os.path.join(folder, "python", "libhalflit_python.so")


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    library = (config_settings or {}).get("library")
    return make(os.path.abspath(library) if library else built_library(), wheel_directory)


def build_sdist(sdist_directory, config_settings=None):
    """The repository's files without tests and benchmarks, with this backend named at the top. Needs git."""
    stem = f"halflit-{version()}"
    files = {"PKG-INFO": metadata().encode()}
    for name in output("git", "-C", ROOT, "ls-files", "-z").split("\0"):
        path = os.path.join(ROOT, name)
        if name and not name.startswith(("tests/", "bench/", ".ci/")) and os.path.isfile(path):
            with open(path, "rb") as file:
                files[name] = file.read()
    settings = files["apps/python/pyproject.toml"].decode()
    files["pyproject.toml"] = settings.replace('backend-path = ["."]', 'backend-path = ["apps/python"]').encode()
    with open(os.path.join(sdist_directory, stem + ".tar.gz"), "wb") as raw, gzip.GzipFile("", "wb", 9, raw, 0) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:  # fmt: skip
        for name, data in sorted(files.items()):
            entry = tarfile.TarInfo(f"{stem}/{name}")
            entry.size = len(data)
            entry.mode = 0o755 if data.startswith(b"#!") else 0o644
            archive.addfile(entry, io.BytesIO(data))
    return stem + ".tar.gz"


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    print(make(*sys.argv[1:]))
