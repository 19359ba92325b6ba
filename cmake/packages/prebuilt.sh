#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   prebuilt.sh SUITE OUT   makes linux.sh's archive and wheel.sh's wheel in a clean Debian of bookworm or trixie, into OUT
#
# From the commit that is checked out, with Debian's Rust alone; linux.sh installs what else it needs. As root; chroot.sh
# says more.

set -eu
[ $# -eq 2 ] || { echo "usage: prebuilt.sh SUITE OUT" >&2; exit 2; }
suite=$1
mkdir -p "$2"
out=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release_of "$suite" >/dev/null
rust="rustc cargo"
[ "$suite" != bookworm ] || rust="rustc-web cargo-web"

name=build-$suite
root=$chroots/$name
make_chroot "$name" "$suite"
# shellcheck disable=SC2086  # one word per package
apt_in_chroot "$name" $rust git ca-certificates
rm -rf "$root/root/warmccd" "$root/root/out"
git clone -q "$here/../.." "$root/root/warmccd"
in_chroot "$name" sh -c 'cd /root/warmccd && sh cmake/packages/linux.sh /root/out && sh cmake/packages/wheel.sh /root/out /root/out/*.tar.gz'
cp "$root"/root/out/* "$out"
