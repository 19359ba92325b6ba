#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# All tests, in double and in single precision, and the C programs of the contract
# under sanitizers and valgrind. Sets itself up.

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh

# All are run, so that one failure does not hide another.
failed=0
cargo test --no-fail-fast || failed=1
cargo test --no-fail-fast --features single || failed=1
# The same C programs where errors that leave no trace show.
sh c-tests/tools/check.sh address --test contract --test extension || failed=1
sh c-tests/tools/check.sh memcheck --test contract -- --skip bad_input || failed=1
sh c-tests/tools/check.sh helgrind --test contract threads || failed=1
exit "$failed"
