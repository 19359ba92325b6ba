/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* For a program that knows it is watched, as those of swap/ do. It may define, exported
 * (-rdynamic):
 *
 *   compare_audit     is shown every support point, and may change it
 *   compare_answered  is told every answer to a query of its own
 *
 * and read what has been counted so far. */

#ifndef COMPARE_HOOKS_H
#define COMPARE_HOOKS_H

#include "compare/counts.h"

#include <ccd/ccd.h>

#ifdef __cplusplus
extern "C" {
#endif

void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *point);
void compare_answered(int call, int hit, double depth, double length);

/* Of the tool, which is there when the program runs and not when it is linked. */
const compare_counts_t *compare_counts(void) __attribute__((weak));

#ifdef __cplusplus
}
#endif

#endif
