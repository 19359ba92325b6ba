/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The tool's own queries must not leave into the program. */

#ifndef COMPARE_GUARD_H
#define COMPARE_GUARD_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    GUARD_RETURNED,
    GUARD_THREW,  /* an exception left it, and is destroyed; destructors have run */
    GUARD_JUMPED, /* longjmp or siglongjmp to a place outside */
    GUARD_ENDED   /* guard_end */
} guard_t;

/* Runs a function that may throw or jump out of itself, and returns. */
guard_t guard_run(void (*work)(void *), void *argument);

/* Returns whether this thread is within guard_run. */
int guard_active(void);

/* Leaves the innermost guard_run. */
void guard_end(void) __attribute__((noreturn));

#ifdef __cplusplus
}
#endif

#endif
