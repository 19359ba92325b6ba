/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* For a program that knows it is watched, as those of engines/ do. It may read what has been
 * counted so far, and define, exported (-rdynamic):
 *
 *   compare_audit     is shown every support point of its own queries, and may change it
 *   compare_answered  is told every answer to one, with the direction's length */

#ifndef COMPARE_HOOKS_H
#define COMPARE_HOOKS_H

#include "tools/compare/counts.h"

#include <ccd/ccd.h>

#ifdef __cplusplus
extern "C" {
#endif

void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *point);
void compare_answered(int call, int hit, double depth, double length);

/* Of the tool, which is there when the program runs and not when it is linked. */
const compare_counts_t *compare_counts(void) __attribute__((weak));

/* Queries so far; 0 where the program runs without the tool. */
static inline unsigned long compare_queries(void)
{
    unsigned long n = 0;
    if (!compare_counts)
        return 0;
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++)
        n += (unsigned long)compare_counts()->call[i].queries;
    return n;
}

/* Support points of FCL's own solvers so far; 0 where the program runs without the tool. */
static inline unsigned long compare_supports(void)
{
    return compare_counts ? (unsigned long)compare_counts()->raw_supports : 0;
}

#ifdef __cplusplus
}
#endif

#endif
