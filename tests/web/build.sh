#!/usr/bin/env bash
# Builds the page, the golden tests and the npm package with Emscripten: build.sh SOURCE BUILD. Exit code 77: there is no Emscripten.
# Without the sources of the libraries (apps/web/sources.sh) there is neither page nor package.
set -euo pipefail
for tool in em++ node; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: there is no $tool"
        exit 77
    fi
done
targets=(halflit_golden_tests)
libraries=
if "$1/apps/web/sources.sh" "$1/build/web-sources"; then
    libraries=$1/build/web-sources
    targets+=(halflit_playground halflit_npm)
fi
cmake --preset web -S "$1" -B "$2" -DHALFLIT_BUILD_TESTS=ON -DHALFLIT_WEB_LIBRARIES="$libraries"
cmake --build "$2" --target "${targets[@]}"
