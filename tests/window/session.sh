#!/bin/sh
# Starts a screen and Blender on it: session.sh BLENDER [NAME...]; leaves all in the folder out.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
blender=$1
shift
home=$(mktemp -d)
mkdir "$home/user" "$home/settings"
mkfifo "$home/screen"
Xvfb -displayfd 3 -screen 0 1600x1000x24 +extension GLX 3>"$home/screen" 2>"$here/out/screen.log" &
screen=$!
trap 'kill $screen 2>/dev/null; rm -rf "$home"' EXIT
read -r number <"$home/screen"
# The user's own settings are neither read nor written; what is installed is all that lies there.
cp "$here"/orbflow-*.zip "$home/user"
export DISPLAY=":$number" LIBGL_ALWAYS_SOFTWARE=1
export HOME="$home/user" BLENDER_USER_RESOURCES="$home/settings"
status=0
timeout -k 10 "${WINDOW_LIMIT_S:-900}" "$blender" --window-geometry 0 0 1600 1000 --enable-event-simulate \
    --python-exit-code 1 --python "$here/session.py" -- "$@" >"$here/out/blender.log" 2>&1 || status=$?
[ "$status" != 124 ] || echo "Blender did not end in time" >>"$here/out/result.txt"
cat "$here/out/result.txt" 2>/dev/null || tail -20 "$here/out/blender.log"
exit "$status"
