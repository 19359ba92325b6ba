#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Repeats a query that compare.sh wrote, on libccd and on this library.
#   replay.sh [--library F] [--trace] FILE
#     --library F   a built libccd.so of this library
#     --trace       print each direction that this library evaluates, and the end of the query, on stderr
# Exit code 0: this library's answer is right; 1: wrong.

set -eu
here=$(cd "$(dirname "$0")" && pwd)

library=
features=
while [ $# -gt 1 ]; do
    case $1 in
    --library)
        library=$(realpath "$2")
        shift
        ;;
    --trace) features=trace ;;
    *) break ;;
    esac
    shift
done
if [ $# -ne 1 ] || [ ! -r "$1" ]; then
    echo "usage: replay.sh [--library F] [--trace] FILE (a case that compare.sh --keep DIR wrote)" >&2
    exit 2
fi
target=${CARGO_TARGET_DIR:-$here/../target}
if [ -z "$library" ]; then
    sh "$here/setup.sh" main >&2
    # A folder of its own: the library that a program links has no trace.
    [ -z "$features" ] || target=$target/trace
    cargo build -q --release --lib --features "$features" --target-dir "$target" --manifest-path "$here/../Cargo.toml" >&2
    library=$(realpath "$target/release/libccd.so")
fi
mkdir -p "$target/compare"
# Not in /tmp, which may be mounted noexec.
work=$(realpath "$(mktemp -d "$target/compare/run.XXXXXX")")
trap 'rm -rf "$work"' EXIT
cc -O2 -ffp-contract=off -I"$here" -I"$here/../include" "$here/tools/compare/replay_case.c" "$here/tools/compare/query.c" \
    -o "$work/replay_case" -lm -ldl

# shellcheck source=c-tests/tools/libccd.sh
. "$here/tools/libccd.sh"
libccd=$(other_libccd "$(system_libccd)")
if [ -z "$libccd" ]; then
    echo "== no libccd on this system"
else
    echo "== libccd: $libccd"
    "$work/replay_case" "$1" "$libccd" libccd || true
fi
echo "== this library"
"$work/replay_case" "$1" "$library" warmccd
