#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs FCL's own test programs of distance and collision, unchanged and on Debian's libfcl, on libccd, on this library, and
# with libwarmccd-fcl.so preloaded (5 minutes). Prints a row for each assertion that fails on some of them, with
# who is right; one that is not known here fails.
#   fcl_tests.sh           FCL's source is fetched by `apt-get source`
#   FCL_SOURCE=DIR fcl_tests.sh   it is there, FCL 0.7

set -eu
cd "$(dirname "$0")/../.."
mkdir -p target/c-tests/fcl-tests
work=$(cd target/c-tests/fcl-tests && pwd)

# shellcheck source=c-tests/lab/debian_source.sh
. c-tests/lab/debian_source.sh
source=${FCL_SOURCE:-$work/source}
[ -n "${FCL_SOURCE:-}" ] || [ -d "$source/test" ] || debian_source fcl "$work"
tests=$(cd "$source/test" && pwd)
[ -d "$tests/gtest" ] || { echo "fcl_tests.sh: $source is no source of FCL 0.7" >&2; exit 2; }

# --- build -----------------------------------------------------------------------------

sh c-tests/setup.sh >&2
cmake -S cmake -B "$work/build" -DCCD_FCL=ON -DCCD_CARGO_TARGET_DIR="$PWD/target/c-tests/library" >&2
cmake --build "$work/build" >&2

mkdir -p "$work/fcl_resources"
sed "s|@TEST_RESOURCES_SRC_DIR@|$tests/fcl_resources|" "$tests/fcl_resources/config.h.in" >"$work/fcl_resources/config.h"
flags="-O1 -w -std=c++14 -isystem/usr/include/eigen3"
for name in TEST FAIL SUCCEED ASSERT_EQ ASSERT_NE ASSERT_LE ASSERT_LT ASSERT_GE ASSERT_GT; do
    flags="$flags -DGTEST_DONT_DEFINE_$name=1"
done
# compile OUT SOURCE ARGUMENT...: unless it is there
compile() {
    out=$work/$1 file=$tests/$2
    shift 2
    # shellcheck disable=SC2086  # one word each
    [ "$out" -nt "$file" ] || "${CXX:-c++}" $flags -I"$work" -I"$tests" -I"$tests/gtest" -I"$tests/gtest/include" "$file" "$@" -o "$out"
}
compile gtest.o gtest/src/gtest-all.cc -c
compile utility.o test_fcl_utility.cpp -c
algorithm=narrowphase/detail/convexity_based_algorithm
programs=
for file in test_fcl_signed_distance $algorithm/test_gjk_libccd-inl_signed_distance test_fcl_geometric_shapes test_fcl_distance \
    test_fcl_collision test_fcl_sphere_capsule test_fcl_capsule_box_1 test_fcl_capsule_box_2 test_fcl_capsule_capsule \
    test_fcl_cylinder_half_space test_fcl_box_box narrowphase/detail/test_collision_func_matrix; do
    program=${file##*/}
    programs="$programs $program"
    compile "$program" "$file.cpp" "$work/gtest.o" "$work/utility.o" -lfcl -lccd -loctomap -loctomath -lpthread
done

# --- run -------------------------------------------------------------------------------

# failures LIBRARY: prints `test file:line count` for each assertion that fails
failures() {
    for program in $programs; do
        status=0
        timeout 300 "$work/$program" >"$work/$program.$1" 2>&1 || status=$?
        [ "$status" -le 1 ] || echo "$program exit $status"
        sed -n 's/^\[ RUN  *\] /test /p; s/^\([^ ]*:[0-9]*\): Failure.*/at \1/p' "$work/$program.$1" |
            awk '$1 == "test" { name = $2 } $1 == "at" { n[name " " $2]++ } END { for (key in n) print key, n[key] }'
    done | sed 's|[^ ]*/\(test_[^ ]*:[0-9]\)|\1|' | sort >"$work/failures.$1"
}
failures libccd
libraries=$work/build/lib
(export LD_LIBRARY_PATH="$libraries" && failures ours)
(export LD_LIBRARY_PATH="$libraries" LD_PRELOAD=libwarmccd-fcl.so && failures preloaded)
ldd "$work/test_fcl_distance" | grep -q libccd.so.2 || { echo "fcl_tests.sh: not linked to libccd" >&2; exit 1; }

# who_is_right TEST
who_is_right() {
    case $1 in
    FCL_GEOMETRIC_SHAPES.shapeIntersection_conecone | FCL_GEOMETRIC_SHAPES.shapeIntersection_cylindercone)
        echo "this library: the least depth, along the normal of the cone's side, is 0.1 cos 26.6° = 0.0894, FCL expects 0.1 along x" ;;
    FCL_GEOMETRIC_SHAPES.shapeIntersection_cylindercylinder)
        echo "libccd, by 1e-8: directions are tilted by so much, FCL's limit is 1e-9" ;;
    *) echo "unknown" ;;
    esac
}

echo '| assertion | failures on libccd | here | and preloaded | right |'
echo '|---|---|---|---|---|'
cut -d' ' -f1,2 "$work"/failures.libccd "$work"/failures.ours "$work"/failures.preloaded | sort -u | while read -r test place; do
    row="| $test, $place"
    for library in libccd ours preloaded; do
        n=$(grep -F "$test $place " "$work/failures.$library" | cut -d' ' -f3)
        row="$row | ${n:-0}"
    done
    echo "$row | $(who_is_right "$test") |"
done | tee "$work/table"
echo
echo "$(cat "$work"/*.libccd | grep -c '^\[       OK') tests pass on libccd, $(cat "$work"/test_*.ours | grep -c '^\[       OK') here, \
$(cat "$work"/test_*.preloaded | grep -c '^\[       OK') with the preloaded library."
! grep -q '| unknown |$' "$work/table"
