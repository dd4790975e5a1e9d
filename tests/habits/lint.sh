#!/bin/sh
# What tools say of the tree: clang-format's layout, doxygen's warnings, and clang-tidy's of all C files, or of those
# that changed since a commit: "lint.sh BUILD [COMMIT]", BUILD having compile_commands.json.
set -eu
build="$(cd "$1" && pwd)"
since="${2:-}"
cd "$(dirname "$0")/../.."
sh tests/habits/layout.sh check
sh docs/doxygen.sh
if [ -n "$since" ]; then
    files="$(git diff --name-only --diff-filter=d "$since" -- 'common/*.c' 'generators/*.c' 'eval/*.c')"
else
    files="$(find common generators eval -name '*.c')"
fi
[ -z "$files" ] || echo "$files" | xargs -P "$(nproc)" -n 8 clang-tidy -p "$build" --quiet
