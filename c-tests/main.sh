#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# The main job: one unmodified C program over a recorded contact sequence, on the system's libccd, if there is one, and on
# this library; and the same pairs through this library's extension, cold and warm. Each run is a process, the runs take
# turns, and time is processor time: the best of each frame's passes and of each method's turns. At last come the table of
# README.md and the number of wrong results. Sets itself up.
#   main.sh readme   also writes the table into it

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh main
cargo build --release --lib

release=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)
work=$release/main-job
recording=c-tests/tools/record/contacts.bin
turns=${TURNS:-8}
passes=4
mkdir -p "$work"
# LD_LIBRARY_PATH needs the file under the name that programs ask for.
ln -sf "$release/libccd.so" "$work/libccd.so.2"

# shellcheck source=c-tests/tools/libccd.sh
. c-tests/tools/libccd.sh

# turn PROGRAM TABLE FOLDER: appends a run on the libccd.so.2 in a folder to the table's file
turn() {
    LD_LIBRARY_PATH=$3 "$work/$1" "$recording" "$passes" >>"$work/$2"
}

# Reads tables: figures by file and method, with the best times of all turns; line holds the last table with these times.
figures='
    function least(of, key, time) {
        if (!(key in of) || time + 0 < of[key] + 0) of[key] = time
        return of[key]
    }
    / of them overlap/ { pairs = $5; overlaps = $7; lines = 0 }
    /^a support point alone/ { $5 = least(cost, FILENAME, $5) }
    NF > 11 && $NF ~ /^[0-9]+$/ { # a method: a name of 17 columns, then 11 figures
        name = substr($0, 1, 17)
        sub(/ +$/, "", name)
        n = FILENAME SUBSEP name
        wrong[n] = $(NF - 10) + $(NF - 9) + $(NF - 8) + $(NF - 7) + $(NF - 6) + $(NF - 5)
        supports[n] = $(NF - 2)
        $0 = sprintf("%s %5s %5s", substr($0, 1, length($0) - 12), least(hit, n, $(NF - 1)), least(ns, n, $NF))
    }
    { line[++lines] = $0 }
    # Returns the cost of a support point (a call of both support functions) above which a method is faster than one
    # that needs more of them: its additional time over the support points that it saves.
    function breakeven(n, base) {
        if (ns[n] <= ns[base]) return "always"
        if (supports[base] <= supports[n]) return "never"
        return sprintf("%.2f µs", (cost[ARGV[1]] + (ns[n] - ns[base]) / (supports[base] - supports[n])) / 1000)
    }'

# show TITLE TABLE
show() {
    printf '\n== %s\n' "$1"
    awk "$figures"' END { for (i = 1; i <= lines; i++) print line[i] }' "$work/$2"
}

# A missing function would show at the start.
export LD_BIND_NOW=1
unset LD_LIBRARY_PATH
rm -f "$work"/*.txt
for program in replay replay_extension; do
    flag=-DOURS_ALONE
    [ $program = replay_extension ] || flag=-UOURS_ALONE
    cc -std=c99 -O2 -Iinclude -Ic-tests $flag c-tests/tools/record/replay.c -o "$work/$program" "$work/libccd.so.2" -lm
    if [ "$(LD_LIBRARY_PATH=$work ldd "$work/$program" | loaded_libccd)" != "$work/libccd.so.2" ]; then
        echo "main.sh: $program does not run on this library" >&2
        exit 1
    fi
done
system=$(other_libccd "$(ldd "$work/replay" | loaded_libccd)")
if [ -n "$system" ]; then
    mkdir -p "$work/theirs"
    ln -sf "$system" "$work/theirs/libccd.so.2"
else
    printf '\n== No libccd on this system: this library alone\n'
fi
for _ in $(seq "$turns"); do
    [ -z "$system" ] || turn replay theirs.txt "$work/theirs"
    turn replay ours.txt "$work"
    turn replay_extension warm.txt "$work"
done
# shellcheck source=/dev/null
machine=$(. /etc/os-release 2>/dev/null && echo "${NAME%% *} ${VERSION_ID:-}")
machine="$machine, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
printf '\n== On %s\n' "$machine"
[ -z "$system" ] || show "libccd: $system" theirs.txt
show "This library under the same program" ours.txt
show "Its extension, without and with the state of the pair from the frame before" warm.txt
cat <<'END'

missed    overlaps that are not found       deep      more than 1 % too deep
false     pairs apart that are hits         unsound   the move does not separate
broken    NaN or a direction of no length   dir       the depth along it is so much above the least
supports  support points a query: one call of both support functions each; mean max: errors of the depth
hit ns    nanoseconds a query of the pairs that overlap, and of all; best of turns

END

# Prints the table of README.md.
readme_table() {
    awk "$figures"'
        function row(call, file, name, proven) {
            n = file SUBSEP name
            even = n == base ? "" : breakeven(n, base)
            share = wrong[n] ? sprintf("%.2f %%", 100 * wrong[n] / pairs) : "0"
            printf "| %s | %s | %s | %.1f | %.2f | %.2f | %s |\n", call, share, proven, supports[n],
                   ns[n] / ns[base], hit[n] / hit[base], even
        }
        END {
            theirs = ARGV[1]; ours = ARGV[2]; warm = ARGV[3]
            base = theirs SUBSEP "MPR"
            print "| call | wrong | error of the depth, at most | support points | time | time, overlapping | break-even |"
            print "|---|---|---|---|---|---|---|"
            row("libccd `ccdMPRPenetration`", theirs, "MPR", "unbounded")
            row("libccd `ccdGJKPenetration`", theirs, "GJK + EPA", "unbounded")
            row("the same, `epa_tolerance` 1e-12", theirs, "GJK + EPA, 1e-12", "unbounded")
            row("`ccdMPRPenetration`", ours, "MPR", "0.1 %")
            row("`ccdMPRPenetration`, `pos` NULL", warm, "MPR, no pos", "0.1 %")
            row("`ccdMPRPenetrationWarm`", warm, "MPR, warm", "0.1 %")
            row("`ccdMPRPenetrationWarm`, `pos` NULL", warm, "MPR, warm, no pos", "0.1 %")
            row("`ccdGJKPenetration`", ours, "GJK + EPA", "tolerance")
        }' theirs.txt ours.txt warm.txt
    printf '\n%s.\n' "$machine"
}

# verdict FILE...: prints the last line, of libccd's table, if there is one, and of this library's
verdict() {
    awk "$figures"'
        END {
            printf "Wrong results of ccdMPRPenetration: "
            for (i = 1; i < ARGC; i++)
                printf "%d with %s%s", wrong[ARGV[i] SUBSEP "MPR"], ARGV[i] == "ours.txt" ? "this library" : "libccd",
                       i < ARGC - 1 ? ", " : ".\n"
        }' "$@"
}

cd "$work"
if [ -e theirs.txt ]; then
    readme_table | tee table.md
    if [ "${1:-}" = readme ]; then
        awk '/^<!-- main.sh readme -->/ { print; while ((getline line < "table.md") > 0) print line; skip = 1 }
            /^<!-- end -->/ { skip = 0 }
            !skip' "$OLDPWD/README.md" >README.new
        cat README.new >"$OLDPWD/README.md"
    fi
    printf '\n'
    verdict theirs.txt ours.txt
else
    verdict ours.txt
fi
