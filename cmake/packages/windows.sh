#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   windows.sh   builds the library for x86_64-pc-windows-gnu and runs C programs under wine
#
# In a chroot of Debian 13, with MinGW, wine and Debian's Rust, whose standard library for Windows
# is compiled here from rust-src: as rustup's `target add` brings it. The files are those of this
# folder that git knows. Says what is missing where that cannot be installed. As root; chroot.sh
# says more.

set -eu
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"

make_chroot windows trixie
apt_in_chroot windows rustc cargo rust-src gcc-mingw-w64-x86-64-win32 wine wine64 cmake make gcc libc6-dev \
    ca-certificates || {
    echo "windows.sh: MinGW, wine or rust-src cannot be installed here" >&2
    exit 1
}
root=$chroots/windows
# Whom this machine trusts, for a registry behind a proxy.
cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
rm -rf "$root/tree"
mkdir "$root/tree"
(cd "$here/../.." && git ls-files -z | tar -c --null -T -) | tar -x -C "$root/tree"
in_chroot windows sh /tree/cmake/packages/windows-inside.sh
