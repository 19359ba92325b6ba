#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   platforms.sh   builds the library for Windows and runs C programs on it under wine; builds it for
#                  macOS, and C programs on it; checks it for MSVC
#
# In a chroot of Debian 13, with MinGW, wine, clang and Debian's Rust. The standard libraries for these
# targets, which `rustup target add` would bring, are compiled from rust-src. The files are those of
# this folder that git knows. Says what is missing where that cannot be installed. As root;
# chroot.sh says more.

set -eu
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"

make_chroot platforms trixie
apt_in_chroot platforms rustc cargo rust-src gcc-mingw-w64-x86-64-win32 wine wine64 cmake make gcc libc6-dev \
    ca-certificates python3-venv clang lld llvm || {
    echo "platforms.sh: MinGW, wine, clang or rust-src cannot be installed here" >&2
    exit 1
}
root=$chroots/platforms
rm -rf "$root/tree"
mkdir "$root/tree"
(cd "$here/../.." && git ls-files -z | tar -c --null -T -) | tar -x -C "$root/tree"
in_chroot platforms sh /tree/cmake/packages/platforms-inside.sh
