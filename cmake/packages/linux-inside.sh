#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   linux-inside.sh ARCHIVE REPOSITORY   tries linux.sh's archive, in a new folder of this one, without Rust
#
# Links, the swap of a program of libccd's and of programs over ODE and FCL, and python-fcl's wheel, on a machine with
# build-essential, cmake, pkg-config, libccd-dev, libode-dev, libfcl-dev, python3-venv and a network. try-linux.sh makes one.

set -eu
[ $# -eq 2 ] || { echo "usage: linux-inside.sh ARCHIVE REPOSITORY" >&2; exit 2; }
archive=$(realpath "$1")
repository=$(realpath "$2")
for tool in cargo rustc; do
    ! command -v $tool || { echo "linux-inside.sh: there is $tool here" >&2; exit 1; }
done
rm -rf folder
mkdir folder
cd folder
tar -xzf "$archive"
mv warmccd-* moved
cd moved

# expect TEXT COMMAND...: runs it; its output contains the text
expect() {
    text=$1
    shift
    echo "-- $*"
    if ! output=$("$@" 2>&1) || ! printf '%s\n' "$output" | grep -q -e "$text"; then
        printf '%s\n' "$output" >&2
        echo "linux-inside.sh: failed, or no '$text'" >&2
        exit 1
    fi
}

echo "== links"
sed -n 's/^\(cc example.c .*\)/\1/p' README.md >links
[ "$(wc -l <links)" -eq 3 ]
while read -r line; do
    expect "^depth 0.100" sh -c "$line"
done <links
cc -DCCD_SINGLE example.c -Isingle/include single/lib/libccd.a -Wl,--gc-sections -lm -o example-single
expect "^depth 0.100" ./example-single
cmake -S "$repository/c-tests/tests/packaging/consumer" -B consumer -DWAY=find_package -DCMAKE_PREFIX_PATH="$PWD" >/dev/null
cmake --build consumer >/dev/null
for program in plain namespaced variables static; do
    expect "warmccd .* double" "consumer/$program"
done

echo "== the swap"
cc example.c -idirafter include -lccd -lm -o on-libccd
expect "^depth 0.213" ./on-libccd
expect "^depth 0.100" env LD_LIBRARY_PATH="$PWD/lib" ./on-libccd
expect "^depth 0.100" ./run-on-warmccd.sh ./on-libccd
expect "^this library " ./run-on-warmccd.sh ./on-libccd
c++ -O2 -I/usr/include/eigen3 "$repository/cmake/packages/newcomer.cpp" -lfcl -o fcl
cc -std=gnu99 -O2 -w -I"$repository/c-tests" -idirafter include "$repository/c-tests/engines/ode_pile.c" -lode -lccd -lm -o ode
expect "of 500 overlap" ./run-on-warmccd.sh ./fcl
expect "^this library  *0  *0  *0  *0  *0 " ./run-on-warmccd.sh ./fcl
expect "^this library  *0  *0  *0  *0  *0 " ./run-on-warmccd.sh ./ode 1 400 40 pile
c++ -O2 -w -DOURS_ALONE -I"$repository/c-tests" -Iinclude -I/usr/include/eigen3 "$repository/c-tests/engines/fcl_distance.cpp" \
    -lfcl -lccd -o distance
expect "^function libfcl" ./distance 200
expect "^kissing .* threw 0 endless 0 wrong 0 outside 0 unequal 0" \
    env LD_LIBRARY_PATH="$PWD/lib" LD_PRELOAD=libwarmccd-fcl.so ./distance 200

echo "== python-fcl's wheel"
program=$repository/c-tests/lab/engines/wheel.py
python3 -m venv venv
venv/bin/pip install -q python-fcl
expect "depth 0\.\(49999\|5000\)" venv/bin/python "$program"
preload=libccd.so.2
for aside in "0.000" "0.0[1-9]"; do
    expect "depth 0\.\(09999\|1000\)" env LD_LIBRARY_PATH="$PWD/lib" LD_PRELOAD="$preload" venv/bin/python "$program"
    expect "aside $aside" env LD_LIBRARY_PATH="$PWD/lib" LD_PRELOAD="$preload" venv/bin/python "$program"
    preload="libwarmccd-middle.so libccd.so.2"
done
echo "linux-inside.sh: all is well"
