#!/usr/bin/env bash
# The step of the action: golden lists, and models that changed since a commit. Runs in the repository that has them. From the environment:
#   HALFLIT_PROGRAM          the program
#   HALFLIT_GOLDEN           folders with golden.json, divided by blanks
#   HALFLIT_BASE             commit whose models are the first versions; empty: none are compared
#   HALFLIT_COMPARE_FLAGS    flags of halflit compare, divided by blanks
#   HALFLIT_FAIL_ON_CHANGE   true: a model that changed fails the step
#   HALFLIT_REPORT           folder for pages and pictures, and for comment.md
# Writes the comment to GITHUB_STEP_SUMMARY too, and "passed" and "comment" to GITHUB_OUTPUT, where they are set. The summary cannot show
# pictures: they are in the folder's pages. Exit code 1 if something differs.
set -euo pipefail

program=${HALFLIT_PROGRAM:-halflit} report=${HALFLIT_REPORT:?}
read -ra golden <<<"${HALFLIT_GOLDEN:-}"
read -ra flags <<<"${HALFLIT_COMPARE_FLAGS:-}"
mkdir -p "$report"
comment=$report/comment.md
: >"$comment"
passed=true
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# fenced FILE: the file's text as it is, whatever backquotes it has.
fenced() { printf '~~~~~~text\n%s\n~~~~~~\n\n' "$(sed 's/^~~~~~~/ &/' "$1")" >>"$comment"; }

# named NAME: a file's name as code, in which no mark of Markdown, HTML or a mention counts.
named() {
    local text=${1//[[:cntrl:]]/?}
    printf '`%s`' "${text//\`/\'}"
}

check_golden() {
    local folder=$1 code=0
    "$program" golden check -o "$report/golden/$folder" -- "$folder" >"$work/out" 2>"$work/err" || code=$?
    if [ "$code" -eq 0 ]; then
        printf '**%s**: every picture is as expected.\n\n' "$(named "$folder")" >>"$comment"
        return
    fi
    passed=false
    printf '**%s**: pictures differ (exit code %d). golden/%s/index.html shows them.\n\n' "$(named "$folder")" "$code" "$(named "$folder")" >>"$comment"
    [ "$code" -eq 1 ] || cat "$work/err" >>"$work/out"
    fenced "$work/out"
    cat "$work/err" >&2
}

compare_model() {
    local model=$1 code=0 before
    before=$work/before/$model
    mkdir -p -- "$(dirname -- "$before")"
    git show "$HALFLIT_BASE:./$model" >"$before"
    # The old version's other files are not beside it: what has not changed is taken from today's folder.
    "$program" compare --allow-external "$(dirname -- "$model")" -o "$report/models/$model" --markdown "$work/comment.md" \
        "${flags[@]}" -- "$before" "$model" >"$work/out" 2>"$work/err" || code=$?
    printf '**%s**\n\n' "$(named "$model")" >>"$comment"
    if [ "$code" -le 1 ]; then
        grep -v '^!\[' "$work/comment.md" >>"$comment" || true
        printf '\nmodels/%s/index.html has the pictures.\n\n' "$(named "$model")" >>"$comment"
        rm -f "$work/comment.md"
        if [ "$code" -eq 1 ] && [ "${HALFLIT_FAIL_ON_CHANGE:-}" = true ]; then passed=false; fi
    else
        passed=false
        fenced "$work/err"
        cat "$work/err" >&2
    fi
}

for folder in "${golden[@]}"; do check_golden "$folder"; done
if [ -n "${HALFLIT_BASE:-}" ]; then
    git rev-parse --quiet --verify "$HALFLIT_BASE^{commit}" >/dev/null || {
        echo "check.sh: $HALFLIT_BASE: no such commit here: it must be fetched (fetch-depth: 0)" >&2
        exit 2
    }
    git diff --name-only -z --relative --diff-filter=M "$HALFLIT_BASE" HEAD -- \
        '*.glb' '*.gltf' '*.stl' '*.ply' '*.obj' '*.3mf' '*.off' >"$work/changed"
    while IFS= read -r -d '' model; do compare_model "$model"; done <"$work/changed"
fi
[ -s "$comment" ] || printf 'No golden list, and no model that changed.\n' >>"$comment"

cat "$comment"
[ -z "${GITHUB_STEP_SUMMARY:-}" ] || cat "$comment" >>"$GITHUB_STEP_SUMMARY"
[ -z "${GITHUB_OUTPUT:-}" ] || printf 'passed=%s\ncomment=%s\n' "$passed" "$comment" >>"$GITHUB_OUTPUT"
[ "$passed" = true ]
