#!/bin/sh
# Installs the Debian packages that building mskit takes; further ones as arguments.
set -eu
packages="gcc libc6-dev meson ninja-build pkg-config libgsl-dev libglpk-dev libjansson-dev zlib1g-dev libqhull-dev
libtiff-dev libnifti2-dev $*"
missing=""
for package in $packages; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "as root, install:$missing" >&2; exit 1; }
    as_root="sudo"
fi
$as_root apt-get update
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
