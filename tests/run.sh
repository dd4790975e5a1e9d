#!/bin/sh
# Installs what the tests need (Debian, Ubuntu), builds them and runs them all. Arguments go
# to `meson setup`.
set -eu
cd "$(dirname "$0")/.."
sh docs/install-packages.sh libcmocka-dev gnuplot-nox
build="${BUILD_DIR:-build-test}"
if [ -d "$build" ]; then
    [ $# -eq 0 ] || meson configure "$build" "$@"
else
    meson setup "$build" "$@"
fi
ninja -C "$build"
meson test -C "$build" --print-errorlogs
