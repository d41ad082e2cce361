# Sourced: runs a recipe of docs/farm.md with a program that every third task kills once, and compares with one process.
# Sets halflit (the program), work (a folder that is removed at the end), pids (what is stopped then).
set -euo pipefail
halflit=$(readlink -f "$1")
recipes=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../docs/farm.md
work=$(mktemp -d)
chmod 755 "$work"
pids=()
stop() {
    [ ${#pids[@]} -eq 0 ] || kill "${pids[@]}" 2>/dev/null || true
    wait 2>/dev/null || true
    rm -rf "$work"
}
trap stop EXIT

# need PROGRAM...: else the test is skipped
need() {
    local program
    for program in "$@"; do
        PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || { echo "skipped: no $program"; exit 77; }
    done
}

# The recipe's halflit. The first time, every third task ends in the middle of drawing, as on a machine that is taken away.
# REQUEUE: how its scheduler learns of it.
make_program() {
    mkdir "$work"/{bin,killed}
    cat >"$work/bin/halflit" <<TEXT
#!/bin/bash
task=\${SLURM_ARRAY_TASK_ID:-\${PARALLEL_SEQ:-1}}
if [ "\$1" = render ] && [ \$((task % 3)) -eq 0 ] && mkdir "$work/killed/\$task" 2>/dev/null; then
    "$halflit" "\$@" &
    sleep 0.0\$((task % 7))
    kill -KILL \$!
    ${REQUEUE:-exit 137}
fi
exec "$halflit" "\$@"
TEXT
    chmod 755 "$work/bin/halflit"
    PATH=$work/bin:$PATH:/usr/sbin
}

# run_recipe HEADING: the shell commands below a heading of docs/farm.md, and their film against that of one process
run_recipe() {
    local begin end render
    awk -v heading="## $1" '$0 == heading { on = 1; next } /^## / { on = 0 } on && /^```/ { block = !block; next } on && block' \
        "$recipes" >"$work/recipe"
    [ -s "$work/recipe" ] || { echo "docs/farm.md has no recipe for $1"; exit 1; }
    cd "$work"
    begin=$(date +%s.%N)
    bash -e recipe
    end=$(date +%s.%N)
    render=$(sed -n 's/.*halflit \(render .*\) --shard auto.*/\1/p' recipe)
    mkdir one
    (cd one && eval "$halflit $render")
    diff <(hashes one/turn.json) <(hashes turn.*-of-*.json) || { tail -n 5 ./*.log out.* 2>/dev/null; exit 1; }
    diff -r one/turn turn
    [ -s turn.apng ]
    echo "$(wc -l <one/turn.json) tasks, $(find killed -mindepth 1 | wc -l) killed once, $(awk "BEGIN { printf \"%.1f\", $end - $begin }") s:" \
        "files and hashes are those of one process"
}

hashes() { sed 's/.*"frame":\([0-9]*\),.*"pixel_hash":"\([0-9a-f]*\)".*/\1 \2/' "$@" | sort -n; }
