#!/bin/sh
# Installs system libraries where they are missing: those that Blender as a Python module needs or,
# with the argument vulkan, a software driver that tests of the GPU engine run on.
set -eu
[ "$(uname)" = Linux ] || exit 0
command -v dpkg-query >/dev/null || exit 0
case "${1:-blender}" in
blender) libraries="libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0 libsm6 libgl1 libegl1" ;;
vulkan) libraries="libvulkan1 mesa-vulkan-drivers" ;;
*) echo "usage: $0 [blender|vulkan]" >&2 && exit 2 ;;
esac
missing=
for library in $libraries; do
    dpkg-query -W -f '${db:Status-Status}' "$library" 2>/dev/null | grep -qx installed ||
        missing="$missing $library"
done
[ -n "$missing" ] || exit 0
if [ "$(id -u)" != 0 ]; then
    echo "these system libraries are missing: sudo apt-get install$missing" >&2
    exit 1
fi
apt-get update -qq
# shellcheck disable=SC2086 # one word per library
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
