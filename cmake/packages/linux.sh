#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   linux.sh OUT   makes OUT/warmccd-VERSION-linux-x86_64.tar.gz, with which no program needs Rust
#
# The library in double precision, below single/ in single, each with its headers, CMake and pkg-config files, which can be
# moved; libwarmccd-fcl.so, libwarmccd-middle.so; run-on-warmccd.sh with compare.sh's recorder. Nothing in it needs a symbol above GLIBC_2.28.
# Installs what is missing by setup.sh. The same commit and compilers give the same bytes.

set -eu
[ $# -eq 1 ] || { echo "usage: linux.sh OUT" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
here=$(dirname "$(realpath "$0")")
cd "$here/../.."
sh c-tests/setup.sh archive >&2

version=$(sh cmake/packages/version.sh)
name=warmccd-$version-linux-x86_64
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/$name
mkdir -p "$tree/recorder"

# compile COMPILER OUT FLAG...
compile() {
    compiler=$1 object=$2
    shift 2
    "$compiler" -O2 -Wall -Wextra -s -Ic-tests -Iinclude "$@" -o "$object"
}
tools=c-tests/tools/compare
compile c++ "$work/catch.o" -c -fPIC -fvisibility=hidden -include cmake/packages/glibc.h $tools/catch.cpp
# libdl and libpthread by their files: their development names are empty archives since glibc 2.34, and a machine with
# an older one finds these functions nowhere else.
for library in libdl.so.2 libpthread.so.0; do
    "${CC:-cc}" -print-file-name=$library
done >"$work/libraries"
# shellcheck disable=SC2046  # two files
compile cc "$tree/recorder/compare.so" -shared -fPIC -fexceptions -fvisibility=hidden -include cmake/packages/glibc.h \
    "$work/catch.o" $tools/query.c $tools/judge_query.c $tools/write_case.c $tools/preload.c -lstdc++ -lm \
    -Wl,--no-as-needed $(cat "$work/libraries") -Wl,--as-needed
# The program that prints the report needs no library at all.
compile musl-gcc "$tree/recorder/screen" -static $tools/summary.c -lm
# Before what takes minutes.
sh cmake/packages/symbols.sh "$tree/recorder/compare.so"

for precision in double single; do
    [ $precision = double ] && double=ON prefix=$tree || double=OFF prefix=$tree/single
    cmake -S cmake -B "$work/$precision" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
        -DCMAKE_INSTALL_DOCDIR=. -DENABLE_DOUBLE_PRECISION=$double -DCCD_FCL=$double \
        -DCCD_CARGO_TARGET_DIR="${CCD_CARGO_TARGET_DIR:-$work/cargo}"
    cmake --build "$work/$precision"
    cmake --install "$work/$precision" --strip
done

cp c-tests/compare.sh "$tree/recorder"
mkdir "$tree/recorder/tools"
cp c-tests/tools/libccd.sh "$tree/recorder/tools"
install -m 755 cmake/packages/run-on-warmccd.sh "$tree"
cp cmake/packages/linux.md "$tree/README.md"
awk '/^```c$/ { inside = 1; next } /^```/ && inside { exit } inside' README.md >"$tree/example.c"

sh cmake/packages/symbols.sh "$tree/lib/libccd.so.2" "$tree/lib/libwarmccd-fcl.so" "$tree/lib/libwarmccd-middle.so" \
    "$tree/single/lib/libccd.so.2"
date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
tar -c -C "$work" --sort=name --mtime="@$date" --owner=0 --group=0 --numeric-owner --mode=go=rX,u+rw "$name" |
    gzip -9n >"$out/$name.tar.gz"
echo "$out/$name.tar.gz"
