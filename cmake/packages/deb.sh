#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   deb.sh ARCHIVE OUT   makes Debian packages from source.sh's archive, into OUT
#
# On Debian 12 or later, with build-essential, debhelper, cmake and Rust 1.85
# (rustc and cargo, or rustc-web and cargo-web). No network is asked. Afterwards
#   apt-get install OUT/libwarmccd2_*.deb   takes the place of libccd2
#   apt-get install libccd2                 brings libccd2 back
# DEBFULLNAME and DEBEMAIL say who maintains the packages.

set -eu
[ $# -eq 2 ] || { echo "usage: deb.sh ARCHIVE OUT" >&2; exit 2; }
archive=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tar -xf "$archive" -C "$work"
cd "$work"/warmccd-*
version=$(sh cmake/packages/version.sh)
release=$(. /etc/os-release && echo "$VERSION_ID")
maintainer="${DEBFULLNAME:-warmccd developers} <${DEBEMAIL:-warmccd@users.noreply.github.com}>"
# The archive's files have the commit's date: so have the packages' files.
date=$(date -R -u -r Cargo.toml)

cp -r cmake/packages/debian debian
sed -i "s|@MAINTAINER@|$maintainer|" debian/control
cat >debian/changelog <<END
warmccd ($version-1~deb$release) unstable; urgency=medium

  * Version $version; CHANGELOG.md tells what is new.

 -- $maintainer  $date
END
dpkg-buildpackage -b -uc
mv ../*.deb ../*.changes ../*.buildinfo "$out"
