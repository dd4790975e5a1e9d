#!/bin/sh
# Installs what mskit needs (Debian, Ubuntu), builds it and makes a clump of a grain that it
# makes itself.
set -eu
cd "$(dirname "$0")/.."
sh docs/install-packages.sh
[ -d build ] || meson setup build -Dtests=false
ninja -C build
mkdir -p demo
build/eval/mskit shape grain -o demo/grain.stl
build/eval/mskit generate demo/grain.stl --spheres 50 \
    -o demo/grain.csv -o demo/grain.json -o demo/grain.vtk
