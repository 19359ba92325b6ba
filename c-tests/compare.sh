#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Try it on your own program: runs it unchanged, puts a share of its libccd queries to libccd,
# to this library and to the proven minimum, and ends with one screen, on stderr.
#   compare.sh [OPTION...] PROGRAM [ARGUMENT...]
#     --every N    judge one query in N (default 10; 0: count them alone, ask nothing)
#     --swap       let the program go on with this library's answers, not libccd's
#     --keep DIR   write the worst wrong answers there, as C files for replay.sh
#     --no-times   take no times: less is asked of the callbacks
#     --libccd F   the libccd to compare with (default: the one that the program gets)
#     --library F  a libccd.so of this library's that is built already (default: built now)
# The program may use libccd itself or through FCL, ODE, MuJoCo 2 or DART. Its exit code is
# this command's; 125: nothing could be run. Sets itself up.

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
theirs=
ours=
fields=
times=1
while [ $# -gt 0 ]; do
    case $1 in
    --swap) base=ours ;;
    --no-times) times=0 ;;
    --fields) fields=1 ;; # for the tables of engines/: one line on stdout
    --every | --keep | --libccd | --library)
        [ $# -ge 2 ] || usage
        case $1 in
        --every) every=$2 ;;
        --keep) keep=$2 ;;
        --libccd) theirs=$2 ;;
        --library) ours=$2 ;;
        esac
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
*) fail "$1: a command of the shell's own, no program" ;;
esac
[ -f "$program" ] || fail "$1: no file"

# A script runs on its interpreter's libraries, which the file does not tell.
linked=unknown
if [ "$(head -c 2 "$program" | tr -d '\0')" != '#!' ]; then
    libraries=$(ldd "$program" 2>&1) || libraries="not a dynamic executable"
    case $libraries in
    *"not a dynamic executable"* | *"statically linked"*)
        fail "$1: not a dynamically linked program of this machine's; libccd within it cannot be watched" ;;
    *libasan.so* | *libtsan.so* | *libmsan.so*)
        fail "$1: compiled with a sanitizer, which forbids to keep two libraries of one name apart" ;;
    *libccd.so.2*"not found"*) fail "$1: its libccd.so.2 is not found; is libccd2 installed?" ;;
    *libccd.so.2*) linked=yes ;;
    *) linked=no ;;
    esac
fi

# --- what is built ---------------------------------------------------------------------

target=${CARGO_TARGET_DIR:-$here/../target}
if [ -z "$ours" ]; then
    sh "$here/setup.sh" main >&2
    cargo build -q --release --lib --manifest-path "$here/../Cargo.toml" >&2
    ours=$target/release/libccd.so
fi
[ -r "$ours" ] || fail "$ours: no file"
mkdir -p "$target/compare"
work=$(cd "$target/compare" && pwd)

# newest OUT IN...: whether OUT is there and no IN is newer
newest() {
    out=$1
    shift
    [ -e "$out" ] && [ -z "$(find "$@" -newer "$out")" ]
}

# build OUT FLAG...: by a name of its own first, for others may be running the old one
build() {
    newest "$work/$1" "$here/tools/compare" "$here/harness" "$here/../include" && return
    out=$1
    shift
    cc -O2 -Wall -Wextra -I"$here" -I"$here/../include" "$@" -o "$work/$out.$$" -lm -ldl -lpthread
    mv "$work/$out.$$" "$work/$out"
}

(
    cd "$here/tools/compare"
    build compare.so -std=gnu99 -shared -fPIC -fexceptions -fvisibility=hidden catch.c query.c judge_query.c write_case.c preload.c
    build screen -std=c99 summary.c
)

# --- the two libraries -----------------------------------------------------------------

# The libccd.so.2 that a program gets, by what the dynamic linker says.
libccd_of() {
    sed -n 's|.*libccd\.so\.2 => \(/.*\) (0x.*|\1|p' | head -n 1
}

if [ -z "$theirs" ]; then
    [ $linked != yes ] || theirs=$(printf '%s\n' "$libraries" | libccd_of)
    # Where the program will find it if it asks for it later.
    [ -n "$theirs" ] || theirs=$(LD_PRELOAD=libccd.so.2 LD_TRACE_LOADED_OBJECTS=1 "$(command -v cat)" 2>/dev/null | libccd_of)
fi
[ -n "$theirs" ] && [ -r "$theirs" ] || fail "no libccd.so.2 to compare with; Debian's package is libccd2"
! grep -q ccdImplementation "$theirs" || fail "$theirs is this library, installed: name a libccd with --libccd FILE"

# Not in /tmp, where nothing may be allowed to run.
counts=$(mktemp -d "$work/run.XXXXXX")
trap 'rm -rf "$counts"' EXIT
cp -L "$theirs" "$counts/theirs.so"
cp -L "$ours" "$counts/ours.so"
cp "$counts/ours.so" "$counts/libccd.so.2" # for the program itself
if [ -n "$keep" ]; then
    mkdir -p "$keep"
    keep=$(cd "$keep" && pwd)
    rm -f "$keep"/libccd-[0-9].c "$keep"/warmccd-[0-9].c # of an earlier run
fi

# --- the run ---------------------------------------------------------------------------

# LD_PRELOAD is split at blanks and colons, which a path may have.
links=$(mktemp -d)
trap 'rm -rf "$counts" "$links"' EXIT
ln -s "$work/compare.so" "$counts/libccd.so.2" "$links"
preload=$links/compare.so
# Its name is libccd.so.2: the program gets it for its own.
[ "$base" = theirs ] || preload="$preload $links/libccd.so.2"
shift
code=0
# Interrupted, the program ends and the screen comes.
trap : INT
env CCD_COMPARE_DIR="$counts" CCD_COMPARE_THEIRS="$counts/theirs.so" CCD_COMPARE_NAME="$theirs" CCD_COMPARE_OURS="$counts/ours.so" \
    CCD_COMPARE_BASE="$base" CCD_COMPARE_EVERY="$every" CCD_COMPARE_TIMES="$times" CCD_COMPARE_KEEP="$keep" CCD_COMPARE_CASE="$here" \
    LD_PRELOAD="$preload${LD_PRELOAD:+ $LD_PRELOAD}" "$program" "$@" || code=$?
trap - INT

if [ -n "$fields" ]; then
    "$work/screen" "$counts" fields || true
elif ! "$work/screen" "$counts" "$every" "$code" "$keep" >&2; then
    case $linked in
    no) echo "compare.sh: $program asked libccd nothing: it is not linked to libccd.so.2 and did not load it" >&2 ;;
    *) echo "compare.sh: $program asked libccd nothing in this run" >&2 ;;
    esac
fi
exit "$code"
