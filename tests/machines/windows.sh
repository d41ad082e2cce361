#!/usr/bin/env bash
# Builds the program, its libraries and tests for Windows by mingw-w64 and runs them under wine, in a chroot of Debian 12
# (`./dev test --windows`).
#   windows.sh FILTER     FILTER: the tests of shading that depend on the machine
set -euo pipefail
filter=$1
portable=/halflit/cmake/portable
apt-get update -qq
apt-get install -y -qq --no-install-recommends cmake ninja-build ccache pkg-config g++ nasm dpkg-dev libxsimd-dev libexpected-dev \
    nlohmann-json3-dev libstb-dev libcli11-dev libtinygltf-dev catch2 g++-mingw-w64-x86-64-posix wine64 >/dev/null
export WINEDEBUG=-all WINEPREFIX=/build/wine LC_ALL=C.UTF-8  # else files have ASCII names alone
# One server for all programs: tests start hundreds, and wine's services take seconds to start. These keep the standard streams of the
# program that started them, for whose end CMake would wait: so they are started here, without any.
mkdir -p $WINEPREFIX
/usr/lib/wine/wineserver -p </dev/null >/dev/null 2>&1
/usr/lib/wine/wine64 wineboot --init </dev/null >/dev/null 2>&1
trap '/usr/lib/wine/wineserver -k || true' EXIT
# run STEP COMMAND...: quiet unless it fails.
run() {
    echo "machines: windows: building ($1)"
    "${@:2}" >/build/windows.log 2>&1 || { cat /build/windows.log >&2; exit 1; }
}
readarray -t linked <$portable/linked.txt
toolchain=-DCMAKE_TOOLCHAIN_FILE=/halflit/cmake/windows.cmake
run sources /halflit/apps/web/sources.sh /build/sources "${linked[@]}"
run libraries $portable/libraries.sh /build/sources /build/windows-libraries $toolchain
run configuration cmake -S /halflit -B /build/windows -G Ninja -DCMAKE_BUILD_TYPE=Release $toolchain -DHALFLIT_PREFIX=/build/windows-libraries \
    -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DHALFLIT_VIEWER=OFF -DHALFLIT_INSTALL=OFF -DHALFLIT_WARNINGS_AS_ERRORS=ON
run tests cmake --build /build/windows --target halflit_golden_tests halflit_{shading,sh,raster,io,cli}_tests halflit_c_{api,dll}_test
bin=/build/windows/bin
wine=/usr/lib/wine/wine64
echo "machines: windows: golden hashes"
ctest --test-dir /build/windows -L golden --output-on-failure
echo "machines: windows: operations and kernels"
$wine "$bin/halflit_shading_tests.exe" "$filter"
echo "machines: windows: mathematics"
$wine "$bin/halflit_sh_tests.exe" '~[slow]~[deep]'
echo "machines: windows: frames"
$wine "$bin/halflit_raster_tests.exe" '~[slow]~[deep]'
echo "machines: windows: readers and writers of files"
$wine "$bin/halflit_io_tests.exe" '~[slow]~[deep]'
echo "machines: windows: the C interface, by the static library and by halflit.dll"
$wine "$bin/halflit_c_api_test.exe"
$wine "$bin/halflit_c_dll_test.exe"
echo "machines: windows: the program"
$wine "$bin/halflit.exe" --self-test
$wine "$bin/halflit_cli_tests.exe" '~[slow]~[deep]'
echo "machines: windows: passed"
