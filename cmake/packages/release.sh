#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   release.sh OUT   makes the source archive, the Debian packages, the archive and the wheel for any Linux, and their checksums
#
# From the commit that is checked out. The packages are made and tried in clean chroots
# of Debian 12 and 13. As root; chroot.sh says more.

set -eu
[ $# -eq 1 ] || { echo "usage: release.sh OUT" >&2; exit 2; }
here=$(dirname "$(realpath "$0")")
mkdir -p "$1"
out=$(realpath "$1")
if [ -n "$(git -C "$here" status --porcelain)" ]; then
    echo "release.sh: there are changes that are not committed" >&2
    exit 1
fi

archive=$(sh "$here/source.sh" "$out")
for suite in bookworm trixie; do
    sh "$here/try.sh" "$suite" "$archive" "$out"
done
# Built on both; the older's is published, and tried on both.
for suite in trixie bookworm; do
    sh "$here/prebuilt.sh" "$suite" "$out"
    sh "$here/try-linux.sh" "$suite" "$out"/*.tar.gz
    sh "$here/try-wheel.sh" "$suite" "$out"/*.whl
done
sh "$here/try-linux.sh" trixie "$out"/*.tar.gz
sh "$here/try-wheel.sh" trixie "$out"/*.whl
cd "$out"
sha256sum -- *.tar.xz *.tar.gz *.whl *.deb >SHA256SUMS
cat SHA256SUMS
