#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a program that is linked to libccd.so.2 on the warmccd beside this script instead, unchanged, and prints on stderr what
# changed: a share of its queries is repeated on the machine's libccd and compared with the proven minimum.
#   run-on-warmccd.sh [OPTION...] PROGRAM [ARGUMENT...]
#     --every N    judge one query in N (default 10; 0: only count them)
#     --keep DIR   write the worst wrong answers there
#     --runs N     then run the program N times on each library, in turn, and compare its times
#     --limit S    end each run after S seconds
#     --no-times   time no queries: fewer calls of the callbacks
#     --libccd F   the libccd to compare with (default: the program's)
# Without the comparison: LD_LIBRARY_PATH=THIS-FOLDER/lib PROGRAM

set -eu
[ $# -gt 0 ] || { sed -n 's/^#   \( *[r-]\)/\1/p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
exec sh "$here/recorder/compare.sh" --swap --recorder "$here/recorder" --library "$here/lib/libccd.so.2" "$@"
