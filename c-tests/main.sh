#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job: one unmodified C program over a recorded contact sequence, first
# on the system's libccd where there is one, then on this library; then the same
# pairs through this library's extension, cold and warm. Times are those of the best
# of several passes. The last line is the verdict. Sets itself up.

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh main
cargo build --release --lib

release=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)
work=$release/main-job
recording=c-tests/record/contacts.bin
passes=5
mkdir -p "$work"
# LD_LIBRARY_PATH needs the file under the name that programs ask for.
ln -sf "$release/libccd.so" "$work/libccd.so.2"

compile() {
    cc -std=c99 -O2 -Iinclude -Ic-tests -DOURS_ALONE "c-tests/record/$1.c" -o "$work/$1" \
        "$work/libccd.so.2" -lm
}

# The libccd.so.2 that the dynamic linker gives the program.
libccd_of() {
    ldd "$1" | sed -n 's|.*libccd\.so\.2 => \(/[^ ]*\).*|\1|p'
}

# run PROGRAM TABLE: prints what it writes, and keeps it
run() {
    "$work/$1" "$recording" "$passes" >"$work/$2"
    cat "$work/$2"
}

run_on_ours() {
    export LD_LIBRARY_PATH="$work"
    if [ "$(libccd_of "$work/$1")" != "$work/libccd.so.2" ]; then
        echo "main.sh: $1 does not run on this library" >&2
        exit 1
    fi
    run "$1" "$2"
    unset LD_LIBRARY_PATH
}

# A missing function would show at the start.
export LD_BIND_NOW=1
unset LD_LIBRARY_PATH
compile replay
compile warm
rm -f "$work/theirs.txt"
system=$(libccd_of "$work/replay")
# This library, where it is installed before libccd, is nothing to compare with.
if [ -n "$system" ] && grep -q ccdImplementation "$system"; then
    printf '\n== %s is this library, installed: no libccd to compare with\n' "$system"
elif [ -n "$system" ]; then
    printf '\n== libccd: %s\n' "$system"
    run replay theirs.txt
else
    printf '\n== No libccd on this system: this library alone\n'
fi
printf '\n== This library under the same program\n'
run_on_ours replay ours.txt
printf '\n== Its extension, without and with the state of the pair from the frame before\n'
run_on_ours warm warm.txt
cat <<'END'

missed    overlaps that are not seen        deep      more than 1 % too deep
false     overlaps that are none            unsound   the move does not separate
broken    NaN or a direction of no length   mean max  errors of the depth
supports  support points a query            ns        a query, best of all passes

END

# The wrong answers, the support points and the time of MPR, which a program that
# exists is most likely to call.
verdict() {
    awk '
        $1 == "MPR" { wrong[FILENAME] = $2 + $3 + $4 + $5 + $6; supports[FILENAME] = $9; ns[FILENAME] = $10 }
        / pairs, / { pairs = $5 }
        END {
            ours = ARGV[1]; theirs = ARGV[2]
            printf "MPR: %d of %d answers wrong", wrong[ours], pairs
            if (!(theirs in ns)) {
                printf ", %.1f supports, %d ns\n", supports[ours], ns[ours]
                exit
            }
            ratio = ns[ours] / ns[theirs]
            word = "slower"
            if (ratio < 1) { ratio = 1 / ratio; word = "faster" }
            printf " (libccd %d), %.1f supports (%.1f), %.1f x %s\n", wrong[theirs], supports[ours], supports[theirs], ratio, word
        }' "$@"
}
cd "$work"
if [ -e theirs.txt ]; then verdict ours.txt theirs.txt; else verdict ours.txt; fi
