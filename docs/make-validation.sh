#!/bin/bash
# The tables of docs/validation.md that scripts make, each put between its marks there, in the order of the document.
#
#     docs/make-validation.sh SHARED [NAME...]
#
# SHARED holds the meshes and the judge that the scripts of docs/validation name. NAME, one of those below, makes that
# table alone. MSKIT names the program, OUT the folder of what the scripts print (validation); what they say beside their
# table, as which meshes are not there, is shown. Tables of times are meant for a machine that has nothing else to do.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
export MSKIT="${MSKIT:-$here/../build/eval/mskit}"
OUT="${OUT:-validation}"
[ $# -ge 1 ] || { echo "usage: $0 SHARED [NAME...]" >&2; exit 2; }
shared=$1
shift
mkdir -p "$OUT"
wanted=" $* "
for name in "$@"; do
    grep -q "^<!-- $name -->\$" "$here/validation.md" || { echo "there is no table $name in validation.md" >&2; exit 2; }
done
begun=$(date +%s)

fill() { # NAME, the table that it fills, the command
    name=$1 what=$2
    shift 2
    [ "$wanted" = "  " ] || case "$wanted" in *" $name "*) ;; *) return 0 ;; esac
    start=$(date +%s)
    "$@" >"$OUT/$name.md" 2>"$OUT/$name.err" || { cat "$OUT/$name.err" >&2; exit 1; }
    cat "$OUT/$name.err" >&2
    python3 "$here/tables.py" "$here/validation.md" "$name=$OUT/$name.md" >/dev/null
    echo "$name: $what; $(($(date +%s) - start)) s"
}

scripts="$here/validation"
fill open-clumps "variational against published clumps" "$scripts/open-clumps.py" "$shared"
fill bounds "by more spheres: gap and connected" "$scripts/bounds-table.py" "$shared"
fill inscribed "inscribed spheres" "$scripts/judge-table.py" "$shared" inscribed
for variant in best polish paper spacing heldout; do
    fill "mss-$variant" "MSS against its paper and other codes, $variant" "$scripts/mss-table.py" "$shared" "$variant"
done
fill setcover-counts "set cover against its paper: counts" "$scripts/setcover-counts.py"
meshes=""
for mesh in sand_grain.stl bunny.ply human_femur.stl lithic_flake2.ply pear.stl boulder_SP2B.stl; do
    [ ! -f "$shared/data/$mesh" ] || meshes="$meshes $shared/data/$mesh"
done
# shellcheck disable=SC2086
fill inertia-error "set cover against its paper: eps_w" "$scripts/inertia-error.py" $meshes
fill others "variational against the others" "$scripts/judge-table.py" "$shared" others
fill carriers "carriers" "$scripts/carriers-table.py" "$shared"
if [ "$wanted" = "  " ] || [ "$wanted" = " tablet-impact " ]; then
    if command -v "${LIGGGHTS:-liggghts}" >/dev/null; then
        fill tablet-impact "a tablet against a wall" "$scripts/tablet-impact.py" "$OUT/tablet" 96 500
        cp "$OUT/tablet/tablet-impact.svg" "$scripts/"
    else
        echo "tablet-impact: skipped, there is no LIGGGHTS here"
    fi
fi
fill fcm "clustered spheres against their paper" "$scripts/judge-table.py" "$shared" fcm
fill radii "clustered spheres by the radii of their paper" "$scripts/judge-table.py" "$shared" radii
if [ "$wanted" = "  " ]; then
    "$MSKIT" --version | head -1 >"$OUT/told.md"
    echo "made all tables in one run of $((($(date +%s) - begun) / 60)) minutes on $(nproc) cores." >>"$OUT/told.md"
else
    echo "The tables are of several builds." >"$OUT/told.md"
fi
python3 "$here/tables.py" "$here/validation.md" "told=$OUT/told.md"
