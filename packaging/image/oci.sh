#!/usr/bin/env bash
# Makes an image of the program, as a folder in the layout of the Open Container Initiative, by umoci: no service and no rights are needed.
# podman, skopeo and others read it as oci:FOLDER:TAG.
#   oci.sh PROGRAM FOLDER [TAG]     TAG: by default latest
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=$1 folder=$2 tag=${3:-latest}
command -v umoci >/dev/null || {
    echo "oci.sh: umoci is not there" >&2
    exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Times of the image are those of the program, so that the same program gives the same image.
made=$(date -u -r "$program" +%Y-%m-%dT%H:%M:%SZ)
umoci init --layout "$folder"
umoci new --image "$folder:$tag"
umoci unpack --rootless --image "$folder:$tag" "$work/bundle"
"$here/root.sh" "$program" "$work/bundle/rootfs"
find "$work/bundle/rootfs" -exec touch -h -d "$made" {} +
umoci repack --history.created "$made" --image "$folder:$tag" "$work/bundle"
case $(uname -m) in
x86_64) architecture=amd64 ;;
aarch64) architecture=arm64 ;;
*) architecture=$(uname -m) ;;
esac
umoci config --image "$folder:$tag" --created "$made" --history.created "$made" --os linux --architecture "$architecture" \
    --config.user 65534:65534 --config.workingdir /work --config.entrypoint /halflit --config.label org.opencontainers.image.licenses=MIT
umoci gc --layout "$folder"
