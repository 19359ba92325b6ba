/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Random numbers that are the same everywhere: splitmix64 (Steele, Lea, Flood 2014). */

#ifndef STABILITY_SPLITMIX_H
#define STABILITY_SPLITMIX_H

#include "harness/shapes.h"

#include <stdint.h>

typedef struct {
    uint64_t state;
} dice_t;

static inline uint64_t dice_bits(dice_t *d)
{
    uint64_t z = d->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static inline dice_t dice(uint64_t stream, uint64_t index)
{
    dice_t d;
    d.state = stream * UINT64_C(0xd1342543de82ef95) + index;
    d.state = dice_bits(&d);
    return d;
}

/* in [low, high) */
static inline double dice_in(dice_t *d, double low, double high)
{
    return low + (high - low) * ((double)(dice_bits(d) >> 11) * (1.0 / 9007199254740992.0));
}

/* log-uniform */
static inline double dice_log(dice_t *d, double low, double high) { return exp(dice_in(d, log(low), log(high))); }

/* 0 ... n-1 */
static inline int dice_below(dice_t *d, int n) { return (int)(dice_bits(d) % (uint64_t)n); }

static inline int dice_sign(dice_t *d) { return dice_bits(d) & 1 ? 1 : -1; }

static inline void dice_unit(dice_t *d, double n[3])
{
    double l;
    do {
        for (int i = 0; i < 3; i++)
            n[i] = dice_in(d, -1, 1);
        l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    } while (!(l > 1e-3 && l <= 1));
    n[0] /= l;
    n[1] /= l;
    n[2] /= l;
}

static inline void dice_rotation(dice_t *d, double rot[9])
{
    double q[4], l;
    int i;
    do {
        for (i = 0, l = 0; i < 4; i++) {
            q[i] = dice_in(d, -1, 1);
            l += q[i] * q[i];
        }
    } while (!(l > 1e-3 && l <= 1));
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
}

#endif
