#!/bin/sh
# Runs doxygen over the headers; a warning fails. The pages go where OUTPUT says, else into a folder that is removed.
set -eu
cd "$(dirname "$0")"
command -v doxygen >/dev/null || { echo "doxygen is not installed: headers not checked" >&2; exit 77; }
folder="${OUTPUT:-}"
if [ -z "$folder" ]; then
    folder="$(mktemp -d)"
    trap 'rm -rf "$folder"' EXIT
fi
{ cat Doxyfile; echo "OUTPUT_DIRECTORY = $folder"; } | doxygen -
