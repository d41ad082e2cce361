#!/usr/bin/env bash
# Makes packages that run on old and new systems (`./dev package --portable`, `--windows`): a program without shared libraries, and a wheel.
# For Windows the C interface too, as halflit.dll.
#   package.sh ARCH ROOT FOLDER [wheel]     ARCH: amd64, arm64 or windows; ROOT: the project; FOLDER: where the packages go; wheel: it alone
# Intermediate files are kept in ROOT/build/portable.
set -euo pipefail

arch=$1 root=$(realpath "$2") only=${4:-}
mkdir -p "$3"
output=$(realpath "$3")
here=$root/cmake/portable
made=$root/build/portable/$arch sources=$root/build/portable/sources
# Debian's sources of what is linked, and Debian's packages of what is compiled in: headers, and the compiler's own libraries.
readarray -t linked <"$here/linked.txt"
compiled_in=(libxsimd-dev libexpected-dev libcli11-dev nlohmann-json3-dev libstb-dev)

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

system=linux
case $arch in
amd64) triplet=x86_64-linux-gnu ;;
arm64) triplet=aarch64-linux-gnu ;;
windows) system=windows triplet=x86_64-w64-mingw32 ;;
*)
    echo "package.sh: expected amd64, arm64 or windows, found '$arch'" >&2
    exit 2
    ;;
esac
mkdir -p "$made"
run sources "$root/apps/web/sources.sh" "$sources" "${linked[@]}"
if [ $system = windows ]; then
    compiled_in+=(gcc-mingw-w64-base mingw-w64-common)  # the compiler's own libraries, and those of Windows's C library
    toolchain=(-DCMAKE_TOOLCHAIN_FILE="$root/cmake/windows.cmake")
    export WINEDEBUG=-all WINEPREFIX="$made/wine"
else
    compiled_in+=(gcc-12-base)
    run sysroot "$here/sysroot.sh" "$arch" "$made/sysroot"
    # A new C library: everything is linked with it.
    if [ "$made/sysroot/.whole" -nt "$made/build/CMakeCache.txt" ]; then rm -rf "$made/build" "$made/prefix"; fi
    toolchain=(-DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" -DHALFLIT_ARCH="$arch" -DHALFLIT_SYSROOT="$made/sysroot")
fi
run libraries "$here/libraries.sh" "$sources" "$made/prefix" "${toolchain[@]}"
# halflit view, which loads SDL2, is left out: a static program cannot load libraries.
run configuration cmake -S "$root" -B "$made/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "${toolchain[@]}" \
    -DHALFLIT_PREFIX="$made/prefix" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DHALFLIT_VIEWER=OFF -DHALFLIT_BUILD_TESTS=OFF -DHALFLIT_INSTALL=OFF
targets=(halflit_python)
if [ "$only" != wheel ]; then targets+=(halflit); fi
run program cmake --build "$made/build" --target "${targets[@]}"

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
package=halflit-$version-$system-${triplet%%-*}
rm -rf "${made:?}/$package"
mkdir -p "$made/$package/licences"
for name in "${linked[@]}"; do notice "$(compgen -G "$sources/$name-[0-9]*/debian/copyright")" >"$made/$package/licences/$name.txt"; done
for name in "${compiled_in[@]}"; do notice "/usr/share/doc/$name/copyright" >"$made/$package/licences/$name.txt"; done
echo "Licences of the libraries that halflit brings. This software is based in part on the work of the Independent JPEG Group." \
    >"$made/$package/licences/README"
library=$made/build/python/libhalflit_python.so
if [ $system = windows ]; then
    library=$made/build/bin/halflit.dll
else
    notice "$made/sysroot/usr/share/doc/libc6/copyright" >"$made/$package/licences/glibc.txt"
    echo "The GNU C library is under the LGPL: halflit's source and \`./dev package --portable\` link the program with another version of it." \
        >>"$made/$package/licences/README"
fi
"$root/apps/python/build_wheel.py" "$library" "$output" "$made/$package/licences"
if [ "$only" = wheel ]; then exit 0; fi

cp "$root/LICENSE" "$root/docs/SKILL.md" "$made/$package/"
cp "$root/apps/engine/fonts/LICENSE" "$made/$package/licences/dejavu-fonts.txt"
if [ $system = windows ]; then
    # The program beside the library for C, its header, and what linkers take: an import library, and the list of names for others.
    mkdir -p "$made/$package/include/halflit" "$made/$package/lib"
    for name in halflit.exe halflit.dll; do "$triplet-strip" -o "$made/$package/$name" "$made/build/bin/$name"; done
    cp "$root/apps/c/include/halflit/halflit.h" "$made/$package/include/halflit/"
    cp "$made/build/python/libhalflit.dll.a" "$made/build/generated/halflit.def" "$made/$package/lib/"
    python3 "$here/zip.py" "$made/$package" "$output/$package.zip"
    ls -l "$output/$package.zip"
    exit 0
fi
"$triplet-strip" -o "$made/$package/halflit" "$made/build/bin/halflit"
tar -C "$made" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -c "$package" | gzip -9n >"$output/$package.tar.gz"
ls -l "$output/$package.tar.gz"
