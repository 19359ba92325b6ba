/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* All tolerances of comparisons in these tests, each with the reason why it is not
 * smaller. Numbers are relative. */

#ifndef TESTS_TOLERANCES_H
#define TESTS_TOLERANCES_H

#include "harness/truth.h"

/* X(name, in double, in single, reason) */
#define TOLERANCES(X) \
    X(ULPS, 16, 16, \
      "ulps of the largest coordinate: a callback rounds a rotated vertex and adds a " \
      "position, the difference of two such points is dotted with a rounded unit vector") \
    X(UNIT_LENGTH, 4.5e-16, 2.5e-7, \
      "|dir| - 1: normalising a vector rounds three coordinates, one length, one division; " \
      "of 50 million normalised vectors the worst is off by two ulps") \
    X(TIGHT, 1e-9, 256 * FLT_EPSILON, \
      "tolerance of a tight query relative to the size: a thousandth of the 1e-6 that " \
      "configurations are judged to; in single what eight bits above rounding leave") \
    X(MPR, 1e-3, 1e-3, \
      "part of its depth by which an answer of MPR may be above the least: its guarantee") \
    X(MPR_CAPPED, 1e-2, 1e-2, \
      "the same where MPR's support points were used up: nearly concentric round objects") \
    X(TABLE, 1e-2, 1e-2, \
      "the rate table's verdict: 1 % of the depth and two tolerances, for libccd's sake") \
    X(TABLE_CAP, 1e-3, 1e-3, \
      "the rate table's verdict is never wider than this part of the size") \
    X(DEEP, 1e-2, 1e-2, \
      "part of the size above which a missed overlap counts as a deep one") \
    X(WITNESS, 1e-12, 1e-5, \
      "witness points against supporting planes, beside the query's own tolerance: they " \
      "are convex combinations of support points and carry the rounding of three weights") \
    X(PROOF_FLOOR, 2e-14, 1e-5, \
      "least tolerance a proof can reach, relative to the largest coordinate: what a few " \
      "ulps in support points do to the distance of a face through three of them")

enum {
#define TESTS_TOLERANCE_NAME(name, in_double, in_single, reason) TOL_##name,
    TOLERANCES(TESTS_TOLERANCE_NAME)
#undef TESTS_TOLERANCE_NAME
        TOL_COUNT
};

static inline double tolerance(int name)
{
    static const double bounds[TOL_COUNT][2] = {
#define TESTS_TOLERANCE_BOUND(name, in_double, in_single, reason) {in_double, in_single},
        TOLERANCES(TESTS_TOLERANCE_BOUND)
#undef TESTS_TOLERANCE_BOUND
    };
    return bounds[name][sizeof(ccd_real_t) == sizeof(float)];
}

/* Returns the distance from 1 to the next ccd_real_t. */
static inline double real_eps(void) { return sizeof(ccd_real_t) == sizeof(float) ? FLT_EPSILON : DBL_EPSILON; }

/* Returns the rounding error of a depth between these shapes, metres. */
static inline double pair_noise(const shape_t *a, const shape_t *b)
{
    return tolerance(TOL_ULPS) * real_eps() * largest_coordinate(a, b);
}

#endif
