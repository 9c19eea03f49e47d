#!/bin/sh
# Installs the system libraries that Blender as a Python module needs, where they are missing.
set -eu
[ "$(uname)" = Linux ] || exit 0
command -v dpkg-query >/dev/null || exit 0
missing=
for library in libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0 libsm6 libgl1 libegl1; do
    dpkg-query -W -f '${db:Status-Status}' "$library" 2>/dev/null | grep -qx installed ||
        missing="$missing $library"
done
[ -n "$missing" ] || exit 0
if [ "$(id -u)" != 0 ]; then
    echo "Blender needs these system libraries: sudo apt-get install$missing" >&2
    exit 1
fi
apt-get update -qq
# shellcheck disable=SC2086 # one word per library
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
