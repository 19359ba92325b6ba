#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   cross.sh arm64|i386   builds and tests the library for another processor
#
# In a chroot of Debian 13, with Debian's cross compilers and its Rust library for that
# processor; programs run under qemu-user. The files are those of this folder that git
# knows. As root; chroot.sh says more.

set -eu
case ${1:-} in
arm64) rust=aarch64-unknown-linux-gnu tools=aarch64-linux-gnu qemu=qemu-aarch64 ;;
i386) rust=i686-unknown-linux-gnu tools=i686-linux-gnu qemu=qemu-i386 ;;
*) echo "usage: cross.sh arm64|i386" >&2; exit 2 ;;
esac
here=$(dirname "$(realpath "$0")")
# shellcheck source=cmake/packages/chroot.sh
. "$here/chroot.sh"

# The tests' crates need a newer Rust than Debian 13's rustc: its rustc-web.
make_chroot cross trixie
in_chroot cross dpkg --add-architecture "$1"
apt_in_chroot cross rustc-web cargo-web "libstd-rust-web-dev:$1" "g++-$tools" g++ libc6-dev \
    qemu-user "libccd-dev:$1" libccd-dev libclang-dev ca-certificates cmake make pkg-config

tree=$chroots/cross/tree
rm -rf "$tree"
mkdir "$tree"
(cd "$here/../.." && git ls-files -z | tar -c --null -T -) | tar -x -C "$tree"

upper=$(echo "$rust" | tr a-z- A-Z_)
# there VERB ARGUMENT...: cargo for the other processor; here VERB ARGUMENT...: for this one
# C_TESTS_PARTLY: what other tests need is not installed here.
there() {
    verb=$1
    shift
    in_chroot cross env -C /tree C_TESTS_PARTLY=1 CARGO_TARGET_DIR=/target \
        "CARGO_TARGET_${upper}_LINKER=$tools-gcc" "CARGO_TARGET_${upper}_RUNNER=$qemu" \
        CC="$tools-gcc" CXX="$tools-g++" NM="$tools-nm" OBJCOPY="$tools-objcopy" OBJDUMP="$tools-objdump" \
        READELF="$tools-readelf" \
        cargo "$verb" --locked --target "$rust" "$@"
}
# shellcheck disable=SC2317  # called by name
here() {
    verb=$1
    shift
    in_chroot cross env -C /tree C_TESTS_PARTLY=1 CARGO_TARGET_DIR=/target cargo "$verb" --locked "$@"
}
# answers WHERE: of every entry point to pairs of all categories, one digest a pair
answers() {
    "$1" run -p lab --bin campaigns -- determinism >"$lists/all" || failed=1
    grep '^pair ' "$lists/all" | sort
}

# All are run, so that one failure does not hide another.
failed=0
echo "== $1: contract, configurations, recorded support counts"
there test --no-fail-fast --test integration -- harness_itself:: contract:: || failed=1
there test --test integration stability::configurations || failed=1
there test --test integration no_set_needs_more || failed=1
echo "== $1: the same bits as on this machine"
# The same question must have the same answers; the C library's sine and logarithm, which
# the questions are made with, are not the same everywhere.
lists=$(mktemp -d)
answers there >"$lists/there"
answers here >"$lists/here"
join -j 2 "$lists/there" "$lists/here" >"$lists/both"
all=$(wc -l <"$lists/here")
both=$(wc -l <"$lists/both")
differ=$(awk '$3 != $5' "$lists/both" | wc -l)
rm -r "$lists"
echo "$all pairs, $both asked alike, $differ of these answered otherwise"
[ "$differ" -eq 0 ] && [ $((2 * both)) -gt "$all" ] || failed=1
exit "$failed"
