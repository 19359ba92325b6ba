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
#     --runs N     then run the program N times on each library, in turn, without all this, and compare its times
#     --limit S    end each run after S seconds (default with --runs: 120): some programs hang on libccd
#     --no-times   time no queries: fewer calls of the callbacks
#     --libccd F   the libccd to compare with (default: the program's, also one in a Python wheel; else the system's)
#     --library F  a built libccd.so of this library (default: built now)
#     --recorder D  a folder with this script's own programs (default: compiled now)
# The program may use libccd itself or through FCL, ODE, MuJoCo 2 or DART, or load it later, as in `compare.sh python
# app.py`. Its exit code is this command's; 124: it did not end in time; 125: it could not be run. Runs setup.sh itself.

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
runs=0
limit=
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
    --every | --runs | --limit | --keep | --libccd | --library | --recorder)
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
for number in "--every $every" "--runs $runs" "--limit ${limit:-1}"; do
    case ${number#* } in
    '' | *[!0-9]*) fail "${number%% *} takes a number, not '${number#* }'" ;;
    esac
done
[ "${limit:-1}" -gt 0 ] || fail "--limit takes at least 1 second"
[ "$runs" -eq 0 ] || limit=${limit:-120}

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
loaded=0 # 1: one that the program loads later, if it does, is its own
if [ -z "$libccd" ]; then
    [ $linked = yes ] || loaded=1
    [ $linked != yes ] || libccd=$(printf '%s\n' "$libraries" | loaded_libccd)
    [ -n "$libccd" ] || libccd=$(system_libccd)
    libccd=$(other_libccd "$libccd")
fi
[ -r "$libccd" ] || [ $loaded = 1 ] || fail "no libccd.so.2 to compare with; Debian's package is libccd2"
[ -z "$libccd" ] || ! grep -q ccdImplementation "$libccd" || fail "$libccd is this library, installed: name a libccd with --libccd FILE"

# Not in /tmp, which may be mounted noexec, unless this folder is another user's.
counts=$(mktemp -d "$work/run.XXXXXX" 2>/dev/null) || counts=$(mktemp -d)
trap 'rm -rf "$counts"' EXIT
[ -z "$libccd" ] || cp -L "$libccd" "$counts/theirs.so"
cp -L "$library" "$counts/ours.so"
if [ -n "$keep" ]; then
    mkdir -p "$keep"
    keep=$(cd "$keep" && pwd)
    rm -f "$keep"/libccd-*.txt "$keep"/warmccd-*.txt # of an earlier run
fi

# --- the run ---------------------------------------------------------------------------

# LD_PRELOAD is split at blanks and colons, which a path may have, TMPDIR's too.
links=$(TMPDIR=/tmp mktemp -d)
trap 'rm -rf "$counts" "$links"' EXIT
ln -s "$work/compare.so" "$links"
# on SIDE FILE: makes a library ready to be preloaded; under the name libccd.so.2 it replaces the program's own
on() {
    mkdir "$counts/$1" "$links/$1"
    cp -L "$2" "$counts/$1/libccd.so.2"
    ln -s "$counts/$1/libccd.so.2" "$links/$1"
}
on ours "$library"
preload=$links/compare.so
[ "$base" = theirs ] || preload="$preload $links/ours/libccd.so.2"
shift

# limited COMMAND...: runs it, if there is a limit in a process group of its own that ends with it, and sets `code`. An
# interrupt ends the program, not this script, which prints the screen.
limited() {
    code=0
    if [ -z "$limit" ]; then
        trap : INT
        "$@" || code=$?
    else
        timeout -k 5 "$limit" "$@" <&3 3<&- &
        run=$!
        trap 'stopped=1; kill "$run"' INT
        wait "$run" || code=$?
        # The interrupt ended the waiting alone.
        [ -z "$stopped" ] || wait "$run" || code=$?
    fi
    trap - INT
}

stopped=
if [ -n "$limit" ]; then
    if [ -t 0 ]; then exec 3</dev/null; else exec 3<&0; fi # that group may not read from the terminal
fi
limited env CCD_COMPARE_DIR="$counts" CCD_COMPARE_THEIRS="${libccd:+$counts/theirs.so}" CCD_COMPARE_NAME="$libccd" \
    CCD_COMPARE_LOADED="$loaded" CCD_COMPARE_OURS="$counts/ours.so" CCD_COMPARE_BASE="$base" CCD_COMPARE_EVERY="$every" CCD_COMPARE_TIMES="$times" \
    CCD_COMPARE_KEEP="$keep" LD_PRELOAD="$preload${LD_PRELOAD:+ $LD_PRELOAD}" "$program" "$@"
own_code=$code

# measure SIDE ARGUMENT...: runs the program on a library and notes its exit code and nanoseconds; not once more where it
# did not end
measure() {
    side=$1
    shift
    ! grep -q "^$side \(124\|137\) " "$counts/runs" || return 0
    start=$(date +%s%N)
    limited env LD_PRELOAD="$links/$side/libccd.so.2${LD_PRELOAD:+ $LD_PRELOAD}" "$program" "$@" >/dev/null 2>&1
    [ -n "$stopped" ] || echo "$side $code $(($(date +%s%N) - start))" >>"$counts/runs"
}

: >"$counts/runs"
i=0
[ -e "$counts/counts" ] || runs=0
if [ "$runs" -gt 0 ]; then
    on theirs "$("$work/screen" "$counts" libccd)"
    echo "compare.sh: $runs runs on each library, each for at most $limit s" >&2
fi
while [ $i -lt "$runs" ] && [ -z "$stopped" ]; do
    # Each is the first of two in turn.
    for side in $([ $((i % 2)) -eq 0 ] && echo theirs ours || echo ours theirs); do
        [ -n "$stopped" ] || measure "$side" "$@"
    done
    i=$((i + 1))
done

if [ -n "$fields" ]; then
    "$work/screen" "$counts" fields || true
elif ! "$work/screen" "$counts" "$every" "$own_code" "$keep" "${limit:-0}" >&2; then
    case $linked in
    no) echo "compare.sh: $program did not query libccd: it is not linked to libccd.so.2 and did not load it" >&2 ;;
    *) echo "compare.sh: $program did not query libccd in this run" >&2 ;;
    esac
fi
exit "$own_code"
