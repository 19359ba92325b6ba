/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* For programs that compare.sh runs, such as those of engines/. They may read the
 * counts so far, and define, exported (-rdynamic):
 *
 *   compare_audit     is called with every support point of the program's queries, and may change it
 *   compare_queried   is called with the result of every query, and its direction's length */

#ifndef COMPARE_HOOKS_H
#define COMPARE_HOOKS_H

#include "tools/compare/counts.h"

#include <ccd/ccd.h>

#ifdef __cplusplus
extern "C" {
#endif

void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *point);
void compare_queried(int call, int hit, double depth, double length);

/* A function of the tool, which is not there when the program is linked. */
const compare_counts_t *compare_counts(void) __attribute__((weak));

/* Returns the queries so far; 0 without the tool. */
static inline unsigned long compare_queries(void)
{
    unsigned long n = 0;
    if (!compare_counts)
        return 0;
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++)
        n += (unsigned long)compare_counts()->call[i].queries;
    return n;
}

#ifdef __cplusplus
}
#endif

#endif
