#!/bin/sh
# Makes a Debian with Blender 4.3 in a folder, as root: debian.sh FOLDER PACKAGE...
set -eu
root=$1
shift
command -v debootstrap >/dev/null ||
    "$(dirname "$0")/packages.sh" debootstrap debian-archive-keyring ca-certificates
mkdir -p "$root"
root=$(cd "$root" && pwd)
[ -x "$root/usr/bin/apt-get" ] ||
    debootstrap --variant=minbase --include=ca-certificates trixie "$root" https://deb.debian.org/debian
cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
# No service is started in there.
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
# What Debian's Blender only recommends, its extensions need.
chroot "$root" env DEBIAN_FRONTEND=noninteractive sh -ec '
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends \
        blender python3-numpy python3-requests python3-zstandard python3-cattr "$@"
    apt-get clean' sh "$@"
touch "$root/orbflow.stamp"
