#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs five of ODE's own demos on Debian's libode without drawing (3 minutes), on libccd's answers, one query in ten judged,
# of which this library must have none wrong. Prints the figures, which differ from run to run: the demos do.
#   ode_demos.sh           ODE's source is fetched by `apt-get source`
#   ODE_SOURCE=DIR ode_demos.sh   it is there, ODE 0.16

set -eu
cd "$(dirname "$0")/../.."
mkdir -p target/c-tests/ode-demos
work=$(cd target/c-tests/ode-demos && pwd)

# shellcheck source=c-tests/lab/debian_source.sh
. c-tests/lab/debian_source.sh
sh c-tests/setup.sh >&2
cargo build --release --lib >&2
library=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)/libccd.so
demos="moving_convex boxstack motion heightfield trimesh"
# shellcheck disable=SC2086  # one word per demo
ode_demos "$work" $demos

# What the keys drop: v a hull, y a cylinder, c a capsule, b a box, x a composite.
export DEMO_STEPS=1500 DEMO_KEYS=vyvcyvxbyvcyvcyvcyvcyvcyvcyvcyvccyy
failed=0
for demo in $demos; do
    sh c-tests/compare.sh --every 10 --no-times --library "$library" "$work/demo_$demo" >"$work/$demo.out" 2>"$work/$demo.screen"
done
# The rows of the table of answers: missed, false, broken, over 1 %, unsound.
for who in libccd "this library"; do
    for demo in $demos; do
        awk -v who="$who" '/missed  false/ { table = 1 } table && index($0, who) == 1 { sub(who, ""); print }' "$work/$demo.screen"
    done | awk -v who="$who" '{ missed += $1; spurious += $2; wrong += $1 + $2 + $3 + $4 + $5 }
        END { printf "%s: %d missed, %d false, %d wrong in all\n", who, missed, spurious, wrong; exit NR != 5 || (who != "libccd" && wrong) }' || failed=1
done
cat "$work"/*.screen | awk '/^ccd.*%/ { gsub(",", ""); n += $2; judged += $5 } END { printf "%d queries, %d of them judged\n", n, judged }'
exit $failed
