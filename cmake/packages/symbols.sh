#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   symbols.sh FILE...   fails where a library needs newer symbols of glibc, libstdc++ or libgcc than manylinux_2_28 has

set -eu
failed=0
for file; do
    readelf --wide --version-info "$file" >/dev/null
    for needed in $(readelf --wide --version-info "$file" | sed -n 's/.*Name: \([A-Z]*_[0-9.]*\) .*Version:.*/\1/p' | sort -u); do
        case $needed in
        GLIBC_*) newest=GLIBC_2.28 ;;
        GLIBCXX_*) newest=GLIBCXX_3.4.24 ;;
        CXXABI_*) newest=CXXABI_1.3.11 ;;
        GCC_*) newest=GCC_7.0.0 ;;
        *) continue ;;
        esac
        [ "$(printf '%s\n' "$newest" "$needed" | sort -V | tail -n 1)" = "$newest" ] && continue
        echo "symbols.sh: $file needs $needed, newer than $newest" >&2
        failed=1
    done
done
exit $failed
