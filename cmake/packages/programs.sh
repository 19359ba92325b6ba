#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Within try.sh's chroot: programs over Debian's libraries.
#   programs.sh build      compiles them, once, on libccd's own development files
#   programs.sh run WHICH  runs them; WHICH library they are on, libccd or warmccd, is checked

set -eu

each() {
    # name, compiler, libraries, arguments: one scene each
    "$1" fcl_static "c++ -std=c++17 -D_GNU_SOURCE" "-lfcl" "1 60"
    "$1" ode_static "cc -std=gnu99" "-lode" "1 60"
    "$1" ode_pile "cc -std=gnu99" "-lode" "1 400 40 pile"
    "$1" mujoco_pile "cc -std=gnu99" "-lmujoco" "1 300 40"
    "$1" dart_pile "c++ -std=c++17 -D_GNU_SOURCE" "-ldart" "1 200 20"
}

build() {
    source=$(find c-tests/engines c-tests/lab/engines -name "$1.c*")
    # shellcheck disable=SC2086  # flags, one word each
    $2 -O2 -w -I /usr/include/eigen3 -I c-tests -I ours "$source" -o "$1" $3 -lccd -lm
}

run() {
    library=$(ldd "./$1" | sed -n 's|.*libccd\.so\.2 => \(/[^ ]*\).*|\1|p')
    on=libccd
    ! grep -q ccdImplementation "$library" || on=warmccd
    if [ "$on" != "$which" ]; then
        echo "programs.sh: $1 runs on $on, $library, not on $which" >&2
        exit 1
    fi
    echo "-- $1 on $on ($(dpkg -S "$(realpath "$library")" | cut -d: -f1))"
    # shellcheck disable=SC2086  # arguments, one word each
    LD_BIND_NOW=1 "./$1" $4 >"$1.$which.txt"
    tail -n 3 "$1.$which.txt"
}

case $1 in
build) each build ;;
run)
    which=$2
    each run
    ;;
esac
