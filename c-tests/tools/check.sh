#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the tests under a tool that checks memory, undefined behaviour or threads.
#   check.sh address  [ARGUMENT...]   gcc's AddressSanitizer, LeakSanitizer and UBSan in the C programs
#   check.sh memcheck [ARGUMENT...]   valgrind, which checks the library's own code too
#   check.sh helgrind [ARGUMENT...]   valgrind's check for data races, likewise
#   check.sh miri     [ARGUMENT...]   Miri through the exported functions; needs
#                                     rustup component add --toolchain nightly miri rust-src
# The arguments are cargo test's: without -p tests of the commit, by their names (contract::), and --features single.

set -eu
cd "$(dirname "$0")/../.."

tool=${1:-}
[ $# -eq 0 ] || shift

case $tool in
address)
    # clang's runtime is another package, and another library.
    export CC=gcc CXX=g++
    # Undefined behaviour ends the program: without that UBSan only reports it.
    export C_TESTS_FLAGS="-O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
    ;;
memcheck)
    export C_TESTS_RUNNER="valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite,indirect"
    ;;
helgrind)
    export C_TESTS_RUNNER="valgrind --tool=helgrind --quiet --error-exitcode=99"
    ;;
miri) exec cargo +nightly miri test --test integration "$@" -- api:: miri:: ;;
*)
    echo "usage: check.sh address|memcheck|helgrind|miri [cargo test's arguments]" >&2
    exit 2
    ;;
esac
[ "${1:-}" = -p ] || set -- --test integration "$@"
exec cargo test --no-fail-fast "$@"
