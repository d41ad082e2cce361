#!/usr/bin/env bash
# Makes the files of a release (`./dev release`): packages, source, hashes of pixels, notes, and checksums of all of them.
#   release.sh [--source-only] [--dirty] FOLDER     FOLDER: new, or one that an earlier run made
# HALFLIT_SIGNING_KEY, if set, is a file with a key of ssh-keygen: SHA256SUMS.sig is its signature of SHA256SUMS (namespace: file).
# HALFLIT_HOMEPAGE is the address of the project in the recipes; by default a placeholder.
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
root=$(dirname "$here")
source_only='' dirty=''
while [[ ${1:-} = --* ]]; do
    case $1 in
    --source-only) source_only=1 ;;
    --dirty) dirty=1 ;;
    *)
        echo "release: unknown flag $1" >&2
        exit 2
        ;;
    esac
    shift
done
[ $# -eq 1 ] || {
    echo "usage: release.sh [--source-only] [--dirty] FOLDER" >&2
    exit 2
}

fail() {
    echo "release: $*" >&2
    exit 1
}

# step NAME COMMAND...: says how long it took.
step() {
    local start=$SECONDS name=$1
    shift
    "$@"
    echo "release: $name: $((SECONDS - start)) s" >&2
}

version=$("$here/versions.py" "$root") || fail "the versions disagree; see above"
[ -n "$dirty" ] || git -C "$root" diff --quiet HEAD -- || fail "there are changes that are not committed (--dirty releases the last commit)"
mkdir -p "$1"
released=$(realpath "$1")
# The files come into FOLDER at the end, all of them or none.
work=$(mktemp -d) start=$work/start folder=$work/files
touch "$start"
mkdir "$folder"
trap 'rm -rf "$work" || true' EXIT

# The files of an earlier run are replaced. Other files are an error.
earlier=()
if [ -e "$released/SHA256SUMS" ]; then readarray -t earlier < <(cut -c67- "$released/SHA256SUMS" && printf '%s\n' SHA256SUMS SHA256SUMS.sig); fi
others=$(LC_ALL=C comm -23 <(find "$released" -mindepth 1 -printf '%P\n' | LC_ALL=C sort) <(printf '%s\n' "${earlier[@]}" | LC_ALL=C sort))
[ -z "$others" ] || fail "$released: expected an empty folder, found other files"

make_source() {
    git -C "$root" archive --format=tar --prefix="halflit-$version/" HEAD | gzip -9n >"$folder/halflit-$version.tar.gz"
}

# works COMMAND...: fails where the packaged program does not draw what the hashes say.
works() {
    "$@" --self-test >&2 || fail "$*: a packaged program fails its self-test"
}

# unpacked SYSTEM-PROCESSOR: the folder of a package of it.
unpacked() {
    local package=halflit-$version-$1 archives=$root/build/packages
    if [ ! -d "$work/$package" ]; then
        if [ -e "$archives/$package.zip" ]; then
            python3 -m zipfile -e "$archives/$package.zip" "$work" || fail "$package.zip cannot be unpacked"
        else
            tar -C "$work" -xf "$archives/$package.tar.gz" || fail "$package.tar.gz cannot be unpacked"
        fi
    fi
    echo "$work/$package"
}

make_image() {
    local program
    program=$(unpacked "linux-$(uname -m)")/halflit
    "$here/image/oci.sh" "$program" "$work/image" "$version" >&2 || fail "the image could not be made"
    tar -C "$work/image" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -cf "$folder/halflit-$version-image-$(uname -m).tar" .
}

make_debian_source() {
    "$here/source_package.sh" "$work/debian" "$folder/halflit-$version.tar.gz" >&2
    find "$work/debian" -maxdepth 1 -type f -exec cp -t "$folder" {} +
}

# All packages of ./dev package, but for the wheel of this system: a portable one is for it, too.
make_packages() {
    local arch
    step package "$root/dev" package >&2
    for arch in amd64 arm64; do step "portable, $arch" "$root/dev" package --portable "$arch" >&2; done
    step windows "$root/dev" package --windows >&2
    if command -v npm >/dev/null; then
        step npm "$root/dev" package --npm >&2
    else
        echo "release: no npm: the package for npm is left out" >&2
    fi
    step image make_image
    step "Debian's source package" make_debian_source
    # Not the archive of this system's program, which halflit-VERSION-linux-PROCESSOR.tar.gz is for too.
    find "$root/build/packages" -maxdepth 1 -type f -newer "$start" -name "*halflit*" ! -name "halflit-$version-$(uname -m).tar.gz" \
        -exec cp -t "$folder" {} +
    works "$root/build/install/bin/halflit"
    local unpacked_here
    unpacked_here=$(unpacked "linux-$(uname -m)")
    works "$unpacked_here/halflit"
    "$here/sbom.py" "$unpacked_here/halflit" "$(TZ=UTC git -C "$root" log -1 --date=format-local:%Y-%m-%dT%H:%M:%SZ --format=%cd)" \
        >"$folder/halflit-$version-linux-$(uname -m).spdx.json"
    if [ "$(uname -m)" = x86_64 ]; then
        unpacked_here=$(unpacked linux-aarch64)
        works qemu-aarch64 "$unpacked_here/halflit"
        unpacked_here=$(unpacked windows-x86_64)
        export PATH=$PATH:/usr/lib/wine WINEDEBUG=-all WINEPREFIX=$work/wine
        works wine64 "$unpacked_here/halflit.exe"
        wineserver -k && wineserver -w || true  # its services outlive the program, and write into their folder
    fi
}

step source make_source
[ -n "$source_only" ] || make_packages
"$here/hashes.py" "$root" >"$folder/hashes.txt"
awk -v version="$version" '/^## / { inside = ($2 == version) } inside' "$root/CHANGELOG.md" >"$folder/notes.md"
[ -s "$folder/notes.md" ] || fail "CHANGELOG.md has no section of $version"
"$here/recipes.sh" "$version" "$folder/halflit-$version.tar.gz" "$folder/recipes"
tar -C "$folder" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -c recipes | gzip -9n >"$folder/halflit-$version-recipes.tar.gz"
rm -r "$folder/recipes"
(cd "$folder" && find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' sha256sum >SHA256SUMS)
[ -z "${HALFLIT_SIGNING_KEY:-}" ] || ssh-keygen -q -Y sign -f "$HALFLIT_SIGNING_KEY" -n file "$folder/SHA256SUMS"
(cd "$released" && rm -f -- "${earlier[@]}")
mv "$folder"/* "$released"
(cd "$released" && ls -l && sha256sum --quiet -c SHA256SUMS)
