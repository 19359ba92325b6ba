#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
#   version.sh   prints the version of the package, the first of Cargo.toml

set -eu
sed -n '/^version = /{s/.*"\(.*\)"$/\1/p;q;}' "$(dirname "$0")/../../Cargo.toml"
