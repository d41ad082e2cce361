#!/usr/bin/env bash
# Makes the tree of an image: the program, its licence, an empty /work and /tmp, and the shared libraries that the program needs, if any.
#   root.sh PROGRAM ROOT
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=$1 tree=$2
mkdir -p "$tree/work" "$tree/tmp"
chmod 1777 "$tree/work" "$tree/tmp"
install -m 755 "$program" "$tree/halflit"
install -m 644 "$here/../../LICENSE" "$tree/LICENSE"
# The module of EXR and Draco lies beside the program, if it has one.
modules=()
for module in "$(dirname "$program")/halflit_codecs.so" "$(dirname "$program")"/../lib*/halflit/halflit_codecs.so \
    "$(dirname "$program")"/../lib/*/halflit/halflit_codecs.so; do
    [ -e "$module" ] && modules=("$module") && install -m 755 "$module" "$tree/halflit_codecs.so" && break
done
# For a static program ldd fails and grep finds nothing.
libraries=$(ldd "$program" "${modules[@]}" 2>/dev/null | grep -oE '/[^ ]+\.so[^ :]*' | sort -u) || true
for library in $libraries; do install -D -m 755 "$library" "$tree$library"; done
