#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   symbols.sh FILE...   prints the versions of glibc's, libstdc++'s and libgcc's symbols that a library needs; fails where one is
#                        newer than manylinux_2_28 has

set -eu
failed=0
for file; do
    needs=$(readelf --wide --version-info "$file")
    needs=$(printf '%s\n' "$needs" | sed -n 's/.*Name: \([A-Z]*_[0-9A-Z._]*\) .*Version:.*/\1/p' | sort -uV)
    # shellcheck disable=SC2086  # one line
    echo "$file:" $needs
    for symbol in $needs; do
        case $symbol in
        GLIBC_*) newest=GLIBC_2.28 ;;
        GLIBCXX_*) newest=GLIBCXX_3.4.24 ;;
        CXXABI_*) newest=CXXABI_1.3.11 ;;
        GCC_*) newest=GCC_7.0.0 ;;
        *) continue ;;
        esac
        [ "$(printf '%s\n' "$newest" "$symbol" | sort -V | tail -n 1)" = "$newest" ] && continue
        echo "symbols.sh: $file needs $symbol, newer than $newest" >&2
        failed=1
    done
done
exit $failed
