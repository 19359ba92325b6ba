#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   tests.sh SUITE   all tests with Debian's own Rust, in a clean Debian of bookworm or trixie
#
# The commit that is checked out is cloned where git, rustc-web and cargo-web are, and nothing
# else; test.sh installs what it misses. Its last line and its exit code are this command's. As
# root; chroot.sh says more.

set -eu
[ $# -eq 1 ] || { echo "usage: tests.sh SUITE" >&2; exit 2; }
suite=$1
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release=$(release_of "$suite")

name=tests-$suite
root=$chroots/$name
make_chroot "$name" "$suite"
# Debian brings newer Rusts as updates of a release that is out.
for updates in "debian $suite-updates" "debian-security $suite-security"; do
    echo "deb http://deb.debian.org/${updates% *} ${updates#* } main"
done >"$root/etc/apt/sources.list.d/updates.list"
apt_in_chroot "$name" git ca-certificates rustc-web cargo-web
rm -rf "$root/root/warmccd"
git clone -q "$here/../.." "$root/root/warmccd"

echo "== Debian $release, $(in_chroot "$name" rustc --version)"
in_chroot "$name" sh -c 'cd /root/warmccd && exec sh c-tests/test.sh'
