/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Answers of FCL and ODE counted by what is wrong with them; and ODE's wrong callbacks.
 *
 * ODE's cylinder callback is wrong for directions within about 1e-15 of the axis: it makes a
 * unit vector of what rounding leaves across the axis, and answers with a point up to a radius
 * out of place. Such queries are about no convex shape, and counted apart; they are found by
 * holding every support point against the shape it is said to be of. */

#ifndef ENGINES_TALLY_H
#define ENGINES_TALLY_H

#include "harness/truth.h"
#include "harness/verdict.h"

#include <ccd/ccd.h>
#include <stdio.h>

typedef struct {
    long queries, hits, wrong[VERDICTS];
    double lost;   /* the deepest overlap missed */
    double excess; /* the largest part of the truth by which a depth is beyond it and two tolerances */
} tally_t;

static inline verdict_t tally_add(tally_t *t, const verdict_truth_t *truth, int hit, double depth, double length)
{
    const verdict_answer_t answer = { hit, 1, depth, length * length };
    const verdict_t v = verdict(&answer, truth);
    t->queries++;
    t->hits += hit;
    t->wrong[v]++;
    if (v == VERDICT_MISSED)
        t->lost = fmax(t->lost, truth->lower);
    if (hit && truth->upper > 0)
        t->excess = fmax(t->excess, (depth - truth->upper - 2 * truth->tolerance) / truth->upper);
    return v;
}

/* A line that `what` begins. */
static inline void tally_print(const char *what, const tally_t *t)
{
    printf("%s queries %ld hits %ld missed %ld spurious %ld broken %ld deep %ld unsound %ld lost %.9g excess %.9g\n", what,
           t->queries, t->hits, t->wrong[VERDICT_MISSED], t->wrong[VERDICT_SPURIOUS], t->wrong[VERDICT_INVALID],
           t->wrong[VERDICT_DEEP], t->wrong[VERDICT_UNSOUND], t->lost, t->excess);
}

/* The support point along dir; returns how far v is off it. */
static inline double right_point(const shape_t *s, const ccd_vec3_t *dir, const ccd_vec3_t *v, double point[3])
{
    static const double origin[3] = { 0, 0, 0 };
    const double n[3] = { dir->v[0], dir->v[1], dir->v[2] };
    truth_support(s, origin, n, point);
    return fabs(n[0] * (v->v[0] - point[0]) + n[1] * (v->v[1] - point[1]) + n[2] * (v->v[2] - point[2]));
}

#endif
