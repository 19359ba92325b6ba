#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Functions of the scripts that need another project's source.

# debian_source PACKAGE WORK: fetches the source of a package of this Debian, and unpacks it in WORK/source
debian_source() {
    package=$1 fetched=$2/apt unpacked=$2/source
    mkdir -p "$fetched/parts" "$fetched/lists/partial" "$fetched/archives/partial"
    # With lists of its own: the machine's may name no sources.
    # shellcheck source=/dev/null
    . /etc/os-release
    cat >"$fetched/parts/source.sources" <<END
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: $VERSION_CODENAME
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
    set -- -q -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$fetched/parts" -o Dir::State::lists="$fetched/lists" \
        -o Dir::Cache="$fetched" -o APT::Sandbox::User=
    apt-get "$@" update >&2
    (cd "$fetched" && apt-get "$@" source --download-only "$package" >&2)
    rm -rf "$unpacked"
    mkdir "$unpacked"
    tar xzf "$fetched/$package"_*.orig.tar.gz -C "$unpacked" --strip-components=1
}

# ode_demos WORK DEMO...: compiles demos of ODE without drawing as WORK/demo_DEMO; ODE's source is fetched, unless it is in
# ODE_SOURCE
ode_demos() {
    ode_work=$1 ode_source=${ODE_SOURCE:-$1/source}
    shift
    [ -n "${ODE_SOURCE:-}" ] || [ -d "$ode_source/ode/demo" ] || debian_source ode "$ode_work"
    # Debian's ode.h knows its precision, the source's does not.
    mkdir -p "$ode_work/include"
    cp -r "$ode_source/include/drawstuff" "$ode_work/include"
    "${CC:-cc}" -O1 -c c-tests/lab/engines/drawstuff.c -o "$ode_work/drawstuff.o"
    for demo; do
        "${CXX:-c++}" -w -O1 '-DDRAWSTUFF_TEXTURE_PATH="."' -I"$ode_work/include" -I"$ode_source/ode/demo" \
            "$ode_source/ode/demo/demo_$demo.cpp" "$ode_work/drawstuff.o" -lode -lccd -o "$ode_work/demo_$demo"
    done
}
