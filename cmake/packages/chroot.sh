# shellcheck shell=sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Read by the scripts that work in a clean Debian. As root, with debootstrap and a network.
# CHROOTS names the folder that keeps what was installed, /var/tmp/warmccd-chroots if not said.

chroots=${CHROOTS:-/var/tmp/warmccd-chroots}

# Debian's release of a suite.
release_of() {
    case $1 in
    bookworm) echo 12 ;;
    trixie) echo 13 ;;
    *) echo "chroot.sh: which release is $1?" >&2; return 1 ;;
    esac
}

# make_chroot NAME SUITE: a minimal Debian as $chroots/NAME, unless it is there
make_chroot() {
    root=$chroots/$1
    [ ! -e "$root/made" ] || return 0
    mkdir -p "$chroots"
    debootstrap --variant=minbase "$2" "$root" http://deb.debian.org/debian
    touch "$root/made"
}

# in_chroot NAME COMMAND...: /proc and /dev are there; nothing else of this machine but
# the resolver and the certificates that it trusts, for a registry behind a proxy
in_chroot() {
    root=$chroots/$1
    shift
    cp -L /etc/resolv.conf "$root/etc/resolv.conf"
    trusted=/etc/ssl/certs/ca-certificates.crt
    [ ! -e "$root$trusted" ] || [ ! -e $trusted ] || cp -L $trusted "$root$trusted"
    # A mount namespace of its own: the mounts end with the command.
    # shellcheck disable=SC2016  # the inner shell expands
    unshare --mount --propagation private sh -c '
        mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" || exit
        root=$1
        shift
        exec chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
            LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"' sh "$root" "$@"
}

# in_chroot NAME apt-get install, once the lists are fetched
apt_in_chroot() {
    name=$1
    shift
    in_chroot "$name" apt-get update -qq
    in_chroot "$name" apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends "$@"
}
