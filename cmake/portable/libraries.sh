#!/usr/bin/env bash
# Builds the libraries of cmake/dependencies.cmake that are not headers alone, statically and without what is not used, from Debian's
# sources: libraries.sh SOURCES PREFIX CMAKE_FLAGS... SOURCES and PREFIX are folders; the flags name the toolchain and its settings.
set -euo pipefail

here=$(dirname "$(readlink -f "$0")")
sources=$1 prefix=$2
toolchain=("${@:3}")
work=$prefix/build

# library NAME FOLDER [CMAKE_FLAGS...]: configures, builds and installs the project in FOLDER, unless that is done.
library() {
    local name=$1 folder=$2
    shift 2
    [ ! -e "$work/$name.done" ] || return 0
    echo "portable: $name" >&2
    { cmake -S "$folder" -B "$work/$name" -G Ninja "${toolchain[@]}" -DHALFLIT_PREFIX="$prefix" \
        -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR:PATH=lib \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_{C,CXX}_FLAGS_RELEASE="-O2 -DNDEBUG" -DCMAKE_{C,CXX}_COMPILER_LAUNCHER=ccache \
        -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "$@" && cmake --build "$work/$name" --target install; } >"$work/$name.log" 2>&1 || {
        tail -n 40 "$work/$name.log" >&2
        echo "portable: $name was not built" >&2
        exit 1
    }
    touch "$work/$name.done"
}

source_of() { compgen -G "$sources/$1-[0-9]*"; }

mkdir -p "$work"
library plain "$here" -DHALFLIT_SOURCES="$sources"
library fmt "$(source_of fmtlib)" -DFMT_TEST=OFF -DFMT_DOC=OFF
library jpeg "$(source_of libjpeg-turbo)" -DENABLE_SHARED=OFF -DWITH_TURBOJPEG=OFF -DREQUIRE_SIMD=ON
library meshoptimizer "$(source_of meshoptimizer)" -DMESHOPT_BUILD_DEMO=OFF
library webp "$(source_of libwebp)" -DWEBP_BUILD_{ANIM_UTILS,CWEBP,DWEBP,GIF2WEBP,IMG2WEBP,VWEBP,WEBPINFO,WEBPMUX,EXTRAS}=OFF \
    -DWEBP_BUILD_LIBWEBPMUX=ON
library imath "$(source_of imath)" -DIMATH_INSTALL_PKG_CONFIG=ON
library openexr "$(source_of openexr)" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_INSTALL_TOOLS=OFF \
    -DOPENEXR_INSTALL_PKG_CONFIG=ON
# IlmThread needs Iex: its file for pkg-config has them in the other order, which static libraries do not allow.
sed -i 's/\(-lIex[^ ]*\) \(-lIlmThread[^ ]*\)/\2 \1/' "$prefix/lib/pkgconfig/OpenEXR.pc"
