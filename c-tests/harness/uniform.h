/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Repeatable random numbers and rotations: one stream a program. (Of many streams: tests/stability/splitmix.h.) */

#ifndef TESTS_UNIFORM_H
#define TESTS_UNIFORM_H

#include <math.h>
#include <stdint.h>

/* xorshift64*: the same numbers on every machine. */
static uint64_t random_state = 88172645463325252u;
static inline double uniform(double low, double high)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return low + (high - low) * (double)((random_state * 2685821657736338717ull) >> 11) * (1.0 / 9007199254740992.0);
}
static inline void uniform_seed(uint64_t seed)
{
    random_state = seed * 0x9E3779B97F4A7C15ull + 1;
    for (int i = 0; i < 8; i++)
        uniform(0, 1);
}

/* A uniformly random rotation as a unit quaternion (w, x, y, z). */
static inline void uniform_rotation(double q[4])
{
    double length;
    int i;
    do {
        for (length = 0, i = 0; i < 4; i++) {
            q[i] = uniform(-1, 1);
            length += q[i] * q[i];
        }
    } while (length > 1 || length < 0.01);
    for (i = 0; i < 4; i++)
        q[i] /= sqrt(length);
}

#endif
