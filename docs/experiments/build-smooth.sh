#!/bin/sh
# LIGGGHTS with superquadrics, for the cell smooth of contrasts.py: writes FOLDER/liggghts-smooth, from the source of
# Debian's package, which is built without them.
#
#     docs/experiments/build-smooth.sh FOLDER
#
# Takes curl, xz, make, g++ and Boost's headers (libboost-dev), and about 20 minutes of one core.
set -eu
[ $# -eq 1 ] || { echo "usage: $0 FOLDER" >&2; exit 2; }
mkdir -p "$1"
cd "$1"
folder="$PWD"
curl -fsSLO 'http://deb.debian.org/debian/pool/main/l/liggghts/liggghts_3.8.0+repack1.orig.tar.xz'
tar -xf 'liggghts_3.8.0+repack1.orig.tar.xz'
cd LIGGGHTS-PUBLIC-3.8.0/src
# Two lines that g++ 12 refuses, and a dump that takes VTK.
sed -i 's/return static_cast< std::ostringstream & >.*/return std::to_string(a);/' utils.h
sed -i 's/lists\[m\]->numneigh > 0/lists[m]->numneigh/' finish.cpp
rm -f dump_mesh_vtk.cpp dump_mesh_vtk.h
# The contact models that the experiments take; all of them together are half of the build.
for surface in SURFACE_DEFAULT SURFACE_SUPERQUADRIC; do
    echo "GRAN_MODEL(HERTZ, TANGENTIAL_HISTORY, COHESION_OFF, ROLLING_OFF, $surface)"
done >style_contact_model.whitelist
sh Make.sh style
sh Make.sh models
make -C STUBS
printf '%s\n' ./*.cpp | xargs -P "$(nproc)" -n 1 g++ -O2 -std=c++14 -w -ISTUBS -DSUPERQUADRIC_ACTIVE_FLAG \
    -DNONSPHERICAL_ACTIVE_FLAG -DBOOST_INCLUDED -c
g++ -O2 -o "$folder/liggghts-smooth" ./*.o -LSTUBS -lmpi_stubs -ldl
echo "$folder/liggghts-smooth"
