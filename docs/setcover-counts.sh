#!/bin/sh
# The tables "Set cover against its paper" of docs/validation.md: sh docs/setcover-counts.sh path/to/mskit
set -eu
mskit=$(command -v "$1")
cd "$(mktemp -d)"
"$mskit" shape ellipsoid a=6.585 b=6.585 c=3.395 -o spheroid.stl
"$mskit" shape tablet -o tablet.stl

# NAME DEQ OPTIONS...: spheres of the spheroid for 95, 99, 99.9, 99.99 %, and the tablet by 96, 250 and 500, in both counts
row() {
    name=$1 deq=$2
    shift 2
    for shape in spheroid:900 tablet:500; do
        "$mskit" generate ${shape%:*}.stl -g setcover --deq "$deq" -n ${shape#*:} "$@" --cut --curve curve.csv -o clump.csv \
            2>/dev/null >/dev/null
        awk -F, -v name="$name, d_eq/$deq, ${shape%:*}" '
            NR == 1 {
                split("0.95 0.99 0.999 0.9999", goal, " ")
                split("coverage coverage_cut", measure, " ")
                for (column = 1; column <= NF; column++) at[$column] = column
            }
            NR > 1 {
                for (m = 1; m <= 2; m++) {
                    value = $at[measure[m]]
                    for (t = 1; t <= 4; t++) if (value >= goal[t] && !((m, t) in first)) first[m, t] = $1
                    if ($1 == 96 || $1 == 250 || $1 == 500) by[m] = by[m] sprintf(" %.2f", 100 * value)
                }
            }
            END {
                for (m = 1; m <= 2; m++) {
                    printf "%s, %s:", name, measure[m]
                    if (name ~ /spheroid/) for (t = 1; t <= 4; t++) printf " %s", (m, t) in first ? first[m, t] : "never"
                    else printf "%s", by[m]
                    print ""
                }
            }' curve.csv
    done
}
row voxels 100
row cut 100 --set count=cut
row cut 50 --set count=cut
row skeleton-deq 100 --skeleton-deq 100
row candidates=skeleton 100 --candidates skeleton
row candidates=all 100 --candidates all
