#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a program unchanged, puts a share of its libccd queries to libccd,
# to this library and to the proven minimum, and prints one screen on stderr.
#   compare.sh [OPTION...] PROGRAM [ARGUMENT...]
#     --every N    judge one query in N (default 10; 0: only count them)
#     --swap       give the program this library's answers, not libccd's
#     --keep DIR   write the worst wrong answers there, as files for replay.sh
#     --no-times   measure no times: fewer calls of the callbacks
#     --libccd F   the libccd to compare with (default: the program's; where that is this library, the system's)
#     --library F  a built libccd.so of this library (default: built now)
#     --recorder D  a folder with this script's own programs (default: compiled now)
# The program may use libccd itself or through FCL, ODE, MuJoCo 2 or DART, or load it later, as in `compare.sh python
# app.py`. Its exit code is this command's; 125: the program could not be run. Runs setup.sh itself.

set -eu
here=$(cd "$(dirname "$0")" && pwd)

fail() {
    echo "compare.sh: $*" >&2
    exit 125
}

usage() {
    sed -n 's/^#   \(compare.sh.*\)/usage: \1/p; s/^#     \(--.*\)/  \1/p' "$here/compare.sh" >&2
    exit 125
}

every=10
base=theirs
keep=
libccd=
library=
recorder=
fields=
to_build=
times=1
while [ $# -gt 0 ]; do
    case $1 in
    --swap) base=ours ;;
    --no-times) times=0 ;;
    --fields) fields=1 ;; # for the tables of engines/: one line on stdout
    --every | --keep | --libccd | --library | --recorder)
        [ $# -ge 2 ] || usage
        eval "${1#--}=\$2"
        shift
        ;;
    --)
        shift
        break
        ;;
    -*) usage ;;
    *) break ;;
    esac
    shift
done
[ $# -gt 0 ] || usage
case $every in
'' | *[!0-9]*) fail "--every takes a number, not '$every'" ;;
esac

program=$(command -v -- "$1") || fail "$1: no such program"
case $program in
*/*) ;;
*) fail "$1: a builtin of the shell, no program" ;;
esac
[ -f "$program" ] || fail "$1: no file"

# A script has its interpreter's libraries, which the file does not name.
linked=unknown
if [ "$(head -c 2 "$program" | tr -d '\0')" != '#!' ]; then
    libraries=$(ldd "$program" 2>&1) || libraries="not a dynamic executable"
    case $libraries in
    *"not a dynamic executable"* | *"statically linked"*)
        fail "$1: not a dynamically linked program of this machine's; its libccd cannot be replaced" ;;
    *libasan.so* | *libtsan.so* | *libmsan.so*)
        fail "$1: compiled with a sanitizer, which does not allow two libraries of one name" ;;
    *libccd.so.2*"not found"*) fail "$1: its libccd.so.2 is not found; is libccd2 installed?" ;;
    *libccd.so.2*) linked=yes ;;
    *) linked=no ;;
    esac
fi

# --- build -----------------------------------------------------------------------------

target=${CARGO_TARGET_DIR:-$here/../target}
if [ -z "$library" ]; then
    sh "$here/setup.sh" compare >&2
    # Not quietly: cargo says when it waits for another build.
    cargo build --release --lib --manifest-path "$here/../Cargo.toml" >&2
    library=$target/release/libccd.so
fi
[ -r "$library" ] || fail "$library: no file"
if [ -z "$recorder" ]; then
    mkdir -p "$target/compare"
    recorder=$target/compare
    to_build=1
fi
work=$(cd "$recorder" && pwd)

# build COMPILER OUT FLAG...: unless OUT is newer than all sources; under a name of its own first, for others may be
# running the old one
build() {
    compiler=$1 out=$2
    shift 2
    [ -e "$work/$out" ] && [ -z "$(find "$here/compare.sh" "$here/tools/compare" "$here/harness" "$here/../include" -newer "$work/$out")" ] && return
    "$compiler" -O2 -Wall -Wextra -I"$here" -I"$here/../include" "$@" -o "$work/$out.$$"
    mv "$work/$out.$$" "$work/$out"
}

[ -z "$to_build" ] || (
    cd "$here/tools/compare"
    build c++ catch.o -c -fPIC -fvisibility=hidden catch.cpp
    build cc compare.so -shared -fPIC -fexceptions -fvisibility=hidden "$work/catch.o" query.c judge_query.c write_case.c preload.c -lstdc++ -lm -ldl -lpthread
    build cc screen summary.c -lm
)

# --- the two libraries -----------------------------------------------------------------

# shellcheck source=c-tests/tools/libccd.sh
. "$here/tools/libccd.sh"
if [ -z "$libccd" ]; then
    [ $linked != yes ] || libccd=$(printf '%s\n' "$libraries" | loaded_libccd)
    [ -n "$libccd" ] || libccd=$(system_libccd)
    libccd=$(other_libccd "$libccd")
fi
[ -n "$libccd" ] && [ -r "$libccd" ] || fail "no libccd.so.2 to compare with; Debian's package is libccd2"
! grep -q ccdImplementation "$libccd" || fail "$libccd is this library, installed: name a libccd with --libccd FILE"

# Not in /tmp, which may be mounted noexec, unless this folder is another user's.
counts=$(mktemp -d "$work/run.XXXXXX" 2>/dev/null) || counts=$(mktemp -d)
trap 'rm -rf "$counts"' EXIT
cp -L "$libccd" "$counts/theirs.so"
cp -L "$library" "$counts/ours.so"
cp "$counts/ours.so" "$counts/libccd.so.2" # for the program itself
if [ -n "$keep" ]; then
    mkdir -p "$keep"
    keep=$(cd "$keep" && pwd)
    rm -f "$keep"/libccd-*.txt "$keep"/warmccd-*.txt # of an earlier run
fi

# --- the run ---------------------------------------------------------------------------

# LD_PRELOAD is split at blanks and colons, which a path may have.
links=$(mktemp -d)
trap 'rm -rf "$counts" "$links"' EXIT
ln -s "$work/compare.so" "$counts/libccd.so.2" "$links"
preload=$links/compare.so
# Under its name libccd.so.2 it replaces the program's own.
[ "$base" = theirs ] || preload="$preload $links/libccd.so.2"
shift
code=0
# An interrupt ends the program, not this script, which prints the screen.
trap : INT
env CCD_COMPARE_DIR="$counts" CCD_COMPARE_THEIRS="$counts/theirs.so" CCD_COMPARE_NAME="$libccd" CCD_COMPARE_OURS="$counts/ours.so" \
    CCD_COMPARE_BASE="$base" CCD_COMPARE_EVERY="$every" CCD_COMPARE_TIMES="$times" CCD_COMPARE_KEEP="$keep" \
    LD_PRELOAD="$preload${LD_PRELOAD:+ $LD_PRELOAD}" "$program" "$@" || code=$?
trap - INT

if [ -n "$fields" ]; then
    "$work/screen" "$counts" fields || true
elif ! "$work/screen" "$counts" "$every" "$code" "$keep" >&2; then
    case $linked in
    no) echo "compare.sh: $program did not query libccd: it is not linked to libccd.so.2 and did not load it" >&2 ;;
    *) echo "compare.sh: $program did not query libccd in this run" >&2 ;;
    esac
fi
exit "$code"
