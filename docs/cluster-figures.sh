#!/bin/bash
# The figures of docs/cluster.md, in a folder of its own that is removed: takes minutes, 3 GB and a million inodes.
#   PATH=build/eval:$PATH bash docs/cluster-figures.sh [GRAINS OF THE LONG LISTS] [GRAINS MADE]
set -eu
many=${1:-1000000} few=${2:-100} parts=16
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
say() { # what, command: seconds and memory of the command
    echo "$1: $({ TIMEFORMAT='%R s, of the processor %U + %S s'; time "${@:2}" >out 2>err; } 2>&1)"
}

mkdir small
for k in $(seq "$few"); do
    mskit shape grain seed="$k" -o "small/$k.stl" >/dev/null 2>&1
done
for method in mss variational; do
    say "$few grains by $method, templates for LAMMPS" mskit grains small -g "$method" -n 20 --cells 40 -j 1 \
        --format csv --format lammps --density 2600 -o "$method"
done
say "$few grains by mss, spheres alone" mskit grains small -g mss -n 20 --cells 40 -j 1 -o mss-csv
for run in mss mss-csv; do
    echo "$run: $(find $run -type f | wc -l) files, $(du -sb $run | cut -f 1) bytes," \
        "$(du -s --block-size=1 $run | cut -f 1) on the disk, $(wc -c <$run/grains.csv) of them the table"
done

mskit shape cube -o cube.stl >/dev/null 2>&1
mkdir many
python3 -c 'import os, sys
for k in range(int(sys.argv[1])):
    os.symlink("../cube.stl", f"many/{k:07d}.stl")' "$many"
(echo shape,label && seq -f "cube.stl,%.0f" "$many") >many.csv
cat >peak.py <<'P'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1000, "MB")
P
for list in many many.csv; do
    say "list of $many grains, $list" python3 peak.py mskit grains "$list" -g mss -n 1 --cells 3 -o none --dry-run
    tail -n 1 out
done

mkdir merge
header=$(head -n 1 mss/grains.csv)
for part in $(seq "$parts"); do
    echo "$header" >"merge/grains-$part-of-$parts.csv"
done
sed -n 2p mss/grains.csv | cut -d , -f 3- >row
seq "$many" | awk -v n="$many" -v parts="$parts" 'BEGIN { getline row <"row" }
    { print $1 "," n "," row >>("merge/grains-" 1 + $1 % parts "-of-" parts ".csv") }'
say "merge of $many rows" python3 peak.py mskit grains --merge merge -o merge
tail -n 1 out
