#!/bin/bash
# The figures of docs/population.md: D and time against the number of spheres over a folder of grains, as in fig. 11 of
# the MSS paper, and the libraries of a few grains.
#
#     docs/make-population.sh FOLDER OF GRAINS
#
# MSKIT names the program, OUT the folder of the results (population), CELLS the resolution (100). What was begun before
# is gone on with. Tables go into docs/population.md, between its marks, and charts into docs/population/. Times are
# meant for a machine that has nothing else to do.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
MSKIT="${MSKIT:-$here/../build/eval/mskit}"
OUT="${OUT:-population}" CELLS="${CELLS:-100}"
NUMBERS=5,10,15,20,25,30
METHODS="-g mss -g setcover -g fcm -g variational" BASELINES="-g euclid -g favier -g ferellec"
[ $# -eq 1 ] || { echo "usage: $0 FOLDER_OF_GRAINS" >&2; exit 2; }
mkdir -p "$OUT"

compare() { # NAME, then what compare takes
    name=$1
    shift
    start=$(date +%s)
    "$MSKIT" compare "$@" -n "$NUMBERS" --cells "$CELLS" -o "$OUT/$name.csv" --population "$OUT/$name" --resume \
        >"$OUT/$name.out" 2>"$OUT/$name.err" || { cat "$OUT/$name.err" >&2; exit 1; }
    echo "$name: $(($(date +%s) - start)) s" | tee -a "$OUT/seconds.txt"
    grep '^n = ' "$OUT/$name.err" || true
}

# shellcheck disable=SC2086
compare methods "$1" $METHODS
# The reference of the paper's figure comes first: times are over its mean at the least number.
# shellcheck disable=SC2086
compare baselines "$1" $BASELINES
# One after the other by one thread, every tenth grain.
every_tenth() {
    k=0
    for grain in "$1"/*.ply "$1"/*.stl "$1"/*.obj "$1"/*.off; do
        [ -f "$grain" ] || continue
        [ $((k % 10)) -ne 0 ] || echo "$grain"
        k=$((k + 1))
    done
}
folder=$1
old=$IFS
IFS='
'
# shellcheck disable=SC2046
set -- $(every_tenth "$folder")
IFS=$old
# shellcheck disable=SC2086
compare times "$@" $BASELINES $METHODS -j 1

"$MSKIT" grains "$folder" -g mss -n 20 --cells 50 -o "$OUT/clumps" --resume \
    >"$OUT/clumps.out" 2>"$OUT/clumps.err" || { cat "$OUT/clumps.err" >&2; exit 1; }
for k in 5 10 20 50; do
    [ "$k" -lt "$(wc -l <"$OUT/clumps/grains.csv")" ] || continue
    rm -rf "$OUT/library-$k"
    { TIMEFORMAT='%U'; time "$MSKIT" grains --choose "$k" "$OUT/clumps" --with-size -o "$OUT/library-$k" --json \
        >"$OUT/library-$k.json" 2>"$OUT/library-$k.err"; } 2>"$OUT/library-$k.time" ||
        { cat "$OUT/library-$k.err" >&2; exit 1; }
done
python3 "$here/population-tables.py" "$OUT" "$here/population.md"
