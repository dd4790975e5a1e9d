#!/bin/sh
# The picture of README.md: the shapes of docs/quickstart.sh, made by the program in the folder of the first argument,
# build/eval/mskit by default. Takes gnuplot-nox.
set -eu
cd "$(dirname "$0")/.."
mskit="$(realpath "${1:-build/eval/mskit}")"
out="$PWD/docs/grain.png"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$mskit" shape grain -o grain.stl
"$mskit" compare grain.stl -g variational -n 5,50 --charts charts
cp charts/grain-sheet.png "$out"
