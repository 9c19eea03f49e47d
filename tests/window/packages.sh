#!/bin/sh
# Installs Debian's or Ubuntu's packages, or says which ones are missing: packages.sh NAME...
set -eu
if ! command -v apt-get >/dev/null || [ "$(id -u)" != 0 ]; then
    echo "these packages are needed: $*" >&2
    exit 1
fi
apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"
