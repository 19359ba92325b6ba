#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   wheel-inside.sh WHEEL REPOSITORY   tries wheel.sh's wheel with python-fcl's, in a new folder of this one, without Rust
#                                      or a compiler
#
# `warmccd run` and `compare`, and the tests of python-fcl and trimesh, which are in their packages' sources, on the libccd
# of python-fcl's wheel and on this library; trimesh's without test_scene, whose model is not. Needs python3-venv and a
# network. try-wheel.sh makes such a machine.

set -eu
[ $# -eq 2 ] || { echo "usage: wheel-inside.sh WHEEL REPOSITORY" >&2; exit 2; }
wheel=$(realpath "$1")
repository=$(realpath "$2")
program=$repository/c-tests/lab/engines/wheel.py
for tool in cargo rustc cc gcc c++; do
    ! command -v $tool || { echo "wheel-inside.sh: there is $tool here" >&2; exit 1; }
done
# A blank in its path, at which LD_PRELOAD is split.
rm -rf "a folder"
mkdir "a folder"
cd "a folder"

# expect TEXT COMMAND...: runs it, whatever its exit code; its output contains the text
expect() {
    text=$1
    shift
    echo "-- $*"
    output=$("$@" 2>&1) || true
    printf '%s\n' "$output" | grep -q -e "$text" && return
    printf '%s\n' "$output" >&2
    echo "wheel-inside.sh: no '$text'" >&2
    exit 1
}

python3 -m venv venv
PATH=$PWD/venv/bin:$PATH
pip install -q "$wheel" python-fcl trimesh scipy pytest
echo "== programs"
expect "^wheel depth 0.49999" python "$program"
for way in "" --signed-distance; do
    # shellcheck disable=SC2086  # none or one
    expect "^library warmccd" warmccd run $way python "$program"
    # shellcheck disable=SC2086
    expect "^wheel depth 0.10000" warmccd run $way python "$program"
done
expect "^wheel aside 0.000" warmccd run python "$program"
expect "^wheel aside 0.0[1-9]" warmccd run --middle python "$program"
expect "^wheel depth 0.10000" warmccd run --middle --signed-distance python "$program"
# FCL's own ends the process on one of these.
if timeout 20 python "$program" signed 2>/dev/null | grep "^signed .* wrong 0"; then
    echo "wheel-inside.sh: FCL's own signed distances are right" >&2
    exit 1
fi
expect "/libwarmccd-fcl.so$" warmccd run --signed-distance grep libwarmccd /proc/self/maps
expect "^signed queries 3000 wrong 0" warmccd run --signed-distance python "$program" signed
expect "No such file" warmccd run ./missing
pip install -q --target "a;folder" "$wheel"
expect "^warmccd: .*/a;folder/warmccd/lib: no program can be run" env PYTHONPATH="a;folder" python -m warmccd run true
for way in "" --swap; do
    for text in "libccd: .*/python_fcl.libs/libccd-" "^ccdMPRPenetration  *2,002 " "^this library  *0  *0  *0  *0  *0 "; do
        # shellcheck disable=SC2086
        expect "$text" warmccd compare --every 2 $way python "$program"
    done
done
expect "usage: compare.sh" warmccd compare
expect "^warmccd" python -c "import warmccd, ctypes
library = ctypes.CDLL(warmccd.get_library())
library.ccdImplementation.restype = ctypes.c_char_p
print(library.ccdImplementation().decode(), open(warmccd.get_include() + '/ccd/warm.h').read())"

echo "== tests of python-fcl and trimesh"
mkdir tests
# The newer packages of python-fcl have no source; its tests are older than they are.
pip download -q -d sources --no-deps --no-binary python-fcl python-fcl==0.0.12
pip download -q -d sources --no-deps --no-binary trimesh "$(pip freeze | grep ^trimesh=)"
for file in sources/*.tar.gz; do
    tar -xzf "$file" -C tests --wildcards --strip-components=2 '*/test_fcl.py' '*/test_collision.py' 2>/dev/null || true
done
cp "$repository/cmake/packages/wheel/tests/generic.py" tests
cd tests
run_tests="python -m pytest -q --tb=short -k not(test_scene)"
# shellcheck disable=SC2086  # one word each
expect "^11 passed, 1 deselected" $run_tests
for way in "" --signed-distance; do
    # The center of the coincident cubes instead of a corner: the ledger of differences.
    for text in "^1 failed, 10 passed, 1 deselected" "^FAILED .*::test_collision " "array(\[5., 0., 0.\]), array(\[ 5. , -0.5,  0.5\])"; do
        # shellcheck disable=SC2086
        expect "$text" warmccd run $way $run_tests
    done
done
echo "wheel-inside.sh: all is well"
