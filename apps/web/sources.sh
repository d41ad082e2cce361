#!/usr/bin/env bash
# Unpacks Debian's sources of PACKAGES: sources.sh FOLDER [PACKAGES...]. Without PACKAGES: those that apps/web/libraries.cmake compiles.
# Packages whose source is there stay as they are. It asks the archives that this machine's apt knows, with a list of its own, so the
# system's settings do not change.
set -euo pipefail

folder=$1
packages=("${@:2}")
[ ${#packages[@]} -gt 0 ] || packages=(libjpeg-turbo libdeflate expat draco meshoptimizer libwebp)
missing=()
for package in "${packages[@]}"; do
    compgen -G "$folder/$package-[0-9]*/" >/dev/null || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

mkdir -p "$folder"
folder=$(realpath "$folder")
work=$(mktemp -d "$folder/.sources.XXXXXX")  # here, so that an unpacked source is moved in one step
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/parts" "$work/lists/partial" "$work/cache"
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -f "$list" ] || sed -n 's/^deb /deb-src /p' "$list" >"$work/parts/$(basename "$list" .list).list"
done
for list in /etc/apt/sources.list.d/*.sources; do
    [ ! -f "$list" ] || sed 's/^Types:.*/Types: deb-src/' "$list" >"$work/parts/$(basename "$list")"
done
apt() {
    apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/parts" -o Dir::State::Lists="$work/lists" \
        -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" "$@"
}
apt update || true  # an archive without sources is no harm
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-stable}")
mkdir "$work/unpacked"
cd "$work/unpacked"
for package in "${missing[@]}"; do
    # A mirror may lack the newest security update; then the release's own version.
    apt --download-only source "$package" 2>/dev/null || apt --download-only source "$package/$codename"
    description=$(ls -t "$package"_*.dsc | head -n 1)
    dpkg-source --no-check -x "$description" >/dev/null
    mv "$package"-[0-9]*/ "$folder"
done
