/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Leaving a query from inside of a callback: the how-many-th callback is the last. The
 * program defines leave(), which does not return. */

#ifndef TESTS_LEAVE_H
#define TESTS_LEAVE_H

#include "entries.h"

static void leave(void);

static int calls_left;

static void count_down(void)
{
    if (--calls_left == 0)
        leave();
}

static void leaving_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    count_down();
    shape_support(obj, dir, out);
}

static void leaving_center(const void *obj, ccd_vec3_t *out)
{
    count_down();
    shape_center(obj, out);
}

static void leaving_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    count_down();
    ccdFirstDirDefault(obj1, obj2, dir);
}

/* A pair whose query will be left. */
static inline void leaving_pair(const call_t *entry, int overlapping, shape_t *a, shape_t *b, ccd_t *ccd)
{
    random_pair(entry, overlapping, a, b, ccd);
    ccd->support1 = ccd->support2 = leaving_support;
    if (ccd->center1 != NULL)
        ccd->center1 = ccd->center2 = leaving_center;
    if (ccd->first_dir != NULL)
        ccd->first_dir = leaving_first_dir;
}

/* Runs test(entry) for every entry point that runs callbacks. */
static inline void for_each_entry(void (*test)(const call_t *entry))
{
    int i;
    for (i = 0; i < ENTRIES; i++)
        test(&entries[i]);
    test(&support_entry);
}

#endif
