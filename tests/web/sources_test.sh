#!/usr/bin/env bash
# sources.sh with stand-ins for apt-get and dpkg-source: what else lies in its folder stays. sources_test.sh SOURCE WORK
set -euo pipefail
script=$1/apps/web/sources.sh
rm -rf "$2"
mkdir -p "$2/tools" "$2/folder"
work=$(realpath "$2")

cat >"$work/tools/apt-get" <<'TOOL'
#!/bin/sh
for package; do :; done
case $package in
update) exit 0 ;;
draco) exit 1 ;; # not at this mirror, but for draco/CODENAME
esac
name=${package%/*}
touch "${name}_1.0-1.dsc" "${name}_1.0.orig.tar.xz" "${name}_1.0.orig.tar.xz.asc"
TOOL
cat >"$work/tools/dpkg-source" <<'TOOL'
#!/bin/sh
for description; do :; done
mkdir "${description%%_*}-1.0"
TOOL
chmod +x "$work"/tools/*
cd "$work/folder"
touch backup.tar.gz mine.dsc key.asc

PATH=$work/tools:$PATH "$script" "$work/folder"
expected=$(printf '%s\n' backup.tar.gz draco-1.0 expat-1.0 key.asc libdeflate-1.0 libjpeg-turbo-1.0 libwebp-1.0 meshoptimizer-1.0 mine.dsc)
found=$(LC_ALL=C ls -A)
if [ "$found" != "$expected" ]; then
    echo "expected:"$'\n'"$expected"$'\n'"found:"$'\n'"$found"
    exit 1
fi
