#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs libccd's own test suite, unchanged, on Debian's libccd, of which all must pass, and on this library (a minute after
# the build). Prints the assertions that fail here, and fails unless they are those known here: touches, which are misses,
# and separations that are compared to the last bit.
#   libccd_tests.sh                     libccd's source is fetched by `apt-get source`
#   LIBCCD_SOURCE=DIR libccd_tests.sh   it is there, libccd 2.1

set -eu
cd "$(dirname "$0")/../.."
mkdir -p target/c-tests/libccd-tests
work=$(cd target/c-tests/libccd-tests && pwd)
# shellcheck source=c-tests/lab/debian_source.sh
. c-tests/lab/debian_source.sh
source=${LIBCCD_SOURCE:-$work/source}
[ -n "${LIBCCD_SOURCE:-}" ] || [ -d "$source/src/testsuites" ] || debian_source libccd "$work"
tests=$source/src/testsuites

# --- build -----------------------------------------------------------------------------

sh c-tests/setup.sh >&2
cargo build --release --lib >&2
mkdir -p "$work/ours" "$work/include/ccd" "$work/regressions"
ln -sf "$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)/libccd.so" "$work/ours/libccd.so.2"
# What libccd's CMake makes of config.h.cmake.in.
cp include/ccd/config.h "$work/include/ccd"
(
    cd "$tests"
    "${CC:-cc}" -std=gnu99 -O1 -w -DCU_ENABLE_TIMER -I"$work/include" -I"$source/src" -I. main.c common.c support.c vec3.c polytope.c \
        boxbox.c spheresphere.c cylcyl.c boxcyl.c mpr_boxbox.c mpr_cylcyl.c mpr_boxcyl.c cu/cu.c -lccd -lm -o "$work/suite"
)

# --- run -------------------------------------------------------------------------------

cd "$work" # the suite writes into the folder regressions
./suite >libccd.txt 2>&1
LD_LIBRARY_PATH=$work/ours ./suite >ours.txt 2>&1
grep -E 'is not true$|^\| assertations' ours.txt | sed 's|.*/testsuites/||'
grep -q '^| assertations: |       0  |     2419 ' libccd.txt
for test in TSBoxBox::boxboxSeparate TSMPRBoxBox::mprBoxboxSeparate; do
    grep -F "($test)" ours.txt
done >known.txt
[ "$(grep -c 'ccdVec3Eq(&sep, &expsep)' known.txt)" -eq 8 ] && [ "$(grep -c 'res == 0' known.txt)" -eq 2 ]
grep -q '^| assertations: |      10  |     2409 ' ours.txt
