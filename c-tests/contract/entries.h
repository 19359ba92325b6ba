/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every entry point that runs callbacks, under one signature, so that a test can go
 * through all of them. Compiled with -DOURS_ALONE. */

#ifndef TESTS_ENTRIES_H
#define TESTS_ENTRIES_H

#include "check.h"
#include "ours.h"
#include "polytope.h"
#include "shapes.h"

typedef struct {
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    support_t support;
} outputs_t;

enum { FROM_FIRST_DIR = 1, FROM_CENTERS = 2, STORES_DEPTH = 4, STORES_DIR_POS = 8, MAY_ALLOCATE = 16, EXTENSION = 32,
       ONE_BY_ONE = 64 /* asks the objects one by one */ };

typedef struct {
    const char *name;
    int (*call)(const void *obj1, const void *obj2, const ccd_t *ccd, outputs_t *out);
    int hit, miss; /* what it returns */
    int traits;
} entry_t;

static inline int run_GJKIntersect(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    (void)out;
    return ccdGJKIntersect(a, b, ccd);
}

static inline int run_GJKSeparate(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return ccdGJKSeparate(a, b, ccd, &out->dir);
}

static inline int run_GJKPenetration(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return ccdGJKPenetration(a, b, ccd, &out->depth, &out->dir, &out->pos);
}

static inline int run_MPRIntersect(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    (void)out;
    return ccdMPRIntersect(a, b, ccd);
}

static inline int run_MPRPenetration(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return ccdMPRPenetration(a, b, ccd, &out->depth, &out->dir, &out->pos);
}

/* The extension, from a cold state and with that state again; out is the second answer. */
static inline int run_MPRPenetrationWarm(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    ccdMPRPenetrationWarm(a, b, ccd, &warm, NULL, NULL, NULL);
    return ccdMPRPenetrationWarm(a, b, ccd, &warm, &out->depth, &out->dir, &out->pos);
}

static inline int run_MPRIntersectWarm(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_warm_t warm;
    (void)out;
    memset(&warm, 0, sizeof warm);
    ccdMPRIntersectWarm(a, b, ccd, &warm);
    return ccdMPRIntersectWarm(a, b, ccd, &warm);
}

static inline int run_Intersect(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_warm_t warm;
    (void)out;
    memset(&warm, 0, sizeof warm);
    ccdIntersect(a, b, ccd, &warm);
    return ccdIntersect(a, b, ccd, &warm);
}

static inline int stored(int code, const ccd_penetration_t *p, outputs_t *out)
{
    if (code == CCD_HIT || code == CCD_LIMIT) {
        out->depth = p->depth;
        out->dir = p->dir;
        out->pos = p->pos;
        return CCD_HIT;
    }
    return code;
}

/* Cold, then from the state that this left. */
static inline int run_twice(int (*query)(const void *, const void *, const ccd_t *, ccd_warm_t *, unsigned,
                                         ccd_penetration_t *),
                            const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_warm_t warm;
    ccd_penetration_t p;
    memset(&warm, 0, sizeof warm);
    query(a, b, ccd, &warm, CCD_WANT_ALL, &p);
    return stored(query(a, b, ccd, &warm, CCD_WANT_ALL, &p), &p, out);
}

static inline int run_Penetration(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return run_twice(ccdPenetration, a, b, ccd, out);
}

static inline int run_PenetrationLocal(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return run_twice(ccdPenetrationLocal, a, b, ccd, out);
}

static inline int run_PenetrationIncremental(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return run_twice(ccdPenetrationIncremental, a, b, ccd, out);
}

static inline int run_PenetrationProven(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return run_twice(ccdPenetrationProven, a, b, ccd, out);
}

static inline int run_PenetrationAlong(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_vec3_t dir = {{1, 2, -2}};
    ccd_warm_t warm;
    ccd_penetration_t p;
    memset(&warm, 0, sizeof warm);
    ccdPenetrationAlong(a, b, ccd, &dir, &warm, CCD_WANT_ALL, &p);
    return stored(ccdPenetrationAlong(a, b, ccd, &dir, &warm, CCD_WANT_ALL, &p), &p, out);
}

static inline int run_PenetrationPlanar(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_vec3_t normal = {{0, 0, 3}};
    ccd_warm_t warm;
    ccd_penetration_t p;
    memset(&warm, 0, sizeof warm);
    ccdPenetrationPlanar(a, b, ccd, &normal, &warm, CCD_WANT_ALL, &p);
    return stored(ccdPenetrationPlanar(a, b, ccd, &normal, &warm, CCD_WANT_ALL, &p), &p, out);
}

/* Contacts whatever the pose is; what it returns is whether the pair overlaps. */
static inline int run_Contacts(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    const ccd_vec3_t normal = {{1, 2, -2}};
    ccd_contact_t contacts[4];
    int n = ccdContacts(a, b, ccd, &normal, CCD_REAL(0.01), contacts, 4);
    return n < 1 ? n : run_PenetrationLocal(a, b, ccd, out);
}

