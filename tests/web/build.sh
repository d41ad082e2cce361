#!/usr/bin/env bash
# Builds the page and the golden tests with Emscripten: build.sh SOURCE BUILD. Exit code 77: there is no Emscripten.
set -euo pipefail
for tool in em++ node; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: there is no $tool"
        exit 77
    fi
done
cmake --preset web -S "$1" -B "$2" -DHALFLIT_BUILD_TESTS=ON
cmake --build "$2" --target halflit_playground halflit_golden_tests
