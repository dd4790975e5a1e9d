#!/bin/sh
# The figures of docs/stability.md: where each method breaks, on the built-in shapes of mskit stability.
#
#     docs/make-stability.sh
#
# MSKIT names the program, OUT the folder of the results (stability), RUNS how many runs of each change (3). What was
# begun before is gone on with. Tables go into docs/stability.md, between its marks.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
MSKIT="${MSKIT:-$here/../build/eval/mskit}"
OUT="${OUT:-stability}" RUNS="${RUNS:-3}"
METHODS="mss setcover fcm variational"
mkdir -p "$OUT"

stability() { # NAME, then what stability takes
    name=$1
    shift
    start=$(date +%s)
    "$MSKIT" stability "$@" -o "$OUT/$name.csv" --resume >"$OUT/$name.out" 2>"$OUT/$name.err" ||
        { cat "$OUT/$name.err" >&2; exit 1; }
    echo "$name $(($(date +%s) - start))" | tee -a "$OUT/seconds.txt"
}

stability all -n 20 --runs "$RUNS" --charts "$OUT/charts"
stability number cone torus open --until-dice 0.1 --perturb rotation --perturb noise --perturb seed -n 20 --runs "$RUNS"
for n in 5 10 50 100 200; do # those by 20 are in the first table
    stability "hard-$n" bowl limbs cavity corners pair -n "$n" --perturb seed --runs 1
done

# How much of the cavity spheres fill: what they cover of a ball in its place.
"$MSKIT" shape hollow R=1 r=0.2 -o "$OUT/hollow.stl"
"$MSKIT" shape ball r=0.2 -o "$OUT/filling.stl"
for method in $METHODS; do
    for n in 10 20 50 100; do
        clump="$OUT/hollow-$method-$n"
        "$MSKIT" generate "$OUT/hollow.stl" -g "$method" -n "$n" --deq 60 -o "$clump.csv" 2>"$clump.err" >"$clump.out" &&
            "$MSKIT" score "$clump.csv" --target "$OUT/filling.stl" --json 2>"$clump.err" >"$clump.filled.json" ||
            { cat "$clump.err" >&2; exit 1; }
    done
done
"$MSKIT" --version >"$OUT/version.txt"
nproc >"$OUT/cores.txt"
python3 "$here/stability-tables.py" "$OUT" "$here/stability.md"
