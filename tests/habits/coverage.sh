#!/bin/sh
# Lines and branches that the tests run so far have reached: "coverage.sh BUILD", BUILD made with -Db_coverage=true.
set -eu
build="$1"
cd "$(dirname "$0")/../.."
if ! find "$build" -name '*.gcda' | grep -q .; then
    echo "no coverage in $build: set it up with -Db_coverage=true and run its tests before" >&2
    exit 77
fi
# Threads count side by side without a lock: some counts turn negative, which is no line less.
gcovr --gcov-ignore-parse-errors --root . --object-directory "$build" --filter common/ --filter generators/ --filter eval/ --sort-percentage "$build"
