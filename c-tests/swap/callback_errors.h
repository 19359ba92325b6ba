/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's cylinder callback is wrong for directions within about 1e-15 of the axis:
 * it makes a unit vector of what rounding leaves across the axis, and answers with
 * a point up to a radius out of place. Such queries are about no convex shape; they
 * are found by holding every support point against the shape it is said to be of. */

#ifndef SWAP_CALLBACK_ERRORS_H
#define SWAP_CALLBACK_ERRORS_H

#include "truth.h"
#include <ccd/ccd.h>

/* The support point along dir; returns how far v is off it. */
static inline double right_point(const shape_t *s, const ccd_vec3_t *dir, const ccd_vec3_t *v, double point[3])
{
    static const double origin[3];
    truth_point(s, origin, dir->v, point);
    return fabs(dir->v[0] * (v->v[0] - point[0]) + dir->v[1] * (v->v[1] - point[1]) + dir->v[2] * (v->v[2] - point[2]));
}

static inline double from(const shape_t *s, const ccd_vec3_t *p)
{
    return hypot(hypot(s->pos[0] - p->v[0], s->pos[1] - p->v[1]), s->pos[2] - p->v[2]);
}

#endif
