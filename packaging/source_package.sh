#!/usr/bin/env bash
# Makes Debian's source package of the last commit: the source and packaging/debian as its folder debian.
#   source_package.sh FOLDER [SOURCE_TARBALL]      then: cd FOLDER/halflit-VERSION && dpkg-buildpackage
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
root=$(dirname "$here")
mkdir -p "$1"
folder=$(realpath "$1")
version=$("$here/versions.py" "$root")
tree=$folder/halflit-$version
rm -rf "$tree"
if [ $# -gt 1 ]; then
    cp "$2" "$folder/halflit_$version.orig.tar.gz"
else
    git -C "$root" archive --format=tar --prefix="halflit-$version/" HEAD | gzip -9n >"$folder/halflit_$version.orig.tar.gz"
fi
tar -C "$folder" -xf "$folder/halflit_$version.orig.tar.gz"
cp -r "$tree/packaging/debian" "$tree/debian"
(cd "$folder" && dpkg-source -b "halflit-$version")
