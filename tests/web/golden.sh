#!/usr/bin/env bash
# The golden tests under Node.js: golden.sh BUILD. Exit code 77: they were not built.
set -euo pipefail
if [ ! -f "$1/bin/halflit_golden_tests.js" ]; then
    echo "skipped: there is no Emscripten"
    exit 77
fi
exec node --no-experimental-fetch "$1/bin/halflit_golden_tests.js"
