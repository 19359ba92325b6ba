#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   cargo-c.sh   installs the library with `cargo cinstall`, and runs a C program on it
#
# In a chroot of Debian 13, with its cargo-c. The files are those of this folder that git knows.
# As root; chroot.sh says more.

set -eu
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"

make_chroot cargo-c trixie
apt_in_chroot cargo-c cargo-c rustc cargo gcc libc6-dev pkg-config ca-certificates
root=$chroots/cargo-c
rm -rf "$root/tree" "$root/installed"
mkdir "$root/tree"
(cd "$here/../.." && git ls-files -z | tar -c --null -T -) | tar -x -C "$root/tree"

# shellcheck disable=SC2016  # the inner shell expands
in_chroot cargo-c sh -euc '
    cargo cinstall --release --locked --manifest-path /tree/Cargo.toml --target-dir /cargo \
        --prefix=/installed --libdir=lib
    cd /installed
    export PKG_CONFIG_PATH=/installed/lib/pkgconfig
    pkg-config --modversion ccd
    readelf -d lib/libccd.so.2 | grep "SONAME.*libccd.so.2"
    main=/tree/c-tests/tests/packaging/consumer/main.c
    gcc $main $(pkg-config --cflags --libs ccd) -lm -o shared
    gcc $main $(pkg-config --cflags ccd) lib/libccd.a $(sed -n "s/^Libs.private://p" lib/pkgconfig/ccd.pc) -o static
    LD_LIBRARY_PATH=lib ./shared
    ./static
    find include lib -type f -o -type l | sort'
