#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Asks a case that compare.sh kept again, of libccd and of this library.
#   replay.sh [--library F] FILE     F: a libccd.so of this library's that is built already
# Exit code 0: this library's answer is right; 1: wrong.

set -eu
here=$(cd "$(dirname "$0")" && pwd)

ours=
if [ "${1:-}" = --library ] && [ $# -gt 1 ]; then
    ours=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
    shift 2
fi
if [ $# -ne 1 ] || [ ! -r "$1" ]; then
    echo "usage: replay.sh FILE (a case that compare.sh --keep DIR wrote)" >&2
    exit 2
fi

if [ -z "$ours" ]; then
    sh "$here/setup.sh" main >&2
    cargo build -q --release --lib --manifest-path "$here/../Cargo.toml" >&2
    ours=$(cd "${CARGO_TARGET_DIR:-$here/../target}/release" && pwd)/libccd.so
fi
mkdir -p "${CARGO_TARGET_DIR:-$here/../target}/compare"
# Not in /tmp, where nothing may be allowed to run.
work=$(mktemp -d "${CARGO_TARGET_DIR:-$here/../target}/compare/run.XXXXXX")
work=$(cd "$work" && pwd)
trap 'rm -rf "$work"' EXIT
ln -s "$ours" "$work/libccd.so.2"
cc -std=c99 -O2 -ffp-contract=off -I"$here/../include" "$1" -o "$work/case" "$work/libccd.so.2" -lm

unset LD_LIBRARY_PATH
theirs=$(ldd "$work/case" | sed -n 's|.*libccd\.so\.2 => \(/.*\) (0x.*|\1|p')
if [ -z "$theirs" ]; then
    echo "== no libccd on this system"
elif grep -q ccdImplementation "$theirs"; then
    echo "== $theirs is this library, installed: no libccd to compare with"
else
    echo "== libccd: $theirs"
    "$work/case" || true
fi
echo "== this library"
LD_LIBRARY_PATH=$work "$work/case"
