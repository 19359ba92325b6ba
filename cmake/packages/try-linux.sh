#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   try-linux.sh SUITE ARCHIVE   tries linux.sh's archive in a clean Debian of bookworm or trixie, without Rust
#
# As root; chroot.sh says more.

set -eu
[ $# -eq 2 ] || { echo "usage: try-linux.sh SUITE ARCHIVE" >&2; exit 2; }
suite=$1
archive=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release_of "$suite" >/dev/null

name=linux-$suite
make_chroot "$name" "$suite"
apt_in_chroot "$name" build-essential cmake pkg-config libccd-dev libode-dev libfcl-dev python3-venv ca-certificates
work=$chroots/$name/work
rm -rf "$work"
mkdir -p "$work/repository/cmake" "$work/tried"
cp "$archive" "$work"
cp -r "$here/../../c-tests" "$work/repository"
cp -r "$here" "$work/repository/cmake/packages"
in_chroot "$name" sh -c 'cd /work/tried && sh ../repository/cmake/packages/linux-inside.sh ../*.tar.gz ../repository'
echo "try-linux.sh: $suite: all is well"
