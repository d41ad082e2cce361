#!/usr/bin/env bash
# Makes halflit-VERSION.tgz of a build with the target halflit_npm: make_tarball.sh SOURCE BUILD LIBRARIES FOLDER. Prints its path.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$1/apps/npm/pack.mjs" "$1" "$2/bin" "$3" "$work/package"
mkdir -p "$4"
folder=$(realpath "$4")
cd "$work/package"
name=$(npm pack --silent --pack-destination "$folder")
echo "$folder/$name"
