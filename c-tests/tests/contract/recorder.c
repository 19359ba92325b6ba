/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Preloaded, takes every call of a libccd function that the dynamic linker binds, and ends the process:
 * nobody but the library itself calls them. */

#include "tests/contract/functions.h"

#include <stdio.h>
#include <stdlib.h>

#define RECORD(name) \
    void name(void); \
    void name(void) \
    { \
        fprintf(stderr, "%s was called by the dynamic linker's table\n", #name); \
        abort(); \
    }
LIBCCD_FUNCTIONS(RECORD)
