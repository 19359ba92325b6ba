#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   newcomer.sh SUITE [tests]   what the README tells, in a clean Debian of bookworm or trixie
#
# The commit that is checked out is cloned where git, a C compiler and this machine's Rust are,
# and nothing else. There: the main job; compare.sh on a program of the newcomer's own, which
# FCL calls libccd for; a wrong answer that it kept, played again; with `tests` all tests. As
# root; chroot.sh says more.

set -eu
[ $# -eq 1 ] || [ "$*" = "${1:-} tests" ] || { echo "usage: newcomer.sh SUITE [tests]" >&2; exit 2; }
suite=$1
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release_of "$suite" >/dev/null

name=newcomer-$suite
root=$chroots/$name
make_chroot "$name" "$suite"
apt_in_chroot "$name" git build-essential ca-certificates
rust=$(rustc --print sysroot)
if [ "$(cat "$root/opt/rust-version" 2>/dev/null)" != "$(rustc --version)" ]; then
    rm -rf "$root/opt/rust"
    mkdir "$root/opt/rust"
    # Without the documentation and its manuals.
    tar -C "$rust" --exclude=./share -c . | tar -C "$root/opt/rust" -x
    rustc --version >"$root/opt/rust-version"
fi
rm -rf "$root/root/warmccd"
git clone -q "$here/../.." "$root/root/warmccd"

# in_clone COMMAND...: with what a login of the newcomer's has
in_clone() {
    # shellcheck disable=SC2016  # the inner shell expands
    in_chroot "$name" env PATH=/opt/rust/bin:/usr/sbin:/usr/bin:/sbin:/bin sh -c 'cd /root/warmccd && "$@"' sh "$@"
}

echo "== the main job"
in_clone sh c-tests/main.sh
echo "== compare.sh"
apt_in_chroot "$name" libfcl-dev
cp "$here/newcomer.cpp" "$root/root/program.cpp"
in_chroot "$name" sh -c 'cd /root && g++ -O2 -I/usr/include/eigen3 program.cpp -lfcl -o program && rm -rf kept'
start=$(date +%s)
in_clone sh c-tests/compare.sh --keep /root/kept /root/program
in_clone sh c-tests/replay.sh /root/kept/libccd-deep.txt
echo "newcomer.sh: the screen and the replay took $(($(date +%s) - start)) s"
if [ $# -eq 2 ]; then
    echo "== the tests"
    in_clone sh c-tests/test.sh
fi
echo "newcomer.sh: $suite: all is well"
