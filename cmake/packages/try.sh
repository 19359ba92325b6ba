#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   try.sh SUITE ARCHIVE OUT   makes and tries the Debian packages of bookworm or trixie
#
# In one clean chroot the packages are made from source.sh's archive and put into OUT. In
# another, apt installs Debian's FCL, ODE, MuJoCo and DART, programs are compiled with
# them on libccd, our packages take libccd's place, the same programs run on them, and
# libccd is brought back. As root; chroot.sh says more.

set -eu
[ $# -eq 3 ] || { echo "usage: try.sh SUITE ARCHIVE OUT" >&2; exit 2; }
suite=$1
archive=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release=$(release_of "$suite")
rust="rustc cargo"
[ "$suite" != bookworm ] || rust="rustc-web cargo-web"

# --- made
build=build-$suite
make_chroot "$build" "$suite"
# shellcheck disable=SC2086  # one word per package
apt_in_chroot "$build" $rust build-essential cmake debhelper fakeroot lintian
rm -rf "$chroots/$build/work"
mkdir "$chroots/$build/work"
cp "$archive" "$here/deb.sh" "$chroots/$build/work"
in_chroot "$build" sh -c 'cd work && sh deb.sh ./*.tar.xz out && lintian --fail-on error out/*.changes'
cp "$chroots/$build"/work/out/*.deb "$out"

# --- tried
try=try-$suite
make_chroot "$try" "$suite"
apt_in_chroot "$try" build-essential libccd-dev libfcl-dev libode-dev libmujoco-dev libdart-dev
work=$chroots/$try/work
rm -rf "$work"
mkdir "$work"
cp -r "$here/../../c-tests" "$work/c-tests"
# The programs ask whether there is an extension; libccd has no such headers.
mkdir -p "$work/ours/ccd"
cp "$here/../../include/ccd/warm.h" "$here/../../include/ccd/paper.h" "$here/../../include/ccd/shapes.h" "$work/ours/ccd"
cp "$out"/libwarmccd2_*"~deb${release}_"*.deb "$out"/libwarmccd-dev_*"~deb${release}_"*.deb "$work"
cp "$here/programs.sh" "$work"

in_chroot "$try" sh -c 'cd work && sh programs.sh build'
echo "== on libccd"
in_chroot "$try" sh -c 'cd work && sh programs.sh run libccd'
echo "== libwarmccd2 takes its place"
in_chroot "$try" sh -c 'cd work && apt-get install -y -qq -o Dpkg::Use-Pty=0 ./*.deb'
in_chroot "$try" sh -c 'cd work && sh programs.sh run warmccd'
echo "== libccd comes back"
in_chroot "$try" apt-get install -y -qq -o Dpkg::Use-Pty=0 libccd-dev libccd2
in_chroot "$try" sh -c 'cd work && sh programs.sh run libccd'
echo "try.sh: $suite: all is well"
