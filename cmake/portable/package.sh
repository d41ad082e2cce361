#!/usr/bin/env bash
# Makes packages that run on old and new systems (`./dev package --portable`): a program without shared libraries, and a wheel.
#   package.sh ARCH ROOT FOLDER     ARCH: amd64 or arm64; ROOT: the project; FOLDER: where the packages go
# Intermediate files are kept in ROOT/build/portable.
set -euo pipefail

arch=$1 root=$(realpath "$2")
mkdir -p "$3"
output=$(realpath "$3")
here=$root/cmake/portable
made=$root/build/portable/$arch sources=$root/build/portable/sources
# Debian's sources of what is linked, and Debian's packages of what is compiled in: headers, and the compiler's own libraries.
linked=(draco expat fmtlib giflib imath libdeflate libjpeg-turbo libspng libwebp meshoptimizer openexr zlib)
compiled_in=(libxsimd-dev libexpected-dev libcli11-dev nlohmann-json3-dev libstb-dev gcc-12-base)

# run STEP COMMAND...: quiet unless it fails.
run() {
    local log=$made/$1.log
    echo "dev: building (portable, $arch: $1)" >&2
    shift
    "$@" >"$log" 2>&1 || {
        tail -n 60 "$log" >&2
        exit 1
    }
}

case $arch in
amd64) triplet=x86_64-linux-gnu ;;
arm64) triplet=aarch64-linux-gnu ;;
*)
    echo "package.sh: expected amd64 or arm64, found '$arch'" >&2
    exit 2
    ;;
esac
mkdir -p "$made"
run sources "$root/apps/web/sources.sh" "$sources" "${linked[@]}"
run sysroot "$here/sysroot.sh" "$arch" "$made/sysroot"
run libraries "$here/libraries.sh" "$arch" "$made/sysroot" "$sources" "$made/prefix"
# Threads come from the standard library, and halflit view, which loads SDL2, is left out: a static program cannot load libraries.
run configuration cmake -S "$root" -B "$made/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" \
    -DHALFLIT_ARCH="$arch" -DHALFLIT_SYSROOT="$made/sysroot" -DHALFLIT_PREFIX="$made/prefix" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DHALFLIT_ONETBB=OFF -DHALFLIT_VIEWER=OFF -DHALFLIT_BUILD_TESTS=OFF -DHALFLIT_INSTALL=OFF
run program cmake --build "$made/build" --target halflit halflit_python

# notice FILE: a copyright notice of Debian's, with the licences that it cites.
notice() {
    local cited
    cat "$1"
    for cited in $(grep -oE '/usr/share/common-licenses/[A-Za-z0-9.-]*[A-Za-z0-9]' "$1" | sort -u); do
        printf '\n\n======== %s ========\n\n' "$cited"
        cat "$cited"
    done
}
version=$(sed -n 's/^project(halflit VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
package=halflit-$version-linux-${triplet%%-*}
rm -rf "${made:?}/$package"
mkdir -p "$made/$package/licences"
for name in "${linked[@]}"; do notice "$(compgen -G "$sources/$name-[0-9]*/debian/copyright")" >"$made/$package/licences/$name.txt"; done
for name in "${compiled_in[@]}"; do notice "/usr/share/doc/$name/copyright" >"$made/$package/licences/$name.txt"; done
notice "$made/sysroot/usr/share/doc/libc6/copyright" >"$made/$package/licences/glibc.txt"
cat >"$made/$package/licences/README" <<'TEXT'
Licences of the libraries that halflit brings. This software is based in part on the work of the Independent JPEG Group.
The GNU C library is under the LGPL: halflit's source and `./dev package --portable` link the program with another version of it.
TEXT
"$root/apps/python/build_wheel.py" "$made/build/python/libhalflit_python.so" "$output" "$made/$package/licences"

cp "$root/LICENSE" "$root/docs/SKILL.md" "$made/$package/"
cp "$root/apps/halflit/fonts/LICENSE" "$made/$package/licences/dejavu-fonts.txt"
"$triplet-strip" -o "$made/$package/halflit" "$made/build/bin/halflit"
tar -C "$made" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -c "$package" | gzip -9n >"$output/$package.tar.gz"
ls -l "$output/$package.tar.gz"
