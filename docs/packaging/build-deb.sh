#!/bin/sh
# Builds the Debian packages of this tree into FOLDER (packages), and has lintian judge them.
#
#     docs/packaging/build-deb.sh [FOLDER]
set -eu
out="$(realpath -m "${1:-packages}")"
cd "$(dirname "$0")/../.."
sh docs/install-packages.sh debhelper dh-python dpkg-dev fakeroot lintian python3-cffi python3-dev python3-numpy
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
mkdir "$work/mskit" "$work/mskit/debian"
# The tree as it is, without what was built in it. Debian's folder stands at the top of a source package.
tar -cf - --exclude-vcs --exclude='./build*' --exclude='./packages' --exclude='./demo' --exclude='./venv' . |
    tar -xf - -C "$work/mskit"
cp -r docs/packaging/debian/. "$work/mskit/debian"
(cd "$work/mskit" && dpkg-buildpackage --no-sign --build=binary)
mkdir -p "$out"
cp "$work"/*.deb "$work"/*.changes "$out"
lintian --fail-on error,warning "$work"/*.changes
ls "$out"
