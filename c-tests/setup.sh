#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing Debian packages, as root or with sudo. First reports a Rust that is too old.
#   setup.sh        packages of the tests
#   setup.sh lab    those, and the engines of lab/: MuJoCo and DART, and with DART Bullet
#   setup.sh main   packages of the main job
#   setup.sh compare  packages of compare.sh: those of the main job, and a C++ compiler
#   setup.sh archive  packages of cmake/packages/linux.sh and wheel.sh
#   setup.sh check  installs nothing; prints the tests' missing packages in one line

set -eu

cd "$(dirname "$0")/.."
job=${1:-tests}
missing=

# rust_version MANIFEST: prints its oldest supported Rust
rust_version() {
    sed -n 's/^rust-version = "\(.*\)"$/\1/p' "$1"
}

# want_command COMMAND PACKAGE...: adds the packages unless the command exists
want_command() {
    command -v "$1" >/dev/null 2>&1 && return
    shift
    missing="$missing $*"
}

# want_package PACKAGE...: adds the packages that are not installed
want_package() {
    for package in "$@"; do
        state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || state=absent
        [ "$state" = installed ] || missing="$missing $package"
    done
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        env DEBIAN_FRONTEND=noninteractive "$@"
    elif command -v sudo >/dev/null 2>&1; then
        sudo env DEBIAN_FRONTEND=noninteractive "$@"
    else
        echo "setup.sh: neither root nor sudo; as root: $*" >&2
        return 1
    fi
}

# apt_install PACKAGE...: fetches the package lists only after a failure
apt_install() {
    as_root apt-get install -y -q --no-install-recommends "$@" </dev/null && return
    as_root apt-get update -q </dev/null || return
    as_root apt-get install -y -q --no-install-recommends "$@" </dev/null
}

case $job in
main | compare | archive)
    oldest=$(rust_version Cargo.toml)
    from="Debian 12's or 13's rustc-web and cargo-web, Debian 13's rustc and cargo, or https://rustup.rs"
    ;;
tests | lab | check)
    oldest=$(rust_version c-tests/setup/Cargo.toml)
    from="Debian 12's or 13's rustc-web and cargo-web, or https://rustup.rs"
    ;;
*)
    echo "usage: setup.sh [tests|lab|main|compare|archive|check]" >&2
    exit 2
    ;;
esac
for tool in cargo rustc; do
    # rustup's shim fails without a toolchain.
    if ! found=$($tool --version 2>/dev/null); then
        echo "setup.sh: $tool is missing: install Rust $oldest or later first ($from)" >&2
        exit 1
    fi
    found=${found#* }
    found=${found%%[ -]*}
    if [ "$(printf '%s\n' "$oldest" "$found" | sort -V | head -n 1)" != "$oldest" ]; then
        echo "setup.sh: $tool is $found, too old: Rust $oldest or later is needed ($from)" >&2
        exit 1
    fi
done

want_command cc gcc libc6-dev
if command -v cc >/dev/null 2>&1; then
    echo '#include <stdio.h>' | cc -E -o /dev/null - 2>/dev/null || missing="$missing libc6-dev"
fi

[ "$job" = main ] || want_command c++ g++
case $job in
main | compare) ;;
archive)
    want_command cmake cmake
    want_command make make
    want_command git git
    want_command musl-gcc musl-tools
    echo '#include <fcl/config.h>' | c++ -E -x c++ -o /dev/null - 2>/dev/null || missing="$missing libfcl-dev"
    python3 -c 'import ensurepip' 2>/dev/null || missing="$missing python3-venv"
    ;;
*)
    want_command objcopy binutils
    want_command pkg-config pkg-config
    want_command cmake cmake
    want_command make make
    want_command ninja ninja-build
    want_command git git
    want_command xz xz-utils
    want_command valgrind valgrind
    if command -v dpkg-query >/dev/null 2>&1; then
        want_package libccd-dev libfcl-dev libode-dev libclang-dev
        [ "$job" != lab ] || want_package libmujoco-dev libdart-dev
    fi
    ;;
esac

if [ "$job" = check ]; then
    [ -n "$missing" ] || exit 0
    echo "not set up for tests (missing:$missing): run \`sh c-tests/setup.sh\` first"
    exit 1
fi

if [ -n "$missing" ]; then
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "setup.sh: not a Debian system; install what these packages hold:$missing" >&2
        exit 1
    fi
    # shellcheck disable=SC2086  # one word per package
    apt_install $missing
fi

# One test builds the library with the oldest supported Rust.
if { [ "$job" = tests ] || [ "$job" = lab ]; } && command -v rustup >/dev/null 2>&1; then
    oldest=$(rust_version Cargo.toml)
    rustup run "$oldest" cargo --version >/dev/null 2>&1 ||
        rustup toolchain install "$oldest" --profile minimal ||
        echo "setup.sh: no Rust $oldest: its test will be skipped" >&2
fi

# These jobs compare with the system's libccd, if there is one.
if { [ "$job" = main ] || [ "$job" = compare ]; } && command -v apt-get >/dev/null 2>&1; then
    missing=
    want_package libccd2
    if [ -n "$missing" ]; then
        apt_install libccd2 || echo "setup.sh: no libccd2: only this library will be run" >&2
    fi
fi
