/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Stands between a consumer (FCL, ODE, MuJoCo, DART) and whichever libccd the
 * process runs on, and looks at every penetration query.
 *
 * The program that includes this file defines ccdMPRPenetration, ccdMPRIntersect
 * and __ccdSupport itself; the dynamic linker binds the consumer's calls to the
 * program's, which pass them on to the libccd.so.2 that is loaded. A program that
 * defines WATCH_ANSWER(obj, dir, v) is shown every support point as well, and may
 * change it; watch_centre(obj, &c) tells it where the object is.
 *
 * With WATCH_MINIMUM in the environment, on this library: ccdMPRPenetration is answered
 * with the proven minimum, whatever that costs. */

#ifndef SWAP_INTERPOSE_H
#define SWAP_INTERPOSE_H

#include "harness/identity.h"
#include <ccd/warm.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

static struct {
    unsigned long queries, hits;
    unsigned long zero, not_finite, not_unit; /* hits with such a direction (or depth) */
    unsigned long slanted; /* hits whose direction is not the normal of a plane that depth brings apart */
    unsigned long supports; /* of D: one is support1 and support2 */
    unsigned long raw_supports; /* __ccdSupport, the support function FCL's own GJK calls */
    int answer; /* of the first query since `queries` was `first`, and its outputs */
    unsigned long first;
    double depth, length;
} watched;

typedef int (*watch_penetration_fn)(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
typedef int (*watch_intersect_fn)(const void *, const void *, const ccd_t *);

typedef struct _ccd_support_t ccd_support_t;
typedef void (*watch_support_fn)(const void *, const void *, const ccd_vec3_t *, const ccd_t *, ccd_support_t *);

/* The consumer's callbacks, behind a count. One query at a time: the simulations here have one thread. */
static ccd_support_fn watch_support1;
static void watch_count(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    watched.supports++;
    watch_support1(obj, dir, v);
#ifdef WATCH_ANSWER
    WATCH_ANSWER(obj, dir, v);
#endif
}
#ifdef WATCH_ANSWER
static ccd_support_fn watch_support2;
static ccd_center_fn watch_centre;
static void watch_answer(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    watch_support2(obj, dir, v);
    WATCH_ANSWER(obj, dir, v);
}
#endif

static void *watch_next(const char *name)
{
    void *symbol = dlsym(RTLD_NEXT, name);
    if (!symbol) {
        fprintf(stderr, "no %s in the libccd that is loaded\n", name);
        exit(2);
    }
    return symbol;
}

/* h(dir): how far obj2 must move along dir. And the size of the numbers it was computed from. */
static double watch_support_value(const void *obj1, const void *obj2, const ccd_t *ccd, const ccd_vec3_t *dir, double *size)
{
    ccd_vec3_t a, b, back = *dir;
    ccdVec3Scale(&back, -1);
    ccd->support1(obj1, dir, &a);
    ccd->support2(obj2, &back, &b);
    *size = sqrt(ccdVec3Len2(&a)) + sqrt(ccdVec3Len2(&b));
    return (double)(ccdVec3Dot(&a, dir) - ccdVec3Dot(&b, dir));
}

typedef int (*watch_minimum_fn)(const void *, const void *, const ccd_t *, ccd_warm_t *, unsigned, ccd_penetration_t *);

static int watch_minimum(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    static watch_minimum_fn next;
    ccd_t finer = *ccd;
    ccd_penetration_t out;
    int code;
    if (!next) {
        void *symbol = watch_next("ccdPenetrationProven");
        memcpy(&next, &symbol, sizeof next);
    }
    finer.epa_tolerance = ccd->mpr_tolerance;
    finer.max_iterations = 2000;
    code = next(obj1, obj2, &finer, NULL, CCD_WANT_ALL, &out);
    if (code != CCD_HIT && code != CCD_LIMIT)
        return -1;
    *depth = out.depth;
    *dir = out.dir;
    *pos = out.pos;
    return 0;
}

int ccdMPRPenetration(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    static watch_penetration_fn next;
    static int minimum;
    const ccd_support_fn outer = watch_support1;
    ccd_t counted = *ccd;
    int hit;
    if (!next) {
        void *symbol = watch_next("ccdMPRPenetration");
        memcpy(&next, &symbol, sizeof next);
        minimum = getenv("WATCH_MINIMUM") != NULL;
    }
    watch_support1 = ccd->support1;
    counted.support1 = watch_count;
#ifdef WATCH_ANSWER
    watch_support2 = ccd->support2;
    watch_centre = ccd->center1; /* one function for all kinds, in ODE */
    counted.support2 = watch_answer;
#endif
    hit = (minimum ? watch_minimum : next)(obj1, obj2, &counted, depth, dir, pos);
    watch_support1 = outer;
    if (watched.queries++ == watched.first) {
        watched.answer = hit;
        watched.depth = hit == 0 ? *depth : 0;
        watched.length = hit == 0 ? sqrt(ccdVec3Len2(dir)) : 0;
    }
    if (hit != 0)
        return hit;
    watched.hits++;
    if (!isfinite(*depth + dir->v[0] + dir->v[1] + dir->v[2] + pos->v[0] + pos->v[1] + pos->v[2]))
        watched.not_finite++;
    else if (ccdVec3Len2(dir) == 0)
        watched.zero++;
    else if (fabs(sqrt(ccdVec3Len2(dir)) - 1) > 1e-9)
        watched.not_unit++;
    else {
        double size;
        /* MPR's own tolerance is a depth too */
        if (!(*depth >= watch_support_value(obj1, obj2, ccd, dir, &size) - ccd->mpr_tolerance - 1e-12 * size))
            watched.slanted++;
    }
    return hit;
}

int ccdMPRIntersect(const void *obj1, const void *obj2, const ccd_t *ccd)
{
    static watch_intersect_fn next;
    int hit;
    if (!next) {
        void *symbol = watch_next("ccdMPRIntersect");
        memcpy(&next, &symbol, sizeof next);
    }
    hit = next(obj1, obj2, ccd);
    watched.queries++;
    watched.hits += hit == 1;
    return hit;
}

void __ccdSupport(const void *obj1, const void *obj2, const ccd_vec3_t *dir, const ccd_t *ccd, ccd_support_t *supp)
{
    static watch_support_fn next;
    if (!next) {
        void *symbol = watch_next("__ccdSupport");
        memcpy(&next, &symbol, sizeof next);
    }
    next(obj1, obj2, dir, ccd, supp);
    watched.raw_supports++;
}

/* Which library is under the consumer: the run's first line. */
static void watch_library(void)
{
    const char *name = running_ccd();
    printf("library %s\n", name ? name : "libccd");
}

static void watch_report(void)
{
    printf("watched queries %lu hits %lu zero %lu not_finite %lu not_unit %lu slanted %lu supports %lu\n", watched.queries,
           watched.hits, watched.zero, watched.not_finite, watched.not_unit, watched.slanted, watched.supports);
}

#ifdef __cplusplus
}
#endif

#endif