static inline int run_SignedDistance(const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    ccd_warm_t warm;
    ccd_distance_t d;
    int code;
    memset(&warm, 0, sizeof warm);
    ccdSignedDistance(a, b, ccd, 0, 0, INFINITY, &warm, CCD_WANT_ALL, &d);
    code = ccdSignedDistance(a, b, ccd, 0, 0, INFINITY, &warm, CCD_WANT_ALL, &d);
    /* Open bounds have a sign too. */
    if (code == CCD_LIMIT)
        code = d.distance < 0 ? CCD_HIT : CCD_MISS;
    if (code == CCD_HIT) {
        out->depth = -d.distance;
        out->dir = d.normal;
        for (code = 0; code < 3; code++)
            out->pos.v[code] = (d.point1.v[code] + d.point2.v[code]) / 2;
        return CCD_HIT;
    }
    return code;
}

static const entry_t entries[] = {
    {"ccdGJKIntersect", run_GJKIntersect, 1, 0, FROM_FIRST_DIR},
    {"ccdGJKSeparate", run_GJKSeparate, 0, -1, FROM_FIRST_DIR | MAY_ALLOCATE},
    {"ccdGJKPenetration", run_GJKPenetration, 0, -1, FROM_FIRST_DIR | STORES_DEPTH | STORES_DIR_POS | MAY_ALLOCATE},
    {"ccdMPRIntersect", run_MPRIntersect, 1, 0, FROM_CENTERS},
    {"ccdMPRPenetration", run_MPRPenetration, 0, -1, FROM_CENTERS | STORES_DEPTH | STORES_DIR_POS},
    {"ccdMPRPenetrationWarm", run_MPRPenetrationWarm, 0, -1, FROM_CENTERS | STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdMPRIntersectWarm", run_MPRIntersectWarm, 1, 0, FROM_CENTERS | EXTENSION},
    {"ccdIntersect", run_Intersect, 1, 0, EXTENSION},
    {"ccdPenetration", run_Penetration, CCD_HIT, CCD_MISS, STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdPenetrationLocal", run_PenetrationLocal, CCD_HIT, CCD_MISS, STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdPenetrationIncremental", run_PenetrationIncremental, CCD_HIT, CCD_MISS,
     STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdPenetrationProven", run_PenetrationProven, CCD_HIT, CCD_MISS,
     STORES_DEPTH | STORES_DIR_POS | MAY_ALLOCATE | EXTENSION},
    {"ccdPenetrationAlong", run_PenetrationAlong, CCD_HIT, CCD_MISS, STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdContacts", run_Contacts, CCD_HIT, CCD_MISS, STORES_DEPTH | STORES_DIR_POS | EXTENSION | ONE_BY_ONE},
    {"ccdPenetrationPlanar", run_PenetrationPlanar, CCD_HIT, CCD_MISS, STORES_DEPTH | STORES_DIR_POS | EXTENSION},
    {"ccdSignedDistance", run_SignedDistance, CCD_HIT, CCD_MISS,
     STORES_DEPTH | STORES_DIR_POS | MAY_ALLOCATE | EXTENSION},
};

enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* --- pairs ------------------------------------------------------------------ */

/* A random shape of unit size, near the origin. */
static inline shape_t random_shape(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, 0, 0, -1, -1, 0.5, 0.5, 0.5, -0.5, 0.5, -0.5};
    double p = random_in(0.3, 1), q = random_in(0.3, 1), r = random_in(0.3, 1), rot[9];
    int type = random_below(SHAPE_TYPES);
    shape_t s = type == SHAPE_POLYTOPE ? shape_polytope(corners, 7) : shape_make(type, p, q, r);
    rotation_quaternion(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), rot);
    shape_turn(&s, rot);
    return s;
}

/* A random polygon in the plane z = 0, for a planar query. */
static inline shape_t random_polygon(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, -1, 0.2f, 0, -0.3f, -0.8f, 0, 0.5f, -0.9f, 0};
    double rot[9];
    shape_t s = shape_polytope(corners, 5);
    rotation_about(0, 0, 1, random_in(0, 6), rot);
    shape_turn(&s, rot);
    return s;
}

/* A pair that certainly overlaps (deep) or certainly does not, and its query. What the
 * entry does not use is NULL. */
static inline void random_pair(const entry_t *entry, int overlapping, shape_t *a, shape_t *b, ccd_t *ccd)
{
    const int planar = entry->call == run_PenetrationPlanar;
    double angle = random_in(0, 6.28), z = planar ? 0 : random_in(-1, 1), across = sqrt(1 - z * z);
    double distance = overlapping ? random_in(0, 0.1) : random_in(4, 6);
    *a = planar ? random_polygon() : random_shape();
    *b = planar ? random_polygon() : random_shape();
    shape_move(b, distance * across * cos(angle), distance * across * sin(angle), distance * z);
    shape_query(ccd);
    if (entry->traits & FROM_FIRST_DIR)
        ccd->center1 = ccd->center2 = NULL;
    if (entry->traits & FROM_CENTERS)
        ccd->first_dir = NULL;
}

#endif
