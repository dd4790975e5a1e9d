#!/bin/sh
# All methods on shapes, n = 5 to 200, by default options: results, charts and the tables of docs/comparison.md.
#
#     docs/make-comparison.sh [FOLDER OF SHAPES]
#
# Without a folder, on shapes that mskit makes; the charts shown in docs/comparison.md are of these. MSKIT names the
# program, OUT the folder of the results (comparison), REPEAT how many runs the times are medians of (3), CELLS the
# resolutions (50,100). What was begun before is gone on with. Tables and charts go into docs/comparison.md, between its
# marks, and docs/comparison/. Times are meant for a machine that has nothing else to do.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
MSKIT="${MSKIT:-$here/../build/eval/mskit}"
OUT="${OUT:-comparison}"
mkdir -p "$OUT"
if [ $# -eq 0 ]; then
    shapes="$OUT/shapes" part=shapes
    mkdir -p "$shapes"
    for kind in grain tablet torus cube ellipsoid; do
        "$MSKIT" shape "$kind" -o "$shapes/$kind.stl"
    done
else
    shapes="$1" part=meshes
fi
set --
for shape in "$shapes"/*.stl "$shapes"/*.ply "$shapes"/*.obj "$shapes"/*.off; do
    [ ! -f "$shape" ] || set -- "$@" "$shape"
done
"$MSKIT" compare "$@" -n 5,10,20,30,50,100,200 --cells "${CELLS:-50,100}" --repeat "${REPEAT:-3}" \
    -o "$OUT/results.csv" --charts "$OUT/charts" --resume
python3 "$here/comparison-tables.py" "$OUT/results.csv" >"$OUT/tables.md"
python3 "$here/tables.py" "$here/comparison.md" "$part=$OUT/tables.md"
if [ "$part" = shapes ]; then
    for chart in grain-time torus-time grain-dice cube-dice grain-inertia grain-corrected grain-resolution; do
        cp "$OUT/charts/$chart.svg" "$here/comparison/"
    done
    cp "$OUT/charts/cube-sheet.png" "$here/comparison/"
fi
