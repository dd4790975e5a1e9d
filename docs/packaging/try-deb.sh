#!/bin/sh
# Tries the packages of FOLDER (packages), which build-deb.sh fills, in a Debian 12 of their own: installs them, runs
# what they bring, purges them and sees that nothing is left. Takes root, debootstrap and a network.
#
#     docs/packaging/try-deb.sh [FOLDER [DEBIAN]]
#
# DEBIAN: a folder with a Debian 12, which is copied and not changed; without it debootstrap makes one.
set -eu
here="$(realpath "$(dirname "$0")")"
debs="$(realpath "${1:-packages}")"
work="$(mktemp -d)"
root="$work/debian"
trap 'rm -rf "$work"' EXIT
say() { echo "try-deb: $*"; }
inside() {
    chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        DEBIAN_FRONTEND=noninteractive "$@"
}
install() {
    inside apt-get install -y --no-install-recommends "$@" >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
}

if [ -n "${2:-}" ]; then
    cp -a "$2" "$root"
else
    debootstrap --variant=minbase bookworm "$root" >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
fi
mkdir "$root/tmp/trial"
cp "$debs"/*.deb "$root/tmp/trial"
rm -f "$root"/tmp/trial/*-dbgsym_*
inside apt-get update >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }

# With what they depend on alone, the program and the module have to run, and to agree to the last bit.
install $(inside sh -c 'echo /tmp/trial/*.deb')
inside mskit --version
inside sh -euc 'cd /tmp/trial
    mskit shape grain -o grain.stl
    mskit generate grain.stl -n 20 --cells 40 -o grain.csv >/dev/null'
inside python3 -c '
import mskit
clump = mskit.generate("/tmp/trial/grain.stl", spheres=20, cells=40)
assert (clump.spheres == mskit.read_clump("/tmp/trial/grain.csv").spheres).all()'
say "mskit and python3-mskit run and agree"

# The example of docs/library.md, by a compiler and pkg-config.
install gcc libc6-dev pkg-config man-db
sed -n '/^```c$/,/^```$/{/^```/!p;}' "$here/../library.md" >"$root/tmp/trial/clump.c"
inside sh -euc 'cd /tmp/trial
    cc clump.c -o clump $(pkg-config --cflags --libs mskit)
    ./clump grain.stl clump.csv >/dev/null'
say "libmskit-dev builds the program of docs/library.md"
for page in "$root"/usr/share/man/man1/mskit*.1.gz; do
    inside man --warnings "$(basename "$page" .1.gz)" >"$work/page" 2>"$work/log"
    grep -q ^NAME "$work/page" && [ ! -s "$work/log" ] || { say "man $(basename "$page")"; cat "$work/log"; exit 1; }
done
say "$(ls "$root"/usr/share/man/man1/mskit*.1.gz | wc -l) pages of the manual read well"

names="$(for deb in "$root"/tmp/trial/*.deb; do dpkg-deb --field "$deb" Package; done)"
inside apt-get purge -y $names >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
rm -r "$root/tmp/trial"
# But for the pages that man keeps of what it has shown: its own timer clears them.
left="$(cd "$root" && find . -path ./var/cache/man -prune -o -iname '*mskit*' -print)
$(inside dpkg-query -W -f '${Package} ${Status}\n' | grep mskit || true)"
[ -z "$(echo $left)" ] || { say "left after the purge:"; echo "$left"; exit 1; }
say "purged; nothing is left"
