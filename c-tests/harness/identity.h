/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The libccd.so.2 that this process runs on: the result of ccdImplementation, a
 * function only this repository's library has, or NULL on any other libccd. */

#ifndef C_TESTS_IDENTITY_H
#define C_TESTS_IDENTITY_H

#include <dlfcn.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static inline const char *running_ccd(void)
{
    void *symbol = dlsym(dlopen(NULL, RTLD_NOW), "ccdImplementation");
    const char *(*implementation)(void) = NULL;
    /* ISO C has no cast from an object pointer to a function pointer. */
    memcpy(&implementation, &symbol, sizeof symbol);
    return symbol == NULL ? NULL : implementation();
}

/* Prints a program's first line, by which its driver knows the library. */
static inline void print_library(void)
{
    const char *name = running_ccd();
    printf("library %s\n", name ? name : "libccd");
}

#endif
