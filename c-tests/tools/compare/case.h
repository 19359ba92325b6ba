/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A case is all support samples of a query. Replayed, a sampled direction is answered with its point, any other with the
 * farthest of all points. Their hull lies within the object and has the points that bound its depth from both sides, so
 * that its truth is the object's.
 *
 * A file has a line of text, then numbers: the call (calls.h) and max_iterations; the truth (verdict_truth_t) and the
 * direction along which obj2 leaves by its upper bound; of each object whether it has a center, the center, and the
 * number of samples; first_dir; the samples of obj1, then of obj2, each a direction and a point. */

#ifndef COMPARE_CASE_H
#define COMPARE_CASE_H

#include "tools/compare/compare.h"

#include <string.h>

typedef struct {
    const samples_t *samples;
    int which, next;
} case_object_t;

/* Returns the point of the next sample in this direction; without one, the farthest of all points. */
static inline void case_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *point)
{
    case_object_t *o = (case_object_t *)obj;
    const int n = o->samples->count[o->which];
    const support_sample_t *samples = o->samples->sample[o->which];
    ccd_real_t most = -HUGE_VAL;
    for (int i = 0; i < n; i++) {
        const int row = (o->next + i) % n;
        const ccd_vec3_t *p = &samples[row].point, *d = &samples[row].dir;
        const ccd_real_t h = ccdVec3Dot(p, dir);
        if (d->v[0] == dir->v[0] && d->v[1] == dir->v[1] && d->v[2] == dir->v[2]) {
            o->next = row + 1;
            *point = *p;
            return;
        }
        if (h > most) {
            most = h;
            *point = *p;
        }
    }
}

static inline void case_center(const void *obj, ccd_vec3_t *center)
{
    const case_object_t *o = (const case_object_t *)obj;
    *center = o->samples->centre[o->which];
}

static inline void case_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    (void)obj2;
    *dir = ((const case_object_t *)obj1)->samples->first_dir;
}

/* Makes objects and settings of a case. */
static inline void case_prepare(const samples_t *s, unsigned long max_iterations, double tolerance, case_object_t object[2],
                                ccd_t *ccd)
{
    memset(ccd, 0, sizeof *ccd);
    for (int k = 0; k < 2; k++)
        object[k] = (case_object_t){s, k, 0};
    ccd->first_dir = case_first_dir;
    ccd->support1 = ccd->support2 = case_support;
    ccd->center1 = ccd->center2 = s->has_centre[0] && s->has_centre[1] ? case_center : NULL;
    ccd->max_iterations = max_iterations;
    ccd->epa_tolerance = ccd->mpr_tolerance = (ccd_real_t)tolerance;
    ccd->dist_tolerance = (ccd_real_t)1e-6;
}

#endif
