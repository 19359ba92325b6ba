# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Paths of the library and its headers, for builds; `warmccd --help` shows how programs run on it as they are."""

import pathlib

_HERE = pathlib.Path(__file__).resolve().parent


def get_include() -> str:
    """Returns the folder of the headers: `-I` of a compiler, for `#include <ccd/ccd.h>`."""
    return str(_HERE / "include")


def get_library() -> str:
    """Returns the shared library `libccd.so.2`, in double precision, a file to link and to load."""
    return str(_HERE / "lib" / "libccd.so.2")
