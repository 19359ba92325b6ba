#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# A function of the scripts that need another project's source.

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
