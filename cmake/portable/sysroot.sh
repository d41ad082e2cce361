#!/usr/bin/env bash
# Makes a folder with an old C library to link with: sysroot.sh ARCH FOLDER. It holds headers and libraries of Debian 11's glibc 2.31
# for ARCH (Debian's name). The packages come from the archive of this machine's apt, with a list of its own, so the system's settings do
# not change. The compiler for ARCH must be there.
set -euo pipefail

here=$(dirname "$(readlink -f "$0")")
arch=$1 folder=$2
suite=bullseye
if [ -e "$folder/.whole" ] && [ -z "$(find "$here/sysroot.sh" "$here"/*.c -newer "$folder/.whole")" ]; then exit 0; fi
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1)
[ -n "$mirror" ] || {
    echo "sysroot.sh: an old C library needs an archive of Debian: apt here has none (apt-get update)" >&2
    exit 1
}
rm -rf "$folder"
mkdir -p "$folder"
folder=$(realpath "$folder")
work=$(mktemp -d "$folder/.packages.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/parts" "$work/lists/partial" "$work/cache"
echo "deb [arch=$arch signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$work/parts/$suite.list"
touch "$work/status"
apt() {
    apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/parts" -o Dir::State::Lists="$work/lists" \
        -o Dir::State::Status="$work/status" -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" \
        -o APT::Architecture="$arch" -o APT::Architectures::="$arch" "$@"
}
apt update
(cd "$work" && apt download libc6 libc6-dev linux-libc-dev)
for package in "$work"/*.deb; do dpkg-deb -x "$package" "$folder"; done
rm -rf "$folder/usr/share/locale"

# Links to the system's folders would leave the sysroot.
find "$folder" -type l -lname '/*' -printf '%p %l\n' | while read -r link target; do ln -sfn "$folder$target" "$link"; done

# Objects of this folder become part of the C library's static parts.
triplet=$(dpkg-architecture -a "$arch" -q DEB_HOST_MULTIARCH 2>/dev/null)
libraries=$folder/usr/lib/$triplet
object() {
    "$triplet-gcc" -O2 -fPIC -fno-builtin -fvisibility=hidden -Wall -Wextra -Werror -nostdinc \
        -isystem "$("$triplet-gcc" -print-file-name=include)" -isystem "$folder/usr/include/$triplet" -isystem "$folder/usr/include" \
        -c "$here/$1.c" -o "$work/$1.o"
}
object newer_glibc
for archive in libc.a libc_nonshared.a; do "$triplet-ar" rs "$libraries/$archive" "$work/newer_glibc.o" 2>/dev/null; done
object older_names
"$triplet-ar" rcs "$libraries/libm_nonshared.a" "$work/older_names.o"
object musl_names
"$triplet-ar" rcs "$libraries/libpthread_nonshared.a" "$work/musl_names.o"
for library in libm.so.6 libpthread.so.0; do
    name=${library%%.*}
    rm "$libraries/$name.so"
    echo "GROUP ( /usr/lib/$triplet/${name}_nonshared.a /lib/$triplet/$library )" >"$libraries/$name.so"
done
touch "$folder/.whole"
