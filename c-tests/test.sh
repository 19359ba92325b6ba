#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# All tests, in double and in single precision. Sets itself up.

set -eu
cd "$(dirname "$0")/.."

sh c-tests/setup.sh

# Both are run, so that one failure does not hide another.
failed=0
cargo test --no-fail-fast || failed=1
cargo test --no-fail-fast --features single || failed=1
exit "$failed"
