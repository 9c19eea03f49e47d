#!/bin/sh
# Runs checks in Blender's real window, or makes pictures of it: run.sh OUT [NAME...]
#
# Where no Blender of 4.2 or later is at hand, a Debian that has one is made in the folder .window
# (as root; 5 minutes, 2 GB, once). BLENDER names a program to take, WINDOW_ROOT another folder.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../.." && pwd)
[ $# -gt 0 ] || { echo "usage: $0 OUT [NAME...]" >&2 && exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
[ "$(uname)" = Linux ] || { echo "the window is tried on Linux alone" >&2 && exit 1; }
BLENDER=${BLENDER:-blender}
WINDOW_ROOT=${WINDOW_ROOT:-$top/.window}
TOOLS="xvfb imagemagick libgl1-mesa-dri libegl-mesa0"

is_new_enough() {
    "$BLENDER" --version 2>/dev/null |
        awk '$1 == "Blender" { split($2, v, "."); exit !(v[1] > 4 || (v[1] == 4 && v[2] >= 2)) }
             END { if (NR == 0) exit 1 }'
}

# Copies what a run needs into an empty folder.
fill() {
    rm -rf "$1"
    mkdir -p "$1/out"
    cp "$top"/dist/orbflow-*.zip "$here"/*.py "$here"/session.sh "$top"/blend_fixtures/*.blend "$1"
}

# Copies what a run has left, and ends with its status.
finish() {
    cp -R "$1"/out/. "$out"
    exit "$2"
}

if is_new_enough; then
    if ! command -v Xvfb >/dev/null || ! command -v import >/dev/null; then
        "$here/packages.sh" $TOOLS
    fi
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    fill "$work"
    status=0
    "$work/session.sh" "$BLENDER" "$@" || status=$?
    finish "$work" "$status"
fi

if [ "$(id -u)" != 0 ]; then
    echo "Blender 4.2 or later is needed: put one on PATH, name one by BLENDER=..., or run this as" \
        "root, so that a Debian with one is made in $WINDOW_ROOT" >&2
    exit 1
fi
[ -e "$WINDOW_ROOT/orbflow.stamp" ] || "$here/debian.sh" "$WINDOW_ROOT" $TOOLS
if ! mountpoint -q "$WINDOW_ROOT/proc"; then
    mount -t proc proc "$WINDOW_ROOT/proc"
    trap 'umount "$WINDOW_ROOT/proc"' EXIT
fi
work=/tmp/orbflow-window
fill "$WINDOW_ROOT$work"
status=0
chroot "$WINDOW_ROOT" "$work/session.sh" blender "$@" || status=$?
finish "$WINDOW_ROOT$work" "$status"
