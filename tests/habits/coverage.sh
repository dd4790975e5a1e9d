#!/bin/sh
# Lines and branches that the tests run so far have reached: "coverage.sh BUILD", BUILD made with -Db_coverage=true.
set -eu
build="$1"
cd "$(dirname "$0")/../.."
if ! find "$build" -name '*.gcda' | grep -q .; then
    echo "no coverage in $build: set it up with -Db_coverage=true and run its tests before" >&2
    exit 77
fi
gcovr --root . --object-directory "$build" --filter common/ --filter generators/ --filter eval/ --sort-percentage "$build"
