#!/usr/bin/env bash
# Builds the tests for another processor and runs them under qemu, in a chroot of Debian 12 (`./dev test --arch ARCH`).
#   cross.sh ARCH FILTER     FILTER: the tests of shading that depend on the machine
set -euo pipefail
arch=$1 filter=$2 io=ON
read -r triplet qemu < <(sed -n "s/^ *\"$arch  *\([^ ]*\)  *[^ ]*  *\([a-z0-9]*\).*/\1 \2/p" /halflit/cmake/cross.cmake) || {
    echo "cross.sh: expected an architecture of cmake/cross.cmake, found '$arch'" >&2
    exit 2
}
[ "$arch" != riscv64 ] || io=OFF  # Debian 12 has no libraries for it
libraries=()
if [ $io = ON ]; then
    dpkg --add-architecture "$arch"
    for package in $(sed -n 's/^    "[^ ]* *io *[^ ]* *[^ ]* *\([^ ]*\) .*/\1/p' /halflit/cmake/dependencies.cmake); do
        case $package in
        libstb-dev) ;;  # headers alone
        *) libraries+=("$package:$arch") ;;
        esac
    done
fi
apt-get update -qq
apt-get install -y -qq --no-install-recommends cmake ninja-build ccache pkg-config libxsimd-dev libexpected-dev nlohmann-json3-dev libstb-dev \
    libcli11-dev libtinygltf-dev catch2 qemu-user g++ "g++-$triplet" "${libraries[@]}" >/dev/null
emulator=(qemu-$qemu)
[ $io = ON ] || emulator+=(-L /usr/$triplet)
cmake -S /halflit -B "/build/$arch" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE=/halflit/cmake/cross.cmake \
    -DHALFLIT_ARCH="$arch" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DHALFLIT_BUILD_IO=$io -DHALFLIT_BUILD_APPS=OFF \
    -DHALFLIT_BUILD_C=OFF -DHALFLIT_WARNINGS_AS_ERRORS=ON >"/build/$arch.log" 2>&1 || { cat "/build/$arch.log" >&2; exit 1; }
targets=(halflit_golden_tests halflit_shading_tests halflit_sh_tests)
[ $io = OFF ] || targets+=(halflit_io_tests)
cmake --build "/build/$arch" --target "${targets[@]}" >"/build/$arch.log" 2>&1 || { cat "/build/$arch.log" >&2; exit 1; }
bin=/build/$arch/bin
echo "machines: $arch: golden hashes"
ctest --test-dir "/build/$arch" -L golden --output-on-failure -j "$(nproc)"
echo "machines: $arch: operations and kernels"
"${emulator[@]}" "$bin/halflit_shading_tests" "$filter"
echo "machines: $arch: mathematics"
"${emulator[@]}" "$bin/halflit_sh_tests" '~[slow]~[deep]'
if [ $io = ON ]; then
    echo "machines: $arch: readers of files"
    "${emulator[@]}" "$bin/halflit_io_tests" '~[slow]~[deep]'
fi
echo "machines: $arch: passed"
