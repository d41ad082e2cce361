#!/usr/bin/env bash
# Builds the tests for Windows by mingw-w64 and runs them under wine, in a chroot of Debian 12 (`./dev test --windows`).
#   windows.sh FILTER     FILTER: the tests of shading that depend on the machine
set -euo pipefail
filter=$1
apt-get update -qq
apt-get install -y -qq --no-install-recommends cmake ninja-build ccache pkg-config libxsimd-dev libexpected-dev catch2 \
    g++-mingw-w64-x86-64-posix wine wine64 >/dev/null
export WINEDEBUG=-all WINEPREFIX=/build/wine
cmake -S /halflit -B /build/windows -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE=/halflit/cmake/windows.cmake \
    -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DHALFLIT_ONETBB=OFF -DHALFLIT_BUILD_IO=OFF -DHALFLIT_WARNINGS_AS_ERRORS=ON \
    >/build/windows.log 2>&1 || { cat /build/windows.log >&2; exit 1; }
cmake --build /build/windows --target halflit_golden_tests halflit_shading_tests halflit_sh_tests halflit_raster_tests halflit_c_api_test \
    >/build/windows.log 2>&1 || { cat /build/windows.log >&2; exit 1; }
bin=/build/windows/bin
echo "machines: windows: golden hashes"
ctest --test-dir /build/windows -L golden --output-on-failure
echo "machines: windows: operations and kernels"
wine "$bin/halflit_shading_tests.exe" "$filter"
echo "machines: windows: mathematics"
wine "$bin/halflit_sh_tests.exe" '~[slow]~[deep]'
echo "machines: windows: frames"
wine "$bin/halflit_raster_tests.exe" '~[slow]~[deep]'
echo "machines: windows: the C interface"
wine "$bin/halflit_c_api_test.exe"
echo "machines: windows: passed"
