#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job: one unmodified C program over a recorded contact sequence, on the
# system's libccd where there is one, and on this library; and the same pairs through
# this library's extension, cold and warm. They take turns, a process a turn, and time is
# that of the process: what else the machine does meets all of them, and counts for none.
# Of each frame the best pass of a turn counts, and of each method the best turn. The last
# line is the verdict. Sets itself up.
#   main.sh readme   writes the table of README.md too

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh main
cargo build --release --lib

release=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)
work=$release/main-job
recording=c-tests/record/contacts.bin
turns=8
passes=4
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

# turn PROGRAM TABLE [LIBRARY]: some passes, of which the table keeps the best times. Its
# lines are otherwise the same in every turn.
turn() {
    LD_LIBRARY_PATH=${3:-} "$work/$1" "$recording" "$passes" >"$work/pass.txt"
    touch "$work/$2"
    awk '
        { time = $NF == "ns" ? $(NF - 1) : $NF }
        FILENAME ~ /pass.txt$/ && (!(FNR in line) || time + 0 < least[FNR] + 0) { line[FNR] = $0 }
        FILENAME !~ /pass.txt$/ { line[FNR] = $0; least[FNR] = time }
        END { for (i = 1; i in line; i++) print line[i] }' "$work/$2" "$work/pass.txt" >"$work/best.txt"
    mv "$work/best.txt" "$work/$2"
}

# show TITLE TABLE
show() {
    printf '\n== %s\n' "$1"
    cat "$work/$2"
}

# A missing function would show at the start.
export LD_BIND_NOW=1
unset LD_LIBRARY_PATH
compile replay
compile warm
rm -f "$work"/*.txt
for program in replay warm; do
    if [ "$(LD_LIBRARY_PATH=$work libccd_of "$work/$program")" != "$work/libccd.so.2" ]; then
        echo "main.sh: $program does not run on this library" >&2
        exit 1
    fi
done
system=$(libccd_of "$work/replay")
# This library, where it is installed before libccd, is nothing to compare with.
if [ -n "$system" ] && grep -q ccdImplementation "$system"; then
    printf '\n== %s is this library, installed: no libccd to compare with\n' "$system"
    system=
elif [ -z "$system" ]; then
    printf '\n== No libccd on this system: this library alone\n'
fi
for _ in $(seq "$turns"); do
    [ -z "$system" ] || turn replay theirs.txt
    turn replay ours.txt "$work"
    turn warm warm.txt "$work"
done
[ -z "$system" ] || show "libccd: $system" theirs.txt
show "This library under the same program" ours.txt
show "Its extension, without and with the state of the pair from the frame before" warm.txt
cat <<'END'

missed    overlaps that are not seen        deep      more than 1 % too deep
false     overlaps that are none            unsound   the move does not separate
broken    NaN or a direction of no length   mean max  errors of the depth
supports  support points a query            ns        a query, best of turns

END

# Prints the wrong answers, the support points and the time of the two calls that answer a depth,
# which a program that exists is most likely to make.
verdict() {
    awk '
        function call(name, before, ratio, word) {
            n = ours SUBSEP name
            m = theirs SUBSEP name
            printf "%s%s: %d of %d answers wrong", before, name, wrong[n], pairs
            if (!(m in ns)) {
                printf ", %.1f supports, %d ns", supports[n], ns[n]
                return
            }
            ratio = ns[n] / ns[m]
            word = "slower"
            if (ratio < 1) { ratio = 1 / ratio; word = "faster" }
            printf " (libccd %d), %.1f supports (%.1f), %.1f x %s", wrong[m], supports[n], supports[m], ratio, word
        }
        $1 == "MPR" || /^GJK [+] EPA / {
            n = FILENAME SUBSEP ($1 == "MPR" ? "MPR" : "GJK + EPA")
            wrong[n] = $(NF - 8) + $(NF - 7) + $(NF - 6) + $(NF - 5) + $(NF - 4)
            supports[n] = $(NF - 1)
            ns[n] = $NF
        }
        / pairs, / { pairs = $5 }
        END {
            ours = ARGV[1]; theirs = ARGV[2]
            call("MPR", "")
            call("GJK + EPA", "; ")
            print ""
        }' "$@"
}

# The table of README.md. A call is faster than libccd's MPR where two support calls
# cost more than the break-even: its longer arithmetic over the support points it saves.
readme_table() {
    awk '
        function row(call, file, name, proven) {
            n = file SUBSEP name
            ratio = ns[n] / ns[base]
            even = "-"
            if (n == base) even = ""
            else if (ratio <= 1) even = "always"
            else if (supports[base] > supports[n])
                even = sprintf("%.2f µs", (price[theirs] + (ns[n] - ns[base]) / (supports[base] - supports[n])) / 1000)
            printf "| %s | %.1f | %.2f | %.2f %% | %s | %s |\n", call, supports[n], ratio, 100 * deep[n] / overlaps, proven, even
        }
        / of them overlap/ { overlaps = $7 }
        NF >= 10 && $(NF - 8) ~ /^[0-9]+$/ {
            name = $1
            for (i = 2; i <= NF - 9; i++) name = name " " $i
            n = FILENAME SUBSEP name
            deep[n] = $(NF - 5); supports[n] = $(NF - 1); ns[n] = $NF
        }
        /^a support point alone/ { price[FILENAME] = $5 }
        END {
            theirs = ARGV[1]; ours = ARGV[2]; warm = ARGV[3]
            base = theirs SUBSEP "MPR"
            print "| call | supports | time over libccd\47s MPR | > 1 % too deep | proven | break-even |"
            print "|---|---|---|---|---|---|"
            row("libccd `ccdMPRPenetration`", theirs, "MPR", "no")
            row("libccd `ccdGJKPenetration`", theirs, "GJK + EPA", "no")
            row("`ccdMPRPenetration`", ours, "MPR", "0.1 %")
            row("`ccdGJKPenetration`", ours, "GJK + EPA", "tolerance")
            row("`ccdMPRPenetrationWarm`", warm, "MPR, warm", "0.1 %")
            row("`ccdMPRPenetration`, `pos` NULL", warm, "no pos, cold", "0.1 %")
            row("`ccdMPRPenetrationWarm`, `pos` NULL", warm, "no pos, warm", "0.1 %")
            row("`ccdPenetrationLocal`, warm", warm, "local, warm", "no")
            row("`ccdPenetrationProven`, warm", warm, "minimum, warm", "tolerance")
        }' theirs.txt ours.txt warm.txt
}

cd "$work"
if [ "${1:-}" = readme ] && [ -e theirs.txt ]; then
    readme_table >table.md
    # Between the two marks stands what this command says.
    awk '/^<!-- main.sh readme -->/ { print; while ((getline line < "table.md") > 0) print line; skip = 1 }
        /^<!-- end -->/ { skip = 0 }
        !skip' "$OLDPWD/README.md" >README.new
    cat README.new >"$OLDPWD/README.md"
fi
if [ -e theirs.txt ]; then verdict ours.txt theirs.txt; else verdict ours.txt; fi
