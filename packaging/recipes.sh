#!/usr/bin/env bash
# Fills the recipes of package managers: version, checksum of the source, address of the project.
#   recipes.sh VERSION SOURCE_TARBALL FOLDER
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
version=$1 tarball=$2 folder=$3
homepage=${HALFLIT_HOMEPAGE:-https://halflit.invalid}
sha256=$(sha256sum "$tarball" | cut -c-64)
sha512=$(sha512sum "$tarball" | cut -c-128)
(cd "$here/recipes" && find . -type f) | while read -r file; do
    mkdir -p "$folder/$(dirname "$file")"
    sed -e "s|@VERSION@|$version|g; s|@HOMEPAGE@|$homepage|g; s|@SHA256@|$sha256|g; s|@SHA512@|$sha512|g" \
        "$here/recipes/$file" >"$folder/${file%.in}"
done
