/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays one query: two objects as support samples, and bounds of their depth. It uses
 * libccd's interface alone, and runs on the library that it is linked to. */

#ifndef COMPARE_REPLAY_CASE_H
#define COMPARE_REPLAY_CASE_H

#include "harness/verdict.h"

#include <ccd/ccd.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

typedef struct {
    const char *title; /* the wrong answer, and whose it is */
    int call;          /* 0 ccdMPRPenetration, 1 ccdMPRIntersect, 2 ccdGJKPenetration, 3 ccdGJKSeparate, 4 ccdGJKIntersect */
    int count[2];
    const double *samples[2]; /* each a direction and the point that was returned, in the order of the calls */
    int has_centres;
    double centre[2][3], first_dir[3];
    unsigned long max_iterations;
    verdict_truth_t truth;
    double truth_dir[3]; /* along this one obj2 leaves by truth.upper */
} case_t;

typedef struct {
    const case_t *of;
    int which, next;
} case_object_t;

/* Returns the point of the next sample in this direction; without one, the farthest of all points. */
static inline void case_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *point)
{
    case_object_t *o = (case_object_t *)obj;
    const int n = o->of->count[o->which];
    const double x = (double)dir->v[0], y = (double)dir->v[1], z = (double)dir->v[2];
    const double *found = o->of->samples[o->which];
    double most = -HUGE_VAL;
    for (int i = 0; i < n; i++) {
        const int row = (o->next + i) % n;
        const double *p = o->of->samples[o->which] + 6 * row;
        const double h = p[3] * x + p[4] * y + p[5] * z;
        if (p[0] == x && p[1] == y && p[2] == z) {
            o->next = row + 1;
            found = p;
            break;
        }
        if (h > most) {
            most = h;
            found = p;
        }
    }
    ccdVec3Set(point, (ccd_real_t)found[3], (ccd_real_t)found[4], (ccd_real_t)found[5]);
}

static inline void case_center(const void *obj, ccd_vec3_t *center)
{
    const case_object_t *o = (const case_object_t *)obj;
    const double *c = o->of->centre[o->which];
    ccdVec3Set(center, (ccd_real_t)c[0], (ccd_real_t)c[1], (ccd_real_t)c[2]);
}

static inline void case_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    const double *d = ((const case_object_t *)obj1)->of->first_dir;
    (void)obj2;
    ccdVec3Set(dir, (ccd_real_t)d[0], (ccd_real_t)d[1], (ccd_real_t)d[2]);
}

static inline void case_prepare(const case_t *c, case_object_t object[2], ccd_t *ccd)
{
    memset(ccd, 0, sizeof *ccd);
    for (int k = 0; k < 2; k++) {
        object[k].of = c;
        object[k].which = k;
        object[k].next = 0;
    }
    ccd->first_dir = case_first_dir;
    ccd->support1 = ccd->support2 = case_support;
    ccd->center1 = ccd->center2 = c->has_centres ? case_center : NULL;
    ccd->max_iterations = c->max_iterations;
    ccd->epa_tolerance = ccd->mpr_tolerance = (ccd_real_t)c->truth.tolerance;
    ccd->dist_tolerance = (ccd_real_t)1e-6;
}

#ifndef CASE_WRITER
static void case_query(const case_t *c, verdict_answer_t *answer, ccd_vec3_t *dir)
{
    case_object_t object[2];
    ccd_real_t depth = 0;
    ccd_vec3_t pos;
    ccd_t ccd;
    case_prepare(c, object, &ccd);
    ccdVec3Set(dir, 0, 0, 0);
    answer->has_depth = c->call != 1 && c->call != 4;
    switch (c->call) {
    case 0: answer->hit = ccdMPRPenetration(&object[0], &object[1], &ccd, &depth, dir, &pos) == 0; break;
    case 1: answer->hit = ccdMPRIntersect(&object[0], &object[1], &ccd) == 1; break;
    case 2: answer->hit = ccdGJKPenetration(&object[0], &object[1], &ccd, &depth, dir, &pos) == 0; break;
    case 3:
        answer->hit = ccdGJKSeparate(&object[0], &object[1], &ccd, dir) == 0;
        depth = (ccd_real_t)sqrt((double)ccdVec3Len2(dir));
        if (depth > 0)
            ccdVec3Scale(dir, 1 / depth);
        break;
    default: answer->hit = ccdGJKIntersect(&object[0], &object[1], &ccd) == 1;
    }
    answer->depth = (double)depth;
    answer->length2 = c->call == 3 && depth == 0 ? 1 : (double)ccdVec3Len2(dir);
}

/* Queries the library and prints its answer and the truth; returns 1 if the answer is wrong. */
static int case_run(const case_t *c)
{
    static const char *const name[] = { "ccdMPRPenetration", "ccdMPRIntersect", "ccdGJKPenetration", "ccdGJKSeparate",
                                        "ccdGJKIntersect" };
    verdict_answer_t answer;
    ccd_vec3_t dir;
    case_query(c, &answer, &dir);
    verdict_t v = verdict(&answer, &c->truth);
    printf("then:  %s\n", c->title);
    printf("now:   %s: %s", name[c->call], answer.hit ? "hit" : "miss");
    if (answer.hit && answer.has_depth)
        printf(", depth %.9g along (%.6g, %.6g, %.6g)", answer.depth, (double)dir.v[0], (double)dir.v[1], (double)dir.v[2]);
    printf(": %s\n", VERDICT_NAME[v]);
    printf("truth: signed depth at most %.9g (along (%.6g, %.6g, %.6g))", c->truth.upper, c->truth_dir[0],
           c->truth_dir[1], c->truth_dir[2]);
    if (c->truth.lower > -DBL_MAX)
        printf(", at least %.9g", c->truth.lower);
    printf("; tolerance %.3g\n", c->truth.tolerance);
    return v != VERDICT_RIGHT;
}
#endif

#endif
