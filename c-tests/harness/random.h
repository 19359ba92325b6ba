/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Random numbers that are the same on every machine: uniform() draws from one stream a
 * program (xorshift64*), rng_...() from as many as there are pairs (splitmix64: Steele, Lea,
 * Flood 2014), so that a pair does not depend on those before it. */

#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include "harness/shapes.h"

#include <stdint.h>

static inline double random_between(double low, double high, uint64_t bits)
{
    return low + (high - low) * (double)(bits >> 11) * (1.0 / 9007199254740992.0);
}

/* --- one stream a program -------------------------------------------------------- */

static uint64_t random_state = 88172645463325252u;

static inline double uniform(double low, double high)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return random_between(low, high, random_state * 2685821657736338717ull);
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

static inline void turn_at_random(shape_t *s)
{
    double q[4], rot[9];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(s, rot);
}

/* --- a stream for each pair ------------------------------------------------------ */

typedef struct {
    uint64_t state;
} rng_t;

static inline uint64_t rng_bits(rng_t *r)
{
    uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static inline rng_t rng(uint64_t stream, uint64_t index)
{
    rng_t r;
    r.state = stream * UINT64_C(0xd1342543de82ef95) + index;
    r.state = rng_bits(&r);
    return r;
}

static inline double rng_uniform(rng_t *r, double low, double high) { return random_between(low, high, rng_bits(r)); }

static inline double rng_log_uniform(rng_t *r, double low, double high) { return exp(rng_uniform(r, log(low), log(high))); }

/* 0 ... n-1 */
static inline int rng_below(rng_t *r, int n) { return (int)(rng_bits(r) % (uint64_t)n); }

static inline int rng_sign(rng_t *r) { return rng_bits(r) & 1 ? 1 : -1; }

static inline void rng_unit_vector(rng_t *r, double n[3])
{
    double l;
    do {
        for (int i = 0; i < 3; i++)
            n[i] = rng_uniform(r, -1, 1);
        l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    } while (!(l > 1e-3 && l <= 1));
    for (int i = 0; i < 3; i++)
        n[i] /= l;
}

/* Writes n random points on an ellipsoid with these half axes. */
static inline void rng_on_ellipsoid(rng_t *r, ccd_real_t *points, int n, const double half[3])
{
    for (int i = 0; i < n; i++) {
        double u[3];
        rng_unit_vector(r, u);
        for (int k = 0; k < 3; k++)
            points[3 * i + k] = (ccd_real_t)(half[k] * u[k]);
    }
}

static inline void rng_rotation(rng_t *r, double rot[9])
{
    double q[4], l;
    int i;
    do {
        for (i = 0, l = 0; i < 4; i++) {
            q[i] = rng_uniform(r, -1, 1);
            l += q[i] * q[i];
        }
    } while (!(l > 1e-3 && l <= 1));
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
}

#endif
