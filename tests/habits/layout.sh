#!/bin/sh
# The layout of the tree's C files, by .clang-format: "layout.sh apply" makes it, "layout.sh check" says what differs.
# Lines of Python are held to the same width.
set -eu
cd "$(dirname "$0")/../.."
how="--dry-run --Werror"
[ "$1" = check ] || how=-i
# clang-format leaves comments alone.
if grep -rnE '^.{121,}' --include='*.[ch]' --include='*.py' common generators eval tests docs; then
    echo "these lines are longer than 120 characters" >&2
    exit 1
fi
find common generators eval tests \( -name '*.c' -o -name '*.h' \) -exec clang-format $how {} +
