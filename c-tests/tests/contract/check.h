/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks that report their failures, and random numbers. */

#ifndef TESTS_CHECK_H
#define TESTS_CHECK_H

#include "harness/random.h"

#include <ccd/vec3.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static unsigned long checks_made, checks_failed;

/* Adds one to a counter, from any thread. Returns what it was. */
#define COUNT_UP(counter) __atomic_fetch_add(&(counter), 1, __ATOMIC_RELAXED)

/* Counts a check, and prints the first 20 failures: CHECK(condition, format, ...). */
#define CHECK(condition, ...)                                          \
    do {                                                               \
        COUNT_UP(checks_made);                                         \
        if (!(condition) && COUNT_UP(checks_failed) < 20) {            \
            printf("%s:%d: not %s: ", __FILE__, __LINE__, #condition); \
            printf(__VA_ARGS__);                                       \
            printf("\n");                                              \
        }                                                              \
    } while (0)

/* Prints the number of checks and returns the exit code. */
static inline int checks_end(void)
{
    printf("%lu checks, %lu failed\n", checks_made, checks_failed);
    return checks_made == 0 || checks_failed != 0;
}

static inline int random_below(int n) { return (int)uniform(0, n); }

static inline ccd_vec3_t random_vec3(double size)
{
    ccd_vec3_t v;
    for (int i = 0; i < 3; i++)
        v.v[i] = (ccd_real_t)uniform(-size, size);
    return v;
}

static inline int same_bits(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

#endif
