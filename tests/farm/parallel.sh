#!/usr/bin/env bash
# docs/farm.md's recipe with GNU parallel. usage: parallel.sh HALFLIT
source "$(dirname "$0")/recipe.sh"
need parallel
make_program
export HOME=$work  # where parallel keeps what it knows of the machine
run_recipe "GNU parallel"
