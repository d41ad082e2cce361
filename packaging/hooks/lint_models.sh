#!/usr/bin/env bash
# Reads each model strictly, and prints one line for each that is refused. Exit code 1 if there is one.
#   lint_models.sh MODEL...        HALFLIT_PROGRAM: the program, by default halflit
set -u
failed=0
for model in "$@"; do
    [[ $model != -* ]] || model=./$model
    if ! message=$("${HALFLIT_PROGRAM:-halflit}" info --strict --quiet "$model" 2>&1 >/dev/null); then
        printf '%s\n' "$message" >&2
        failed=1
    fi
done
exit $failed
