#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   try-wheel.sh SUITE WHEEL   tries wheel.sh's wheel in a clean Debian of bookworm or trixie, without Rust or a compiler, and
#                              compiles a program with it in another one
#
# As root; chroot.sh says more.

set -eu
[ $# -eq 2 ] || { echo "usage: try-wheel.sh SUITE WHEEL" >&2; exit 2; }
suite=$1
wheel=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"
release_of "$suite" >/dev/null

# prepared NAME PACKAGE...: a chroot with these packages, and the wheel and this folder in /work
prepared() {
    name=$1
    shift
    make_chroot "$name" "$suite"
    apt_in_chroot "$name" "$@" ca-certificates
    work=$chroots/$name/work
    rm -rf "$work"
    mkdir -p "$work/repository/cmake" "$work/repository/c-tests/lab/engines" "$work/tried"
    cp "$wheel" "$work"
    cp -r "$here" "$work/repository/cmake/packages"
    cp "$here/../../c-tests/lab/engines/wheel.py" "$work/repository/c-tests/lab/engines"
}

prepared "wheel-$suite" python3-venv
in_chroot "$name" sh -c 'cd /work/tried && sh ../repository/cmake/packages/wheel-inside.sh ../*.whl ../repository'

echo "== a build"
prepared "linux-$suite" build-essential python3-venv
cp "$here/../../c-tests/tests/packaging/consumer/main.c" "$work/tried/app.c"
# The README's commands.
sed -n '/^include=/,/^cc /p' "$here/wheel/README.md" >"$work/tried/build.sh"
# shellcheck disable=SC2016  # the inner shell expands
in_chroot "$name" sh -euc '
    cd /work/tried
    python3 -m venv venv
    PATH=$PWD/venv/bin:$PATH
    pip install -q ../*.whl
    . ./build.sh
    ./a.out | grep "^warmccd .* double"'
echo "try-wheel.sh: $suite: all is well"
