#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   source.sh OUT   makes OUT/warmccd-VERSION.tar.xz from the files that git knows
#
# All that building the library needs: its sources, headers, CMake files and the crates
# it is made of (vendor/, which .cargo/config.toml names), so that no network is asked.
# The tests, with their data and the crates for them alone, are left to the repository.
# The same commit gives the same bytes.

set -eu
[ $# -eq 1 ] || { echo "usage: source.sh OUT" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."

version=$(sh cmake/packages/version.sh)
name=warmccd-$version
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tree=$work/$name
mkdir "$tree"
{
    git ls-files -z -- . ':!c-tests' ':!.ci'
    git ls-files -z -- c-tests/tests/packaging/consumer
} | tar -c --null -T - | tar -x -C "$tree"

# Cargo wants every crate of the manifest at hand, those of the tests too.
awk '/^\[/ { drop = /^\[(workspace|dev-dependencies|\[(test|bench|example)\])/ } !drop' Cargo.toml >"$tree/Cargo.toml"
# A workspace of its own, wherever it is unpacked.
printf '\n[workspace]\n' >>"$tree/Cargo.toml"
mkdir "$tree/.cargo"
(cd "$tree" && cargo vendor --quiet)
cat >"$tree/.cargo/config.toml" <<'END'
[source.crates-io]
replace-with = "vendored-sources"

[source.vendored-sources]
directory = "vendor"
END

date=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
tar -c -C "$work" --sort=name --mtime="@$date" --owner=0 --group=0 --numeric-owner \
    --mode=go=rX,u+rw "$name" | xz -9 -T1 >"$out/$name.tar.xz"
echo "$out/$name.tar.xz"
