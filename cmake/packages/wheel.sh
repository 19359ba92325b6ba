#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   wheel.sh OUT [ARCHIVE]   makes OUT/warmccd-VERSION-py3-none-manylinux_2_28_x86_64.whl from linux.sh's archive (made now
#                            if not named)
#
# The double library, libwarmccd-fcl.so, libwarmccd-middle.so, headers, notices and the recorder, which `warmccd` runs programs
# with; for each Python 3 of a Linux with glibc 2.28 or later. Needs python3-venv and a network, for setuptools. The same
# archive and setuptools give the same bytes.

set -eu
[ $# -eq 1 ] || [ $# -eq 2 ] || { echo "usage: wheel.sh OUT [ARCHIVE]" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
archive=${2:-}
if [ -z "$archive" ]; then
    sh "$here/linux.sh" "$work"
    archive=$(echo "$work"/*.tar.gz)
fi
tar -xzf "$archive" -C "$work" --strip-components=1 --one-top-level=built

tree=$work/tree
package=$tree/warmccd
mkdir "$tree"
(cd "$here/wheel" && git ls-files -z | tar -c --null -T -) | tar -x -C "$tree"
sed -i "s/@VERSION@/$(sh "$here/version.sh")/" "$tree/pyproject.toml"
cp "$work/built/LICENSE" "$work/built/THIRD-PARTY" "$tree"
cp -r "$work/built/include" "$work/built/recorder" "$package"
mkdir "$package/lib"
cp -L "$work/built/lib/libccd.so.2" "$work/built/lib/libwarmccd-fcl.so" "$work/built/lib/libwarmccd-middle.so" "$package/lib"
find "$package" -name '*.so*' -exec sh "$here/symbols.sh" {} +

python3 -m venv "$work/venv"
SOURCE_DATE_EPOCH=$(stat -c %Y "$work/built/LICENSE")
export SOURCE_DATE_EPOCH
"$work/venv/bin/pip" wheel -q --no-deps -w "$work/wheel" \
    --config-settings=--build-option=--plat-name=manylinux_2_28_x86_64 "$tree"
cp "$work"/wheel/*.whl "$out"
echo "$out/$(basename "$work"/wheel/*.whl)"
